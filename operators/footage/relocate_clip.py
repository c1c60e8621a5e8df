"""Relocate a clip whose file was moved."""

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.file_browser import chosen_file
from ..shell.messages import warn
from ..shell.notices import give_notices
from ..shell.requirements import footage, idle
from ..shell.takes import active_take
from .load_footage import PATTERNS
from .take_footage import update_clip_state


class KEYMARK_OT_relocate_clip(BaseOperator, bpy.types.Operator):
    """Choose where the take's clip is now; markers, keyframes, motion and camera stay as they are"""

    bl_idname = "keymark.relocate_clip"
    bl_label = "Find Clip"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, idle)

    filepath: bpy.props.StringProperty(
        name="File Path",
        description="Where the clip is now: the video, or one image of the sequence",
        subtype="FILE_PATH",
        options={"SKIP_SAVE"},
    )
    filter_glob: bpy.props.StringProperty(default=PATTERNS, options={"HIDDEN"})
    filter_folder: bpy.props.BoolProperty(default=True, options={"HIDDEN"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the file browser, beginning at the clip's old path."""
        self.filepath = bpy.path.abspath(active_take(context.scene).clip.filepath)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def run(self, context: bpy.types.Context) -> None:
        """Check the file, and only then set the clip's path."""
        from ...core.footage.clips.clip import Clip
        from ..bridge.footage_to_scene import clip_file, stored_path

        take = active_take(context.scene)
        clip, path = take.clip, chosen_file(self, "the video, or one image of the sequence")
        if clip.library is not None:
            raise InputError(
                f"clip '{clip.name}' is linked from {clip.library.filepath}; find it in that file, or "
                "load it here"
            )
        found = Clip.open(path)
        size, count = (clip.size[0], clip.size[1]), clip.frame_duration
        clip.filepath = stored_path(clip_file(path))
        context.view_layer.update()  # makes Blender read the clip again
        for scene in bpy.data.scenes:
            for other in scene.keymark.takes:
                if other.clip == clip and scene.library is None:
                    update_clip_state(other)
        differs = all(size) and (found.size != size or clip.frame_duration != count)
        if not differs:
            give_notices(take, "footage", "clip")
            self.report({"INFO"}, f"Found {clip.name}")
            return
        sentence = (
            f"{path.name} has {clip.frame_duration} frames of {found.size[0]} x {found.size[1]} pixels, "
            f"the clip had {count} of {size[0]} x {size[1]}; check that it is the right one"
        )
        give_notices(take, "footage", "clip", (warn(self, sentence),))


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_relocate_clip,))
