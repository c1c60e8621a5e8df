"""Assign a motion track of the clip to the body point that it follows."""

import bpy

from ...core.errors import InputError
from ..bridge.track_keypoints import clip_tracks
from ..shell.base_operator import BaseOperator
from ..shell.redraw import redraw_footage
from ..shell.requirements import footage, idle
from ..shell.takes import active_take
from .assigned_tracks import assign
from .body_point_items import NO_POINT, body_point_items


class KEYMARK_OT_assign_track(BaseOperator, bpy.types.Operator):
    """Choose the body point that this motion track follows; tracks that are named after one need no choice"""

    bl_idname = "keymark.assign_track"
    bl_label = "Assign Track"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, idle)

    owner: bpy.props.StringProperty(
        name="Object", description="Name of the tracking object that the track belongs to"
    )
    track: bpy.props.StringProperty(name="Track", description="Name of the motion track")
    point: bpy.props.EnumProperty(
        name="Body Point",
        description="The body point that the track follows; left and right are the performer's own",
        items=body_point_items("No Body Point"),
    )

    def run(self, context: bpy.types.Context) -> None:
        """Store the choice with the take.

        Raises:
            InputError: The clip has no such track.
        """
        take = active_take(context.scene)
        if (self.owner, self.track) not in {(owner, track.name) for owner, track in clip_tracks(take.clip)}:
            raise InputError(f"clip '{take.clip.name}' has no track '{self.track}' of object '{self.owner}'")
        assign(take, self.owner, self.track, "" if self.point == NO_POINT else self.point)
        redraw_footage(context)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_assign_track,))
