"""Forward kinematics and Jacobians of an actor's skeleton, over any batch of postures."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType

import numpy as np

from ..arrays import Array, IndexArray
from . import rotations
from .actor import Actor
from .human import HUMAN
from .posture import Posture
from .skeleton import Placement, Skeleton


@dataclass(frozen=True, eq=False)
class Pose:
    """Result of forward kinematics: every joint's frame in the world."""

    posture: Posture
    rotation: Array  # (..., J, 3, 3) world orientation of each joint's frame
    origin: Array  # (..., J, 3) world position of each joint's frame [m]

    def __getitem__(self, index: slice) -> "Pose":
        """The poses of some postures along the first batch axis."""
        return Pose(self.posture[index], self.rotation[index], self.origin[index])

    @cached_property
    def screws(self) -> Array:
        """(..., 6, D) spatial velocity per unit tangent step: rows 0:3 linear (at the origin), 3:6 angular.

        Where a degree of freedom moves a frame, a point p of that frame has the derivative v + ω × p.
        """
        skeleton = self.posture.skeleton
        screws = np.zeros((*self.posture.batch, 6, skeleton.dof_count))
        screws[..., 0:3, 0:3] = np.eye(3)
        balls, hinges = list(skeleton.ball_joints), list(skeleton.hinge_joints)
        axes = self.rotation[..., balls, :, :]  # (..., B, 3, 3), an axis a column
        moments = rotations.cross_matrix(self.origin[..., balls, :]) @ axes
        screws[..., 3:6, skeleton.ball_dofs] = np.moveaxis(axes, -3, -2)
        screws[..., 0:3, skeleton.ball_dofs] = np.moveaxis(moments, -3, -2)
        axis = self.rotation[..., hinges, :, :] @ skeleton.hinge_axes[..., None]  # (..., H, 3, 1)
        moment = rotations.cross_matrix(self.origin[..., hinges, :]) @ axis
        screws[..., 3:6, skeleton.hinge_dofs] = np.swapaxes(axis[..., 0], -1, -2)
        screws[..., 0:3, skeleton.hinge_dofs] = np.swapaxes(moment[..., 0], -1, -2)
        return screws

    def place(self, joint: int, local: Array) -> Array:
        """World position (..., 3) of a point given in a joint's frame [m]."""
        return np.asarray(self.origin[..., joint, :] + self.rotation[..., joint, :, :] @ local)

    def places_jacobian(self, joints: Sequence[int] | IndexArray, world: Array) -> Array:
        """d world / d tangent (..., N, 3, D) of points `world` (..., N, 3), each fixed in a joint's frame."""
        # v + ω × p for all points in one product: the rows 1 and -[p]× with all screws.
        unit = np.broadcast_to(np.eye(3), (*world.shape, 3))
        rows = np.concatenate([unit, -rotations.cross_matrix(world)], axis=-1)
        flat = rows.reshape(*world.shape[:-2], -1, 6) @ self.screws
        jacobian = flat.reshape(*world.shape, -1)
        jacobian *= self.posture.skeleton.moved_by[joints][:, None, :]
        return np.asarray(jacobian)

    def along_jacobian(self, joints: Sequence[int] | IndexArray, world: Array, direction: Array) -> Array:
        """d (direction · world) / d tangent (..., N, D) of points (..., N, 3), each fixed in a joint's frame.

        The directions (..., N, 3) do not turn with the body.
        """
        # direction · (v + ω × p) is direction · v + (p × direction) · ω.
        wrench = np.concatenate([direction, rotations.cross(world, direction)], axis=-1)
        return np.asarray((wrench @ self.screws) * self.posture.skeleton.moved_by[joints])


