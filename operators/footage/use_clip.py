"""Use a clip that Blender has already."""

from pathlib import Path

import bpy

from ..shell.messages import say
from ..shell.requirements import all_met, idle
from ..shell.takes import add_take, find_take
from .take_footage import give_footage, look_through_camera, name_for, show_range


class KEYMARK_OT_use_clip(bpy.types.Operator):
    """Use a clip that is in this file already, with the lens and the solution that its tracking holds"""

    bl_idname = "keymark.use_clip"
    bl_label = "Use Clip"
    bl_options = {"REGISTER", "UNDO"}

    clip: bpy.props.StringProperty(
        name="Clip",
        description="Name of the clip in this file; without one, the scene's own",
        options={"SKIP_SAVE"},
    )
    as_new_take: bpy.props.BoolProperty(
        name="As New Take",
        description="Add a take for this clip, instead of giving the active take another clip",
        default=False,
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be one."""
        if not bpy.data.movieclips:
            cls.poll_message_set("This file has no clip; load the footage")
            return False
        return all_met(cls, context, idle)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Put it behind the take's camera."""
        scene, clips = context.scene, bpy.data.movieclips
        clip = clips.get(self.clip) if self.clip else scene.active_clip or clips[0]
        if clip is None:
            say(
                self,
                "ERROR",
                "This file has no clip '{name}'; it has {names}",
                name=self.clip,
                names=", ".join(each.name for each in clips),
            )
            return {"CANCELLED"}
        take = None if self.as_new_take else find_take(scene)
        take = take or add_take(scene, name_for(Path(bpy.path.abspath(clip.filepath, library=clip.library))))
        give_footage(take, clip)
        look_through_camera(context, take)
        show_range(context)
        return {"FINISHED"}


class KEYMARK_MT_clips(bpy.types.Menu):
    """The clips that are in this file already."""

    bl_label = "Use Clip of This File"

    def draw(self, context: bpy.types.Context) -> None:
        """One entry a clip."""
        take = find_take(context.scene)
        for clip in bpy.data.movieclips:
            entry = self.layout.operator(
                KEYMARK_OT_use_clip.bl_idname, text=clip.name, translate=False, icon="TRACKER"
            )
            entry.clip = clip.name
            entry.as_new_take = take is not None and take.clip is not None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_use_clip, KEYMARK_MT_clips))
