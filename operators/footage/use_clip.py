"""Use a clip that is in the .blend file already."""

from pathlib import Path

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.requirements import idle
from ..shell.takes import add_take, find_take
from .take_footage import give_footage, look_through_camera, show_range, take_name


def any_clip(_context: bpy.types.Context) -> str | None:
    """The file has a clip."""
    return None if bpy.data.movieclips else "This file has no clip; load the footage"


class KEYMARK_OT_use_clip(BaseOperator, bpy.types.Operator):
    """Use a clip that is in this file already, with the lens and the camera solution of its tracking"""

    bl_idname = "keymark.use_clip"
    bl_label = "Use Clip"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (any_clip, idle)

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

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Put the clip behind the take's camera."""
        scene, clips = context.scene, bpy.data.movieclips
        clip = clips.get(self.clip) if self.clip else scene.active_clip or clips[0]
        if clip is None:
            self.report(
                {"ERROR"},
                f"This file has no clip '{self.clip}'; it has {', '.join(each.name for each in clips)}",
            )
            return {"CANCELLED"}
        take = None if self.as_new_take else find_take(scene)
        take = take or add_take(scene, take_name(Path(bpy.path.abspath(clip.filepath, library=clip.library))))
        give_footage(take, clip)
        look_through_camera(context, take)
        show_range(context)
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_use_clip,))
