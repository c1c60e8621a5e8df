"""Pools of the body's parts: torsos, arms and legs of all libraries, and samples of what joints allow.

Given where the torso is, limbs move nearly independently: an arm from one posture and a leg from another make
postures that no library has. Left and right limbs share one pool, mirrored.
"""

from collections import OrderedDict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.spatial.distance import cdist

from ..arrays import Array, IndexArray
from ..body.human import HUMAN, LIMBS
from ..body.kinematics import Body
from ..body.mirror import mirrored
from ..body.posture import Posture, headings_rad, yawed_at
from ..body.posture_spline import cubic_spline
from ..body.skeleton import Skeleton
from ..errors import InputError
from ..numerics.robust import multivariate_cost
from ..prior.library import Library, LibraryMotion

ARM, LEG, TORSO = "arm", "leg", "torso"
JOINTS = {
    TORSO: ("pelvis", "waist", "neck"),
    ARM: ("girdle", "shoulder", "elbow", "forearm"),
    LEG: ("hip", "knee", "shin"),
}
"""Joints of each part, without their side."""
POINTS = {
    TORSO: ("head", "shoulder.L", "shoulder.R", "hip.L", "hip.R"),
    ARM: ("elbow.L", "wrist.L"),
    LEG: ("knee.L", "ankle.L"),
}
"""Principal points by which parts are compared; of the left side where there are two."""
SPREAD = {TORSO: (0.05, 30, 0.10, 18), ARM: (0.09, 130, 0.20, 90), LEG: (0.07, 110, 0.16, 70)}
"""Libraries' parts nearer than this look the same [m], and so many are taken at most; distance of samples
from one another and from known parts [m], and so many at most."""


@dataclass(frozen=True, eq=False)
class PartPool:
    """N parts of one kind."""

    kind: str
    posture: Posture  # (N,) that have the part, the left one of limbs; torsos face -Y, hips at 0
    cost: Array  # (N,) negative log of how usual each is, 0 for a known one
    source: IndexArray  # (N,) the nearest posture of `known_motions`

    def __len__(self) -> int:
        return len(self.cost)


@dataclass(frozen=True, eq=False)
class PartPools:
    """Torsos, arms and legs on a body; limbs are the left ones, the right ones their mirror images."""

    body: Body
    torsos: PartPool
    arms: PartPool
    legs: PartPool
    names: tuple[tuple[str, bool], ...]  # what the parts are of, see `known_motions`
    limb_cost: Mapping[str, Array]  # (T, L) -log of how usual limbs are with torsos

    def composed(
        self, torso: IndexArray, limbs: dict[str, IndexArray], heading_rad: Array, hips: Array
    ) -> Posture:
        """Postures of torsos (N,) and limbs (N,), turned by headings (N,), the hips at (N, 3) [m]."""
        chosen = self.torsos.posture[torso]
        rotations, angles = np.array(chosen.rotations), np.array(chosen.angles)
        for limb, index in limbs.items():
            kind, side = limb.split(".")
            given = (self.arms if kind == ARM else self.legs).posture[index]
            own = given if side == "L" else mirrored(given)
            balls, hinges = part_columns(kind, side)
            rotations[:, balls], angles[:, hinges] = own.rotations[:, balls], own.angles[:, hinges]
        whole = Posture(chosen.skeleton, np.zeros((len(torso), 3)), rotations, angles)
        return yawed_at(whole, heading_rad, hips)

    def nearest(self, posture: Posture) -> tuple[str, bool]:
        """The posture whose torso is most like a single one's, and whether it is mirrored."""
        ahead = yawed_at(Posture.stack([posture]), -headings_rad(Posture.stack([posture])), np.zeros((1, 3)))
        own, known = (part_points(self.body, TORSO, each) for each in (ahead, self.torsos.posture))
        return self.names[self.torsos.source[_distances(own, known).argmin()]]


@lru_cache(maxsize=16)
def part_columns(kind: str, side: str = "") -> tuple[list[int], list[int]]:
    """Columns of a part's balls among a posture's rotations, and of its hinges among the angles."""
    names = [f"{name}.{side}" if side else name for name in JOINTS[kind]]
    balls = [c for c, joint in enumerate(HUMAN.ball_joints) if HUMAN.joints[joint].name in names]
    hinges = [c for c, joint in enumerate(HUMAN.hinge_joints) if HUMAN.joints[joint].name in names]
    return balls, hinges


def part_dofs(skeleton: Skeleton, kind: str, side: str = "") -> list[int]:
    """Degrees of freedom of a part."""
    balls, hinges = part_columns(kind, side)
    return [*map(int, skeleton.ball_dofs[balls].ravel()), *map(int, skeleton.hinge_dofs[hinges])]


_KEPT: OrderedDict[tuple[object, ...], PartPools] = OrderedDict()


