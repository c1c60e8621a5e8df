"""Arms and legs as two rigid parts: a ball at the root, a hinge in the middle, a point at the end.

Where root, middle and end lie determines the posture of the limb, but for the turn of forearm or shin about
itself, which stays.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.optimize import least_squares

from ..arrays import Array, BoolArray, IndexArray
from ..body import rotations
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import Skeleton
from ..camera.camera import Camera
from ..numerics.vectors import across as any_across
from ..numerics.vectors import unit
from .inverse_kinematics import SightLine

STEMS = {"arm": ("shoulder", "elbow", "wrist"), "leg": ("hip", "knee", "ankle")}
"""Principal points of each kind of limb: root, middle and end. The first two are joints as well."""
NO_BEND = 1e-6  # sine of a bend below which it has no plane


@dataclass(frozen=True, eq=False)
class LimbChain:
    """One limb of a skeleton."""

    name: str
    points: tuple[str, str, str]  # names of root, middle and end
    columns: IndexArray  # (3,) their places among the principal points
    ball: int  # place of the root's rotation in `Posture.rotations`
    hinge: int  # place of the bend in `Posture.angles`
    above: int  # the joint that carries the root
    rest: Array  # (3, 3) columns: direction at rest, the one it bends to, the hinge's axis
    dofs: IndexArray  # (4,) degrees of freedom of ball and hinge


@lru_cache(maxsize=32)
def limb_chain(skeleton: Skeleton, name: str) -> LimbChain:
    """A limb by its name, one of `body/limbs.LIMBS`; KeyError for another."""
    kind, _, side = name.partition(".")
    points = tuple(f"{stem}.{side}" for stem in STEMS[kind])
    root, middle = (skeleton.joint_index(point) for point in points[:2])
    axis = np.array(skeleton.joints[middle].axis)
    along = np.zeros(3)
    for factors in skeleton.joints[middle].placement.values():
        along += np.array(factors)
    along /= np.linalg.norm(along)
    ball = skeleton.ball_joints.index(root)
    hinge = skeleton.hinge_joints.index(middle)
    return LimbChain(
        name,
        (points[0], points[1], points[2]),
        np.array([skeleton.point_names.index(point) for point in points], dtype=np.intp),
        ball,
        hinge,
        skeleton.joints[root].parent,
        np.column_stack([along, np.cross(axis, along), axis]),
        np.append(skeleton.ball_dofs[ball], skeleton.hinge_dofs[hinge]),
    )


def limb_points(body: Body, posture: Posture, limb: LimbChain) -> Array:
    """(3, 3) world places of root, middle and end of a single posture's limb [m]."""
    return np.asarray(body.points(body.pose(posture))[limb.columns])


def part_lengths_m(body: Body, limb: LimbChain) -> tuple[float, float]:
    """Lengths of a limb's upper and lower part [m]."""
    root, middle, end = body.points(body.pose(Posture.rest(body.skeleton)))[limb.columns]
    return float(np.linalg.norm(middle - root)), float(np.linalg.norm(end - middle))


def aimed(body: Body, posture: Posture, limb: LimbChain, middle: Array, end: Array) -> Posture:
    """A posture with a limb that points from its root to `middle` and from there to `end`, both (3,) [m].

    Lengths are the body's own: only the directions count. A straight limb is twisted as before.
    """
    pose = body.pose(posture)
    root = body.points(pose)[limb.columns[0]]
    upper, lower = unit(middle - root), unit(end - middle)
    before = pose.rotation[limb.above] @ posture.rotations[limb.ball]
    turn, bend = _turn_and_bend(limb, upper, lower, before, float(body.skeleton.limits[limb.dofs[3], 0]))
    return with_limb(posture, limb, pose.rotation[limb.above].T @ turn, bend)


def with_limb(posture: Posture, limb: LimbChain, rotation: Array, bend: float) -> Posture:
    """A single posture with another rotation (3, 3) of a limb's ball and another bend of its hinge [rad]."""
    matrices, angles = np.array(posture.rotations), np.array(posture.angles)
    matrices[limb.ball], angles[limb.hinge] = rotation, bend
    return Posture(posture.skeleton, posture.translation, matrices, angles)


