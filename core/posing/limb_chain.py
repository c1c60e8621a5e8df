"""Arms and legs as two rigid parts: a ball at the root, a hinge in the middle, a point at the end.

Where root, middle and end lie determines the posture of the limb, but for the turn of forearm or shin about
itself, which stays.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..arrays import Array, IndexArray
from ..body import rotations
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import Skeleton
from ..numerics.vectors import across as any_across
from ..numerics.vectors import unit

STEMS = {"arm": ("shoulder", "elbow", "wrist"), "leg": ("hip", "knee", "ankle")}
"""Principal points of each kind of limb: root, middle and end. The first two are joints as well."""
NO_BEND = 1e-6
"""Sine of a bend below which it has no plane."""


@dataclass(frozen=True, eq=False)
class LimbChain:
    """One limb of a skeleton."""

    name: str
    points: tuple[str, str, str]
    """Names of root, middle and end."""
    columns: IndexArray
    """(3,) their places among the principal points."""
    ball: int
    """Place of the root's rotation in `Posture.rotations`."""
    hinge: int
    """Place of the bend in `Posture.angles`."""
    above: int
    """The joint that carries the root."""
    rest: Array
    """(3, 3) as columns the limb's direction at rest, the direction it bends to, and the hinge's axis."""
    dofs: IndexArray
    """(4,) degrees of freedom of ball and hinge."""


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
    """A single posture with a limb that points from its root to `middle` and from there to `end`.

    Lengths are the body's own: only the directions count. A straight limb is twisted as before.

    Args:
        body: The actor's body.
        posture: Its posture, the rest of which stays.
        limb: The limb.
        middle: (3,) a point in the world [m].
        end: (3,) likewise.
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
