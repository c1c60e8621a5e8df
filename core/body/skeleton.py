"""The skeleton as data: elementary joints, their degrees of freedom, segments and principal points.

The paper's Figure 2, which shows where its 34 degrees of freedom lie, is lost; this distribution is
our reading: pelvis 3 translations + 3 rotations, waist 3, neck 3, shoulders 3 + girdle elevation 1,
elbows flexion + forearm pronation, hips 3, knees flexion + axial rotation.

At rest the performer stands upright facing -Y with the arms stretched sideways; left is +X.
"""

from dataclasses import dataclass
from enum import Enum
from functools import cached_property

import numpy as np

from ..arrays import Array, BoolArray, IndexArray

Vector = tuple[float, float, float]
Placement = dict[str, Vector]  # in the parent's frame: factors on x, y and z of the actor's lengths

SIDES = ("L", "R")
FINGERS = ("thumb", "index", "middle", "ring", "pinky")


class JointKind(Enum):
    """How an elementary joint moves."""

    FREE = "free"
    BALL = "ball"
    HINGE = "hinge"


@dataclass(frozen=True)
class Joint:
    """An elementary joint. An anatomical joint may be a chain of them (shoulder: girdle, then ball)."""

    name: str
    parent: int
    kind: JointKind
    placement: Placement
    axis: Vector = (0.0, 0.0, 0.0)  # unit hinge axis, the same in parent and child; unused otherwise
    components: tuple[str, ...] = ()  # names of its degrees of freedom after the joint's name
    limits_deg: tuple[tuple[float, float], ...] = ()  # range of each rotational component [degrees]
    deviations: tuple[float, ...] = ()  # measured, from a keyframe-interpolated prior [m, rad]

    @property
    def dof_count(self) -> int:
        """Number of degrees of freedom."""
        return len(self.components)


@dataclass(frozen=True)
class Segment:
    """A rigid body part, drawn as a bone, moving with a joint's frame."""

    name: str
    joint: int
    start: Placement
    end: Placement
    parent: str | None


@dataclass(frozen=True)
class PrincipalPoint:
    """A named point fixed in a joint's frame."""

    name: str
    joint: int
    placement: Placement


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Joints in topological order, parents first, with the segments and points fixed to them."""

    joints: tuple[Joint, ...]
    segments: tuple[Segment, ...]
    points: tuple[PrincipalPoint, ...]

    @cached_property
    def dof_names(self) -> tuple[str, ...]:
        """Names of the degrees of freedom, in the order of the posture vector."""
        return tuple(f"{joint.name}.{part}" for joint in self.joints for part in joint.components)

    @property
    def dof_count(self) -> int:
        """Number of degrees of freedom D."""
        return len(self.dof_names)

    @cached_property
    def dof_starts(self) -> tuple[int, ...]:
        """Index of each joint's first degree of freedom."""
        return tuple(int(n) for n in np.cumsum([0, *(joint.dof_count for joint in self.joints)])[:-1])

    @cached_property
    def ball_joints(self) -> tuple[int, ...]:
        """Joints that carry a free rotation, in order; the B of `Posture.rotations`."""
        return tuple(i for i, joint in enumerate(self.joints) if joint.kind is not JointKind.HINGE)

    @cached_property
    def hinge_joints(self) -> tuple[int, ...]:
        """Joints that carry one angle, in order; the H of `Posture.angles`."""
        return tuple(i for i, joint in enumerate(self.joints) if joint.kind is JointKind.HINGE)

    @cached_property
    def ball_dofs(self) -> IndexArray:
        """(B, 3) indices of the rotational degrees of freedom of each ball."""
        first = [
            self.dof_starts[i] + (3 if self.joints[i].kind is JointKind.FREE else 0) for i in self.ball_joints
        ]
        return np.asarray(first, dtype=np.intp)[:, None] + np.arange(3)

    @cached_property
    def hinge_dofs(self) -> IndexArray:
        """(H,) indices of the hinge angles."""
        return np.asarray([self.dof_starts[i] for i in self.hinge_joints], dtype=np.intp)

    @cached_property
    def hinge_axes(self) -> Array:
        """(H, 3) unit axes of the hinges, the same in parent and child."""
        return np.array([self.joints[i].axis for i in self.hinge_joints]).reshape(-1, 3)

    @cached_property
    def moved_by(self) -> BoolArray:
        """(J, D) whether each degree of freedom moves each joint's frame."""
        moved = np.zeros((len(self.joints), self.dof_count), dtype=bool)
        for i, joint in enumerate(self.joints):
            if joint.parent >= 0:
                moved[i] = moved[joint.parent]
            moved[i, self.dof_starts[i] : self.dof_starts[i] + joint.dof_count] = True
        return moved

    @cached_property
    def limbs(self) -> tuple[IndexArray, ...]:
        """Degrees of freedom by part of the body: first the trunk, then each limb that branches off it.

        The trunk consists of the joints with several children.
        """
        children = np.bincount([joint.parent for joint in self.joints[1:]], minlength=len(self.joints))
        part: list[int] = []
        parts = 1
        for joint in self.joints:
            below_trunk = joint.parent >= 0 and part[joint.parent] > 0
            if below_trunk:
                part.append(part[joint.parent])
            elif joint.parent < 0 or children[len(part)] > 1:
                part.append(0)
            else:
                part.append(parts)
                parts += 1
        owner = np.repeat(part, [joint.dof_count for joint in self.joints])
        return tuple(np.flatnonzero(owner == index) for index in range(parts))

    @cached_property
    def limits(self) -> Array:
        """(D, 2) lower and upper bound of each component of the posture vector [m, rad]."""
        bounds = np.full((self.dof_count, 2), [-np.inf, np.inf])
        for start, joint in zip(self.dof_starts, self.joints, strict=True):
            skipped = joint.dof_count - len(joint.limits_deg)
            for offset, pair in enumerate(joint.limits_deg):
                bounds[start + skipped + offset] = np.radians(pair)
        return bounds

    @cached_property
    def deviations(self) -> Array:
        """(D,) natural deviation from a prior interpolated between keyframes [m, rad]."""
        return np.concatenate([joint.deviations for joint in self.joints])

    @cached_property
    def point_names(self) -> tuple[str, ...]:
        """Names of the principal points, in order."""
        return tuple(point.name for point in self.points)

    def joint_index(self, name: str) -> int:
        """Index of the joint called `name`; KeyError where there is none."""
        return {joint.name: index for index, joint in enumerate(self.joints)}[name]

    def segment(self, name: str) -> Segment:
        """The segment called `name`; KeyError where there is none."""
        return {segment.name: segment for segment in self.segments}[name]