def limb_excess_rad(posture: Posture, limb: LimbChain) -> Array:
    """(4,) how far ball and hinge of a single posture's limb are beyond their joint limits [rad]."""
    values = posture.to_vector()[limb.dofs]
    lower, upper = posture.skeleton.limits[limb.dofs].T
    return np.asarray(values - np.clip(values, lower, upper))


def swing(start: Array, goal: Array) -> Array:
    """(3, 3) the shortest turn from one direction (3,) of the world to another."""
    before, after = unit(start), unit(goal)
    axis = np.cross(before, after)
    sine = float(np.linalg.norm(axis))
    if sine < NO_BEND:
        if before @ after > 0.0:
            return np.eye(3)
        axis = any_across(before)  # half a turn, about any axis across
    return np.asarray(rotations.hinge(unit(axis), np.arctan2(sine, before @ after)))


def _turn_and_bend(
    limb: LimbChain, upper: Array, lower: Array, before: Array, least_bend: float
) -> tuple[Array, float]:
    """World orientation (3, 3) of the upper part, and the bend [rad]."""
    across = lower - (lower @ upper) * upper
    sine = float(np.linalg.norm(across))
    bend = float(np.arctan2(sine, lower @ upper))
    if sine < NO_BEND:
        kept = before @ limb.rest[:, 1]
        across = kept - (kept @ upper) * upper
        if np.linalg.norm(across) < NO_BEND:  # turned exactly to where it bent to
            across = np.cross(before @ limb.rest[:, 2], upper)
    turns = [(_frame(upper, unit(across)) @ limb.rest.T, bend)]
    if -bend >= least_bend:
        # An elbow or knee may be stretched a little too far instead of twisted half round.
        turns.append((_frame(upper, -unit(across)) @ limb.rest.T, -bend))
    return max(turns, key=lambda each: float(np.trace(before.T @ each[0])))


def _frame(first: Array, second: Array) -> Array:
    return np.column_stack([first, second, np.cross(first, second)])


# --- Limbs that keep their image


DISTINCT_M = 0.02  # joints closer than this in two postures [m]: turning one into the other shows nothing


@dataclass(frozen=True, eq=False)
class LimbInSight:
    """One way in which a limb can lie on given lines of sight, within its joint limits."""

    posture: Posture  # the whole posture
    leans: BoolArray  # (2,) whether upper and lower part lead to the farther of the two places on their lines
    excess_rad: float  # how far beyond joint limits joints exactly on their lines would be [rad]
    off_m: float  # the larger distance of middle and end from their lines of sight [m]
    effort: float
    """Mean square distance of the limb's joints from the middle of their ranges, in half ranges: Liégeois
    (1977), *Automatic supervisory control of the configuration and behavior of multibody mechanisms*."""

    @property
    def strain(self) -> float:
        """How implausible the limb is; what lies outside joint limits or beside the image counts most."""
        # Strain of a meter beside the image: 5 cm, half the width of a forearm, weigh as much.
        return OUTSIDE * self.excess_rad + 20.0 * self.off_m + self.effort


OUTSIDE = 4.0  # strain of a radian beyond limits: a quarter of it weighs as a limb's whole ranges


def ways_in_sight(
    body: Body, posture: Posture, limb: LimbChain, lines: tuple[SightLine, SightLine]
) -> tuple[LimbInSight, ...]:
    """Up to four ways in which a limb can lie on the lines of sight to its middle and end, the best first.

    Lengths are exact and the rest of the body stays. Where joint limits forbid a way, it is the nearest
    posture within them, which keeps the image rather than the depth. Of ways that look the same, the most
    plausible alone counts.
    """
    start = limb_points(body, posture, limb)
    lengths = part_lengths_m(body, limb)
    found: list[LimbInSight] = []
    for upper, middle in enumerate(lines[0].at_distance(start[0], lengths[0])):
        for lower, end in enumerate(lines[1].at_distance(middle, lengths[1])):
            if min(lines[0].along_m(middle), lines[1].along_m(end)) <= 0.0:
                continue  # behind the camera
            ideal = aimed(body, posture, limb, middle, end)
            found.append(_within_limits(body, ideal, limb, lines, np.array([upper, lower]) > 0))
    kept: list[LimbInSight] = []
    for way in sorted(found, key=lambda way: way.strain):
        places = limb_points(body, way.posture, limb)
        if all(_apart_m(places, limb_points(body, other.posture, limb)) > DISTINCT_M for other in kept):
            kept.append(way)
    return tuple(kept)


