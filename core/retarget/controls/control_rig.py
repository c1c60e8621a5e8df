"""Controls as a `Rig`, for key reduction: in meters, in the axes of the armature or of what carries them.

A control that is turned and moved is two bones of the rig, one that is moved and on it one that is turned, so
that its location and its rotation have keys of their own.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Array
from ...finish.hermite import Spline
from ...finish.rig import NO_TURN, Rig, RigBone, RigPose
from .control_channels import Control, ControlChannels
from .control_motion import ChannelValues, KeyedControl
from .control_spaces import NOTHING

NO_POINTS = np.zeros((0, 3))
UNMOVED = np.zeros(3)


@dataclass(frozen=True, eq=False)
class ControlRig:
    """Some of the controls as a rig."""

    rig: Rig
    moved: Mapping[int, int]  # row of the rig's bone by the index of a control that is moved ...
    turned: Mapping[int, int]
    """... and of the bone that carries its points and whatever hangs on it, turned where it is turned."""

    def values(
        self, controls: Sequence[Control], channels: Sequence[ControlChannels], of: ChannelValues
    ) -> list[Array]:
        """What each bone of the rig holds."""
        found = [np.zeros((0, 0))] * len(self.rig.bones)
        for index, row in self.turned.items():
            rotation, frames = channels[index].rotation, len(channels[index].place)
            mode = controls[index].mode
            found[row] = np.zeros((frames, 0)) if rotation is None else of(rotation, mode)
        for index, row in self.moved.items():
            location = channels[index].location
            assert location is not None
            found[row] = location
        return found

    def keyed(self, controls: Sequence[Control], splines: Sequence[Spline]) -> dict[int, KeyedControl]:
        """What is keyed on each control, from the keys of the rig's bones."""
        return {
            index: KeyedControl(
                controls[index],
                None if self.rig.bones[row].mode == NO_TURN else splines[row],
                splines[self.moved[index]] if index in self.moved else None,
            )
            for index, row in self.turned.items()
        }

    def shown(self, pose: RigPose, index: int, channels: ControlChannels, scale: float) -> ControlChannels:
        """A control's channels with the turn and place that the rig's pose shows."""
        row = self.turned[index]
        place = pose.points[:, self.rig.point_slices[row].start] / scale
        return replace(channels, turn=pose.rotation[row], place=place)


def control_rig(
    controls: Sequence[Control],
    channels: Sequence[ControlChannels],
    chosen: Sequence[int],
    points: Mapping[int, Array],
    scale: float,
) -> ControlRig:
    """The rig of the controls at some rising indices, with points (N, 3) fixed to each, from its head [m].

    What turns or carries one of them and is not among them is taken as still: the rig's axes are its axes.
    """
    bones: list[RigBone] = []
    moved: dict[int, int] = {}
    turned: dict[int, int] = {}
    for index in chosen:
        control, keyed, space = controls[index], channels[index], controls[index].space
        parent, turner = (turned.get(other, NOTHING) for other in (space.carrier, space.turner))
        origin, axes = scale * space.origin, np.eye(3)
        if keyed.location is not None:
            axes = scale * space.axes
            moved[index] = len(bones)
            bones.append(
                RigBone(control.name, parent, NO_TURN, np.eye(3), np.eye(3), origin, NO_POINTS, axes)
            )
            parent, origin = moved[index], UNMOVED
        turned[index] = len(bones)
        mode = NO_TURN if keyed.rotation is None else control.mode
        own = points.get(index, NO_POINTS)
        bones.append(
            RigBone(
                control.name,
                parent,
                mode,
                space.turn,
                np.eye(3),
                origin,
                own,
                None,
                None if turner == parent else turner,
            )
        )
    return ControlRig(Rig(tuple(bones)), moved, turned)
