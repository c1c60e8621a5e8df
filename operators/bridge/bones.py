"""Bones of the skeleton: one for each segment, with axes an animator can turn by hand.

A bone's Y runs along its segment. Its X is the axis of the segment's first hinge, so that a positive
turn about local X raises the girdle, bends the elbow and bends the knee, and a positive turn about local
Y pronates the forearm or turns the shin. A segment without a hinge takes the X of the segment that
continues it in a straight line (upper arm from forearm, thigh from shin), a rigid leaf that of its
parent (hand, foot), and all others the body's left. Left and right are then mirror images as Blender
defines them, so that pasting a pose flipped works.

The bone's axes define the joint's frame: `frame = bone rotation @ axes.T`, whatever the armature's rest
pose is. Editing the rest pose to an A pose, or applying the object's rotation, changes nothing.
"""

from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.body.skeleton import JointKind, Segment, Skeleton

STRAIGHT = 1.0 - 1e-6
"""Cosine above which a segment continues another."""
HINGE_ORDER = "YZX"


@dataclass(frozen=True, eq=False)
class BoneModel:
    """A segment as a bone."""

    name: str
    parent: str | None
    joint: int
    """The joint whose frame the bone moves with."""
    chain: tuple[int, ...]
    """Elementary joints between the parent's frame and this one's, outermost last; empty for rigid leaves."""
    axes: Array
    """(3, 3) the bone's axes at rest as columns, in the joint's frame."""
    start: Array
    """(3,) the bone's head in its joint's frame [m]."""
    end: Array
    """(3,) the bone's tail in its joint's frame [m]."""

    @property
    def is_root(self) -> bool:
        """Whether the bone carries the body's location in the world."""
        return self.parent is None


def bone_models(body: Body) -> tuple[BoneModel, ...]:
    """The body's bones, parents first.

    Args:
        body: Skeleton and sizes; lengths in meters.
    """
    skeleton = body.skeleton
    axes: dict[str, Array] = {}
    models = []
    for segment in skeleton.segments:
        along = _direction(body, segment)
        x = _bending_axis(body, segment, axes)
        axes[segment.name] = np.column_stack([x, along, np.cross(x, along)])
        models.append(
            BoneModel(
                segment.name,
                segment.parent,
                segment.joint,
                _chain(skeleton, segment),
                axes[segment.name],
                body.local(segment.start),
                body.local(segment.end),
            )
        )
    return tuple(models)


def usual_mode(skeleton: Skeleton, model: BoneModel) -> str:
    """The rotation mode that a bone is built with: Euler angles for hinges, quaternions for balls."""
    hinged = any(skeleton.joints[index].kind is JointKind.HINGE for index in model.chain)
    return HINGE_ORDER if hinged else "QUATERNION"


def rest_matrices(body: Body) -> dict[str, Array]:
    """(4, 4) rest matrix of each bone, as `build_armature` builds them: a T pose on z = 0 [m]."""
    models = bone_models(body)
    origins = body.pose(Posture.rest(body.skeleton)).origin
    floor = min(float((origins[model.joint] + model.end)[2]) for model in models)
    rest = {}
    for model in models:
        matrix = np.eye(4)
        matrix[:3, :3] = model.axes
        matrix[:3, 3] = origins[model.joint] + model.start - [0.0, 0.0, floor]
        rest[model.name] = matrix
    return rest


def _direction(body: Body, segment: Segment) -> Array:
    along = body.local(segment.end) - body.local(segment.start)
    return np.asarray(along / np.linalg.norm(along))


def _chain(skeleton: Skeleton, segment: Segment) -> tuple[int, ...]:
    above = next((s.joint for s in skeleton.segments if s.name == segment.parent), -1)
    chain: list[int] = []
    joint = segment.joint
    while joint != above:
        chain.insert(0, joint)
        joint = skeleton.joints[joint].parent
    return tuple(chain)


def _first_hinge(skeleton: Skeleton, segment: Segment) -> Array | None:
    for joint in _chain(skeleton, segment):
        if skeleton.joints[joint].kind is JointKind.HINGE:
            return np.asarray(skeleton.joints[joint].axis)
    return None


def _bending_axis(body: Body, segment: Segment, known: dict[str, Array]) -> Array:
    axis = _first_hinge(body.skeleton, segment)
    if axis is not None:
        return axis
    along = _direction(body, segment)
    for other in body.skeleton.segments:
        if other.parent == segment.name and _direction(body, other) @ along > STRAIGHT:
            follower = _first_hinge(body.skeleton, other)
            if follower is not None:
                return follower
    if segment.parent and not _chain(body.skeleton, segment):
        return np.asarray(known[segment.parent][:, 0])
    return np.array([1.0, 0.0, 0.0])
