"""Arms and legs as two rigid parts: a ball at the root, a hinge in the middle, a point at the end.

Where root, middle and end lie determines the posture of the limb, but for the turn of forearm or shin about
itself, which stays.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from ..arrays import Array, BoolArray, IndexArray
from ..body import rotations
from ..body.kinematics import Body
from ..body.posture import Posture
from ..camera.camera import Camera
from ..numerics.vectors import across as any_across
from ..numerics.vectors import unit
from .inverse_kinematics import SightLine

STEMS = {"arm": ("shoulder", "elbow", "wrist"), "leg": ("hip", "knee", "ankle")}
"""Principal points of each kind of limb: root, middle and end. The first two are joints as well."""
NO_BEND = 1e-6  # sine of a bend below which it has no plane
DISTINCT_M = 0.02  # joints closer than this in two postures [m]: turning one into the other shows nothing
OUTSIDE = 4.0  # strain of a radian beyond limits: a quarter of it weighs as a limb's whole ranges
Lines = tuple[SightLine, SightLine]  # to a limb's middle and end


@dataclass(frozen=True, eq=False)
class LimbInSight:
    """One way in which a limb can lie on given lines of sight, within its joint limits."""

    posture: Posture  # the whole posture
    leans: BoolArray  # (2,) whether upper and lower part lead to the farther of the two places on their lines
    off_m: float  # the larger distance of middle and end from their lines of sight [m]
    strain: float  # how implausible it is; what lies outside joint limits or beside the image counts most


@dataclass(frozen=True, eq=False)
class LimbChain:
    """One limb of a body; postures are single ones."""

    body: Body
    points: tuple[str, str, str]  # names of root, middle and end
    columns: IndexArray  # (3,) their places among the principal points
    ball: int  # place of the root's rotation in `Posture.rotations`
    hinge: int  # place of the bend in `Posture.angles`
    above: int  # the joint that carries the root
    rest: Array  # (3, 3) columns: direction at rest, the one it bends to, the hinge's axis
    dofs: IndexArray  # (4,) degrees of freedom of ball and hinge
    lengths_m: tuple[float, float]  # of the upper and the lower part

    @classmethod
    def of(cls, body: Body, name: str) -> "LimbChain":
        """A limb by its name, one of `body/human.LIMBS`; KeyError for another."""
        skeleton = body.skeleton
        kind, _, side = name.partition(".")
        names = tuple(f"{stem}.{side}" for stem in STEMS[kind])
        root, middle = (skeleton.joint_index(point) for point in names[:2])
        axis, along = np.array(skeleton.joints[middle].axis), np.zeros(3)
        for factors in skeleton.joints[middle].placement.values():
            along += np.array(factors)
        along = unit(along)
        ball, hinge = skeleton.ball_joints.index(root), skeleton.hinge_joints.index(middle)
        columns = np.array([skeleton.point_names.index(point) for point in names], dtype=np.intp)
        at_rest = body.points(body.pose(Posture.rest(skeleton)))[columns]
        upper_m, lower_m = map(float, np.linalg.norm(np.diff(at_rest, axis=0), axis=-1))
        return cls(
            body,
            (names[0], names[1], names[2]),
            columns,
            ball,
            hinge,
            skeleton.joints[root].parent,
            np.column_stack([along, np.cross(axis, along), axis]),
            np.append(skeleton.ball_dofs[ball], skeleton.hinge_dofs[hinge]),
            (upper_m, lower_m),
        )

    @property
    def limits(self) -> Array:
        """(4, 2) lower and upper limits of ball and hinge [rad]."""
        return self.body.skeleton.limits[self.dofs]

    def places(self, posture: Posture) -> Array:
        """(3, 3) world places of root, middle and end [m]."""
        return np.asarray(self.body.points(self.body.pose(posture))[self.columns])

    def excess_rad(self, posture: Posture) -> Array:
        """(4,) how far ball and hinge are beyond their joint limits [rad]."""
        values = posture.to_vector()[self.dofs]
        return np.asarray(values - np.clip(values, *self.limits.T))

    def strain(self, posture: Posture) -> float:
        """How implausible the limb is as it stands.

        Beside what is beyond limits, the mean square distance of the joints from the middle of their ranges,
        in half ranges: Liégeois (1977), *Automatic supervisory control of the configuration and behavior of
        multibody mechanisms*.
        """
        lower, upper = self.limits.T
        values = np.clip(posture.to_vector()[self.dofs], lower, upper)
        effort = float(np.mean(((values - 0.5 * (lower + upper)) / (0.5 * (upper - lower))) ** 2))
        return OUTSIDE * float(np.linalg.norm(self.excess_rad(posture))) + effort

    def aimed(self, posture: Posture, middle: Array, end: Array) -> Posture:
        """A posture with the limb pointing from its root to `middle` and from there to `end`, both (3,) [m].

        Lengths are the body's own: only the directions count. A straight limb is twisted as before.
        """
        pose = self.body.pose(posture)
        root = self.body.points(pose)[self.columns[0]]
        before = pose.rotation[self.above] @ posture.rotations[self.ball]
        turn, bend = self._turn_and_bend(unit(middle - root), unit(end - middle), before)
        matrices, angles = np.array(posture.rotations), np.array(posture.angles)
        matrices[self.ball], angles[self.hinge] = pose.rotation[self.above].T @ turn, bend
        return Posture(posture.skeleton, posture.translation, matrices, angles)

    def _turn_and_bend(self, upper: Array, lower: Array, before: Array) -> tuple[Array, float]:
        """World orientation (3, 3) of the upper part, and the bend [rad]."""
        across = lower - (lower @ upper) * upper
        sine = float(np.linalg.norm(across))
        bend = float(np.arctan2(sine, lower @ upper))
        if sine < NO_BEND:
            kept = before @ self.rest[:, 1]
            across = kept - (kept @ upper) * upper
            if np.linalg.norm(across) < NO_BEND:  # turned exactly to where it bent to
                across = np.cross(before @ self.rest[:, 2], upper)
        turns = []
        for side, own in ((unit(across), bend), (-unit(across), -bend)):
            # An elbow or knee may be stretched a little too far instead of twisted half round.
            if own >= min(bend, self.limits[3, 0]):
                turns.append((np.column_stack([upper, side, np.cross(upper, side)]) @ self.rest.T, own))
        return max(turns, key=lambda each: float(np.trace(before.T @ each[0])))

    def sight_lines(self, posture: Posture, camera: Camera) -> Lines:
        """Lines of sight to the limb's middle and end, as a posture has them."""
        _, middle, end = self.places(posture)
        return SightLine.to(camera, middle), SightLine.to(camera, end)

    def depths_m(self, posture: Posture, lines: Lines) -> Array:
        """(2,) how much farther away the middle lies than the root, and the end than the middle [m]."""
        parts = np.diff(self.places(posture), axis=0)
        return np.array([part @ line.direction for part, line in zip(parts, lines, strict=True)])

    def ways_in_sight(self, posture: Posture, lines: Lines) -> tuple[LimbInSight, ...]:
        """Up to four ways in which the limb can lie on the lines of sight to its middle and end, best first.

        Lengths are exact and the rest of the body stays. Where joint limits forbid a way, it is the nearest
        posture within them, which keeps the image rather than the depth. Of ways that look the same, the most
        plausible alone counts.
        """
        root = self.places(posture)[0]
        found: list[LimbInSight] = []
        for upper, middle in enumerate(lines[0].at_distance(root, self.lengths_m[0])):
            for lower, end in enumerate(lines[1].at_distance(middle, self.lengths_m[1])):
                if min(lines[0].along_m(middle), lines[1].along_m(end)) > 0.0:  # before the camera
                    ideal = self.aimed(posture, middle, end)
                    within = self._within_limits(ideal, lines) if self.excess_rad(ideal).any() else ideal
                    reached = self.places(within)[1:]
                    off = max(line.off_m(place) for line, place in zip(lines, reached, strict=True))
                    # Strain of a meter beside the image: 5 cm, half the width of a forearm, weigh as much.
                    strain = self.strain(ideal) + 20.0 * off
                    found.append(LimbInSight(within, np.array([upper, lower]) > 0, off, strain))
        kept: list[LimbInSight] = []
        for way in sorted(found, key=lambda way: way.strain):
            places = self.places(way.posture)
            apart = [np.linalg.norm(places - self.places(other.posture), axis=-1).max() for other in kept]
            if not apart or min(apart) > DISTINCT_M:
                kept.append(way)
        return tuple(kept)

    def _within_limits(self, ideal: Posture, lines: Lines) -> Posture:
        """The posture within the limb's limits whose middle and end are seen nearest to their places."""
        skeleton, places = self.body.skeleton, self.places(ideal)[1:]
        vector = ideal.to_vector()
        lower, upper = self.limits.T
        # Where joint limits allow not both, what is off the line of sight counts ten times as much.
        weights = np.stack([np.eye(3) - 0.9 * np.outer(line.direction, line.direction) for line in lines])

        def moved(values: Array) -> Posture:
            changed = vector.copy()
            changed[self.dofs] = values
            return Posture.from_vector(skeleton, changed)

        def off(values: Array) -> Array:
            return np.asarray((weights @ (self.places(moved(values))[1:] - places)[..., None]).ravel())

        def rates(values: Array) -> Array:
            posture = moved(values)
            turned = Posture.rest(skeleton).plus_jacobian(posture.to_vector())[np.ix_(self.dofs, self.dofs)]
            jacobian = self.body.points_jacobian(self.body.pose(posture))[self.columns[1:]][..., self.dofs]
            return np.asarray((weights @ jacobian @ turned).reshape(-1, len(self.dofs)))

        inside = np.clip(vector[self.dofs], lower, upper)
        fitted = least_squares(off, inside, rates, bounds=(lower, upper), max_nfev=60)
        return moved(np.clip(fitted.x, lower, upper))


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