def usable_libraries(libraries: Sequence[Library]) -> list[Library]:
    """Those that have a posture.

    Raises:
        InputError: None has.
    """
    usable = [library for library in libraries if library.postures]
    if not usable:
        raise InputError("no keyframe library with a posture is given; at least one is needed to find poses")
    return usable


def part_pools(libraries: Sequence[Library], body: Body) -> PartPools:
    """The parts of all libraries' postures and their mirror images on a body, with samples beside them.

    They are made once for the libraries' content, however often files are read.
    """
    postures = [each.posture for one in libraries for each in one.postures]
    shapes = [(one.translation.tobytes(), one.rotations.tobytes(), one.angles.tobytes()) for one in postures]
    named = tuple((tuple(each.name for each in one.postures), one.motions) for one in libraries)
    key = (*sorted(body.actor.segments_m.items()), *map(hash, shapes), *named)
    if key not in _KEPT:
        _KEPT[key] = _part_pools(libraries, body)
        # They are kept for so many questions about other performers.
        while len(_KEPT) > 8:
            _KEPT.popitem(last=False)
    return _KEPT[key]


def _part_pools(libraries: Sequence[Library], body: Body) -> PartPools:
    facing, names = known_motions(libraries, body)
    samples = _samples(np.random.default_rng(0))
    pools = {kind: _pool(body, kind, facing, samples) for kind in (TORSO, ARM, LEG)}
    # Sources are postures and then their mirror images: the right limb of one is the left limb of the other.
    other_side = np.roll(np.arange(len(names)), len(names) // 2)
    limb_cost = {}
    for limb in LIMBS:
        kind, side = limb.split(".")
        pool, near = pools[kind]
        seen = near / near.sum(axis=0)
        together = pools[TORSO][1] @ (seen if side == "L" else seen[:, other_side]).T
        together /= together.sum(axis=1, keepdims=True)
        # Half is for the parts that libraries show together, the rest for any other combination.
        limb_cost[limb] = -np.log(0.5 * np.exp(-pool.cost) + 0.5 * together)
    torsos, arms, legs = (pool for pool, _ in pools.values())
    return PartPools(body, torsos, arms, legs, names, limb_cost)


def part_points(body: Body, kind: str, posture: Posture) -> Array:
    """(N, Q, 3) points of a part in the frame of what it hangs on [m]: of torsos in the world's axes."""
    bare = _only(kind, posture)
    index = [HUMAN.point_names.index(name) for name in POINTS[kind]]
    return np.asarray(body.points(body.pose(bare))[:, index])


def _only(kind: str, posture: Posture) -> Posture:
    """The postures at rest but for one part, of limbs the left one."""
    rest = Posture.rest(posture.skeleton, posture.batch)
    rotations, angles = np.array(rest.rotations), np.array(rest.angles)
    balls, hinges = part_columns(kind, "" if kind == TORSO else "L")
    rotations[:, balls], angles[:, hinges] = posture.rotations[:, balls], posture.angles[:, hinges]
    return Posture(posture.skeleton, rest.translation, rotations, angles)


def _samples(random: np.random.Generator) -> Posture:
    """Postures all over the joints' ranges."""
    limits = np.array(HUMAN.limits)
    for row, name in enumerate(HUMAN.dof_names):
        if name.startswith(("forearm", "shin", "girdle")):
            limits[row] = 0.0  # about a limb's own axis, or small
    free = np.array(["pelvis" in name for name in HUMAN.dof_names])
    limits[free] = 0.0
    limits[3:5] = np.radians([(-25.0, 70.0), (-25.0, 25.0)])  # pelvis forward and sideways
    lower, upper = limits.T
    # Share of a joint's range that is sampled: its ends are for single moments.
    share = 0.5 + 0.8 * (random.random((4000, len(limits))) - 0.5)
    return Posture.from_vector(HUMAN, lower + share * (upper - lower))


def _pool(body: Body, kind: str, known: Posture, samples: Posture) -> tuple[PartPool, Array]:
    """The pool of a kind of part, and (N, S) how near each is to that of each of S known postures."""
    known_points, sample_points = (part_points(body, kind, each) for each in (known, samples))
    known_m, most_known, sampled_m, most_sampled = SPREAD[kind]
    nearest = int(_distances(known_points.mean(axis=0, keepdims=True), known_points).argmin())
    first = np.array([nearest], dtype=np.intp)
    chosen = np.append(first, _spread(known_points, known_points[first], known_m, most_known - 1))
    added = _spread(sample_points, known_points[chosen], sampled_m, most_sampled)
    away = _distances(np.concatenate([known_points[chosen], sample_points[added]]), known_points)
    count = len(chosen)
    usual = np.sqrt(np.bincount(away[:count].argmin(axis=0), minlength=count))
    # Distance from the nearest known part that is as usual as the known part. Student's t of three degrees:
    # a prior must forgive.
    off = away[count:].min(axis=1, initial=np.inf)
    rare = np.median(usual) * np.exp(-multivariate_cost((off / 0.15) ** 2, 3.0, 1))
    weight = np.concatenate([usual, rare])
    pool = PartPool(
        kind,
        Posture.concatenate([_only(kind, known[chosen]), _only(kind, samples[added])]),
        -np.log(weight / weight.sum()),
        np.concatenate([chosen, away[count:].argmin(axis=1)]).astype(np.intp),
    )
    # Distance within which parts go with the same other parts: what performers differ by.
    return pool, np.exp(-0.5 * (away / 0.08) ** 2) + 1e-9


def _spread(points: Array, taken: Array, radius_m: float, most: int) -> IndexArray:
    """Indices of items (N, Q, 3) apart from (K, Q, 3) taken ones: farthest-point sampling (Gonzalez 1985)."""
    chosen: list[int] = []
    away = _distances(taken, points).min(axis=0)
    while len(chosen) < most and away.max() > radius_m:
        chosen.append(int(away.argmax()))
        away = np.minimum(away, _distances(points[chosen[-1:]], points)[0])
    return np.array(chosen, dtype=np.intp)


def _distances(first: Array, second: Array) -> Array:
    """(N, K) mean distances of points (N, Q, 3) and (K, Q, 3) [m]."""
    each = zip(np.swapaxes(first, 0, 1), np.swapaxes(second, 0, 1), strict=True)
    return np.asarray(sum(cdist(one, other) for one, other in each) / first.shape[1])


# --- All motions of some libraries and their mirror images as postures at small steps of time


STEP_M = 0.045  # mean distance of points between postures: well below performers' differences
MOST_RATE = 25.0  # postures per second of a motion; the least are 8
MOST_POSTURES = 450  # postures of a library, without mirror images; with more the steps are widened
NEIGHBORS = 2  # postures before and after a cycle that the spline within it depends on


def known_motions(libraries: Sequence[Library], body: Body) -> tuple[Posture, tuple[tuple[str, bool], ...]]:
    """Postures (S,) facing -Y, the hips at the origin, the second half the mirror images of the first.

    Beside them the library's posture nearest in time to each, and whether it is mirrored. At least one
    library has a posture.
    """
    every = [each for library in libraries for each in _motions(library, body)]
    plain = Posture.concatenate([posture for posture, _ in every])
    names = [name for _, own in every for name in own]
    both = Posture.concatenate([plain, mirrored(plain)])
    facing = yawed_at(both, -headings_rad(both), np.zeros((2 * len(names), 3)))
    return facing, (*((name, False) for name in names), *((name, True) for name in names))


def _motions(library: Library, body: Body) -> list[tuple[Posture, list[str]]]:
    found = [_sampled(library, motion, body, 1.0) for motion in library.motions]
    total = sum(len(names) for _, names in found)
    if total > MOST_POSTURES:
        found = [_sampled(library, motion, body, total / MOST_POSTURES) for motion in library.motions]
    used = {step.posture for motion in library.motions for step in motion.steps}
    loose = [each for each in library.postures if each.name not in used]
    if loose:
        found.append((Posture.stack([each.posture for each in loose]), [each.name for each in loose]))
    return found


def _sampled(
    library: Library, motion: LibraryMotion, body: Body, spacing: float
) -> tuple[Posture, list[str]]:
    """A motion at steps of time in which its points move about `STEP_M` times `spacing`."""
    whole = motion.duration_s if motion.cyclic else motion.steps[-1].time_s
    around, knots = np.arange(len(motion.steps)), np.array([step.time_s for step in motion.steps])
    if motion.cyclic:
        around = np.arange(-NEIGHBORS, len(knots) + NEIGHBORS)
    cycle, steps = np.divmod(around, len(knots))
    away_s = knots[steps] + cycle * whole
    posed = Posture.stack([library.by_name[motion.steps[step].posture].posture for step in steps])
    posed = yawed_at(posed, cycle * motion.travel[2], posed.translation)  # each cycle turns by as much

    def at(time_s: Array) -> Posture:
        alone = len(posed.translation) == 1
        return posed[np.zeros(len(time_s), dtype=np.intp)] if alone else cubic_spline(posed, away_s, time_s)

    posture = at(np.linspace(0.0, whole, int(np.clip(np.ceil(whole * MOST_RATE) + 1, 3, MOST_POSTURES))))
    points = body.points(body.pose(posture)) - posture.translation[:, None]
    length = float(np.linalg.norm(np.diff(points, axis=0), axis=-1).mean(axis=1).sum())
    rate = np.clip(length / STEP_M / max(whole, 1e-6), 8.0, MOST_RATE) / spacing
    count = int(np.clip(np.ceil(whole * rate), 3, MOST_POSTURES))
    time_s = np.linspace(0.0, whole, count, endpoint=not motion.cyclic)
    nearest = np.abs(time_s[:, None] - away_s).argmin(axis=1)
    return at(time_s), [motion.steps[steps[own]].posture for own in nearest]