def sight_lines(body: Body, posture: Posture, camera: Camera, limb: LimbChain) -> tuple[SightLine, SightLine]:
    """Lines of sight to a limb's middle and end, as a single posture has them."""
    _, middle, end = limb_points(body, posture, limb)
    return SightLine.to(camera, middle), SightLine.to(camera, end)


def depths_m(body: Body, posture: Posture, limb: LimbChain, lines: tuple[SightLine, SightLine]) -> Array:
    """(2,) how much farther away the middle lies than the root, and the end than the middle [m]."""
    root, middle, end = limb_points(body, posture, limb)
    return np.array([(middle - root) @ lines[0].direction, (end - middle) @ lines[1].direction])


def _apart_m(first: Array, second: Array) -> float:
    return float(np.linalg.norm(first - second, axis=-1).max())


def _within_limits(
    body: Body, ideal: Posture, limb: LimbChain, lines: tuple[SightLine, SightLine], leans: BoolArray
) -> LimbInSight:
    """A way of a limb, moved into its joint limits where it is beyond them."""
    excess = limb_excess_rad(ideal, limb)
    places = limb_points(body, ideal, limb)[1:]
    posture = ideal if not excess.any() else _allowed(body, ideal, limb, lines, places)
    reached = limb_points(body, posture, limb)[1:]
    off = max(line.off_m(place) for line, place in zip(lines, reached, strict=True))
    excess_rad = float(np.linalg.norm(excess))
    return LimbInSight(posture, leans, excess_rad, off, _effort(ideal, limb))


def _allowed(
    body: Body, ideal: Posture, limb: LimbChain, lines: tuple[SightLine, SightLine], places: Array
) -> Posture:
    """The posture within the limb's joint limits whose middle and end are seen nearest to their places."""
    vector = ideal.to_vector()
    lower, upper = body.skeleton.limits[limb.dofs].T
    weights = np.stack([_weights(line) for line in lines])

    def moved(values: Array) -> Posture:
        changed = vector.copy()
        changed[limb.dofs] = values
        return Posture.from_vector(body.skeleton, changed)

    def off(values: Array) -> Array:
        away = limb_points(body, moved(values), limb)[1:] - places
        return np.asarray((weights @ away[..., None]).ravel())

    def rates(values: Array) -> Array:
        posture = moved(values)
        turned = Posture.rest(body.skeleton).plus_jacobian(posture.to_vector())[np.ix_(limb.dofs, limb.dofs)]
        jacobian = body.points_jacobian(body.pose(posture))[limb.columns[1:]][..., limb.dofs]
        return np.asarray((weights @ jacobian @ turned).reshape(-1, len(limb.dofs)))

    inside = np.clip(vector[limb.dofs], lower, upper)
    fitted = least_squares(off, inside, rates, bounds=(lower, upper), max_nfev=60)
    return moved(np.clip(fitted.x, lower, upper))


def _weights(line: SightLine) -> Array:
    """(3, 3) matrix that makes less of what is along a line of sight."""
    along = np.outer(line.direction, line.direction)
    # Where joint limits allow not both, what is off the line of sight counts ten times as much.
    return np.asarray(np.eye(3) - 0.9 * along)


def strain_of(posture: Posture, limb: LimbChain) -> float:
    """How implausible a limb is as it stands; see `LimbInSight.strain`."""
    return OUTSIDE * float(np.linalg.norm(limb_excess_rad(posture, limb))) + _effort(posture, limb)


def _effort(posture: Posture, limb: LimbChain) -> float:
    lower, upper = posture.skeleton.limits[limb.dofs].T
    values = np.clip(posture.to_vector()[limb.dofs], lower, upper)
    return float(np.mean(((values - 0.5 * (lower + upper)) / (0.5 * (upper - lower))) ** 2))
