"""Controls as a `Rig`, for key reduction: in meters, in the axes of the armature or of what carries them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..finish.rig import NO_TURN, Rig, RigBone, RigPose
from .control_channels import Control, ControlChannels
from .control_spaces import NOTHING


def control_rig(
    controls: Sequence[Control],
    channels: Sequence[ControlChannels],
    chosen: Sequence[int],
    points: Mapping[int, Array],
    scale: float,
) -> Rig:
    """The rig of some controls.

    What turns or carries one of them and is not among them is taken as still: the rig's axes are its axes.

    Args:
        controls: All controls, those that turn or carry others first.
        channels: The channels of each, which say what is keyed.
        chosen: Indices of the controls of the rig, rising.
        points: (N, 3) by control points fixed to it, in its axes from its head [m].
        scale: Meters a unit of the armature's space.
    """
    row = {index: number for number, index in enumerate(chosen)}
    bones = []
    for index in chosen:
        control, keyed, space = controls[index], channels[index], controls[index].space
        parent, turner = row.get(space.carrier, NOTHING), row.get(space.turner, NOTHING)
        bones.append(
            RigBone(
                name=control.name,
                parent=parent,
                mode=NO_TURN if keyed.rotation is None else control.mode,
                left=space.turn,
                right=np.eye(3),
                origin=scale * space.origin,
                points=points.get(index, np.zeros((0, 3))),
                location_axes=None if keyed.location is None else scale * space.axes,
                turned_by=turner if turner != parent else None,
            )
        )
    return Rig(tuple(bones))


def rig_bone_channels(
    rig: Rig, pose: RigPose, bone: int, channels: ControlChannels, scale: float
) -> ControlChannels:
    """A control's channels with the turn and place that its bone in the rig shows."""
    place = pose.points[:, rig.point_slices[bone].start] / scale
    return replace(channels, turn=pose.rotation[bone], place=place)