@dataclass(frozen=True, eq=False)
class Body:
    """A skeleton with an actor's segment lengths."""

    actor: Actor
    skeleton: Skeleton = HUMAN

    def local(self, placement: Placement) -> Array:
        """A placement of the skeleton in meters (3,), for this actor."""
        position = np.zeros(3)
        for length, factors in placement.items():
            position += self.actor.segments_m[length] * np.asarray(factors)
        return position

    @cached_property
    def offsets(self) -> Array:
        """(J, 3) position of each joint in its parent's frame [m]."""
        return np.stack([self.local(joint.placement) for joint in self.skeleton.joints])

    @cached_property
    def point_places(self) -> Array:
        """(P, 3) position of each principal point in its joint's frame [m]."""
        return np.stack([self.local(point.placement) for point in self.skeleton.points])

    def pose(self, posture: Posture) -> Pose:
        """Forward kinematics: every joint's frame in the world."""
        skeleton = self.skeleton
        count = len(skeleton.joints)
        rotation = np.empty((*posture.batch, count, 3, 3))
        origin = np.empty((*posture.batch, count, 3))
        turns = posture.joint_turns()
        for i, joint in enumerate(skeleton.joints):
            if joint.parent < 0:
                rotation[..., i, :, :] = turns[i]
                origin[..., i, :] = posture.translation + self.offsets[i]
            else:
                above = rotation[..., joint.parent, :, :]
                rotation[..., i, :, :] = above @ turns[i]
                origin[..., i, :] = origin[..., joint.parent, :] + above @ self.offsets[i]
        return Pose(posture, rotation, origin)

    def points(self, pose: Pose) -> Array:
        """World positions (..., P, 3) of the principal points [m]."""
        joints = [point.joint for point in self.skeleton.points]
        turned = pose.rotation[..., joints, :, :] @ self.point_places[..., None]
        return np.asarray(pose.origin[..., joints, :] + turned[..., 0])

    def points_jacobian(self, pose: Pose) -> Array:
        """d points / d tangent, (..., P, 3, D) [m per m or rad]."""
        return pose.places_jacobian([point.joint for point in self.skeleton.points], self.points(pose))

    def segment_ends(self, pose: Pose, name: str) -> tuple[Array, Array]:
        """World positions (..., 3) of a segment's two ends [m]; KeyError for an unknown segment."""
        segment = self.skeleton.segment(name)
        start, end = self.local(segment.start), self.local(segment.end)
        return pose.place(segment.joint, start), pose.place(segment.joint, end)


# --- Extremities


@dataclass(frozen=True, eq=False)
class Extremities:
    """How hands and feet are turned about wrists and ankles, beside a batch of postures."""

    turns: Mapping[str, Array]  # (..., 3, 3) in its parent's frame, by segment; rigid if not listed

    def without(self, names: Collection[str]) -> "Extremities":
        """Those that are not named."""
        kept = {name: turn for name, turn in self.turns.items() if name not in names}
        return Extremities(MappingProxyType(kept))


RIGID = Extremities(MappingProxyType({}))  # all of them as their parents


def extremity_names(skeleton: Skeleton) -> tuple[str, ...]:
    """The segments that move with their parent's joint: hands and feet."""
    joint_of = {segment.name: segment.joint for segment in skeleton.segments}
    return tuple(
        segment.name
        for segment in skeleton.segments
        if segment.parent is not None and segment.joint == joint_of[segment.parent]
    )


def segment_turn(body: Body, pose: Pose, extremities: Extremities, name: str) -> Array:
    """World orientation (..., 3, 3) of a segment's frame; KeyError for an unknown one."""
    above = pose.rotation[..., body.skeleton.segment(name).joint, :, :]
    return np.asarray(above @ extremities.turns[name]) if name in extremities.turns else above


def segment_ends(body: Body, pose: Pose, extremities: Extremities, name: str) -> tuple[Array, Array]:
    """World positions (..., 3) of a segment's two ends [m]; KeyError for an unknown segment."""
    start, end = body.segment_ends(pose, name)
    if name not in extremities.turns:
        return start, end
    segment = body.skeleton.segment(name)
    along = body.local(segment.end) - body.local(segment.start)
    return start, np.asarray(start + segment_turn(body, pose, extremities, name) @ along)


# --- A motion segment by segment


@dataclass(frozen=True, eq=False)
class SegmentMotion:
    """The body's segments in F frames, feet and hands included, which postures do not turn."""

    body: Body
    time_s: Array  # (F,) time of each frame [s]
    turn: Mapping[str, Array]  # (F, 3, 3) in the world from the T pose that faces -Y, by segment
    start: Mapping[str, Array]  # (F, 3) by segment: its joint nearer to the trunk [m]
    end: Mapping[str, Array]  # (F, 3) by segment: its other end [m]
    fingers: Mapping[str, Array] = field(default_factory=dict)
    """(F, 3) flexions of fingers' joints by name as `index.L` [rad]; none where they are not known."""


def segment_motion(body: Body, posture: Posture, time_s: Array, extremities: Extremities) -> SegmentMotion:
    """The motion of every segment, hands and feet as they are posed or `feet/natural_extremities` says."""
    pose = body.pose(posture)
    names = [segment.name for segment in body.skeleton.segments]
    ends = {name: segment_ends(body, pose, extremities, name) for name in names}
    return SegmentMotion(
        body,
        time_s,
        {name: segment_turn(body, pose, extremities, name) for name in names},
        {name: start for name, (start, _) in ends.items()},
        {name: end for name, (_, end) in ends.items()},
    )
