"""All postures that some libraries know, and their mirror images, on one body, and how plausible others are.

The body falls into a trunk and four limbs that move nearly independently; a limb is a part of its own, known
in the frame of the joint that carries it, so that it fits any trunk.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import logsumexp

from ..arrays import Array, BoolArray, IndexArray
from ..body.human import LIMBS, TRUNK, limb_of
from ..body.kinematics import Body, Pose
from ..body.mirror import mirrored
from ..body.posture import Posture, headings_rad, yaw_rotation, yawed_at
from ..errors import InputError
from ..numerics.robust import DEGREES, multivariate_cost
from ..prior.library import Library, transferred
from .part_pools import TORSO, part_dofs

PARTS = (TRUNK, *LIMBS)
CARRIERS = {"arm": "waist", "leg": "pelvis"}  # joint that carries a limb, by its kind


@dataclass(frozen=True, eq=False)
class KnownPostures:
    """N postures, all facing -Y with the hips over the origin, as high above the floor z = 0 as they are."""

    body: Body
    posture: Posture  # (N,)
    names: tuple[str, ...]  # (N,) of the libraries' postures
    mirrored: tuple[bool, ...]  # (N,) whether left and right are exchanged
    library: IndexArray  # (N,) number of the library that each is from

    def __len__(self) -> int:
        """Number of postures N."""
        return len(self.names)

    @cached_property
    def pose(self) -> Pose:
        """Their forward kinematics."""
        return self.body.pose(self.posture)

    @cached_property
    def parts(self) -> dict[str, Array]:
        """(N, 3 K) shape of each part, see `part_shapes`."""
        return part_shapes(self.body, self.pose)

    def costs(self, pose: Pose) -> Array:
        """(N, 5) negative log density of each of `PARTS`, 0 for the median known posture."""
        shapes = part_shapes(self.body, pose)
        return np.stack(
            [_cost(shapes[part], self.parts[part]) - self.usual[part][0] for part in PARTS], axis=-1
        )

    def contorted(self, pose: Pose) -> BoolArray:
        """(N, 5) whether each part is where no known posture has anything like it."""
        # An unknown motion may be more unusual than all known ones, by a part 40 cm from them.
        most = np.array([self.usual[part][1] - self.usual[part][0] + 6.0 for part in PARTS])
        skeleton, vector = pose.posture.skeleton, pose.posture.to_vector()
        # A joint this far beyond its range is contorted, whatever is known.
        beyond = np.abs(vector - np.clip(vector, *skeleton.limits.T)) > 0.25
        parts = [
            beyond[:, part_dofs(skeleton, *part.replace(TRUNK, TORSO).split("."))].any(axis=-1)
            for part in PARTS
        ]
        return np.asarray((self.costs(pose) > most) | np.stack(parts, axis=-1))

    @cached_property
    def usual(self) -> Mapping[str, tuple[float, float]]:
        """Median cost of a known posture by the libraries it is not from, and that of the unusual ones."""
        other = self.library[:, None] != self.library
        if not other.any():
            other = ~np.eye(len(self), dtype=bool)
        found = {}
        for part in PARTS:
            shape = self.parts[part]
            cost = _cost(shape, shape, other)
            median, unusual = np.quantile(cost, [0.5, 0.998])  # two in a thousand are called implausible
            found[part] = (float(median), float(unusual))
        return found


def known_postures(body: Body, libraries: Sequence[Library]) -> KnownPostures:
    """The postures of some libraries on a body.

    Raises:
        InputError: No library has a posture.
    """
    batches, names, numbers = [], [], []
    for number, library in enumerate(libraries):
        if library.postures:
            own = Posture.stack([each.posture for each in library.postures])
            batches.append(transferred(own, library.actor, body))
            names += [each.name for each in library.postures]
            numbers += [number] * len(library.postures)
    if not names:
        raise InputError("no keyframe library with a posture is given; at least one is needed to find poses")
    plain = Posture.concatenate(batches)
    both = Posture.concatenate([plain, mirrored(plain)])
    hips = np.zeros((len(both.translation), 3))
    hips[:, 2] = both.translation[:, 2]
    ahead = yawed_at(both, -headings_rad(both), hips)
    flags = (False,) * len(names) + (True,) * len(names)
    return KnownPostures(body, ahead, (*names, *names), flags, np.array(numbers * 2, dtype=np.intp))


def part_shapes(body: Body, pose: Pose) -> dict[str, Array]:
    """Shapes (N, 3 K) of the parts of some postures: distances of shapes are root mean squares of points [m].

    The trunk's are shoulders and head from the hips, heading left out; a limb's its two farther points in the
    frame of the joint that carries it.
    """
    points, shapes = body.points(pose), dict[str, Array]()
    trunk = [body.skeleton.point_names.index(name) for name in ("head", "shoulder.L", "shoulder.R", "hip.L")]
    upper: Array = points[:, trunk] - pose.posture.translation[:, None]
    shapes[TRUNK] = _flat(np.einsum("nki,nij->nkj", upper, yaw_rotation(headings_rad(pose.posture))))
    for limb in LIMBS:
        joint = body.skeleton.joint_index(CARRIERS[limb.partition(".")[0]])
        own = [index for index, name in enumerate(body.skeleton.point_names) if limb_of(name) == limb]
        shapes[limb] = _flat((points[:, own] - pose.origin[:, None, joint]) @ pose.rotation[:, joint])
    return shapes


def _flat(points: Array) -> Array:
    return np.asarray(points.reshape(len(points), -1) / np.sqrt(points.shape[1]))


def _cost(shape: Array, known: Array, other: BoolArray | None = None) -> Array:
    """(N,) negative logarithm of the mean kernel of shapes (N, K) by known ones (M, K), or `other` ones."""
    # |a - b|² = |a|² + |b|² - 2 a·b: one product instead of all differences.
    squared = (shape**2).sum(-1)[:, None] + (known**2).sum(-1) - 2.0 * shape @ known.T
    # A part has four dimensions: two directions of two segments; lean, turn and bend of a trunk. The degrees
    # are the likeliest for one library by the others, too.
    # 5 cm: three fifths of what performers differ by; libraries predict each other by 3 to 4.
    kernel = -multivariate_cost(np.maximum(squared, 0.0) / 0.05**2, DEGREES, 4)
    counted = np.ones(squared.shape, dtype=bool) if other is None else other
    return np.asarray(np.log(counted.sum(-1)) - logsumexp(kernel, axis=-1, b=counted))
