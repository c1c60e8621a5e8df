"""Open a take from disk: footage, camera, actor, what is followed, and keyframes."""

import bpy

from ..footage.take_footage import VIDEOS
from ..shell.base_operator import BaseOperator
from ..shell.file_browser import browse, chosen_path
from ..shell.requirements import idle, object_mode_possible


class KEYMARK_OT_open_take(BaseOperator, bpy.types.Operator):
    """Open a take: its footage behind its camera, its actor, what is followed, and its keyframes"""

    bl_idname = "keymark.open_take"
    bl_label = "Open Take"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (object_mode_possible, idle)

    filepath: bpy.props.StringProperty(
        name="File Path",
        description="The take's folder, or the take.json in it; in a shoot, also the clip alone",
        subtype="FILE_PATH",
        options={"SKIP_SAVE"},
    )
    keyframes: bpy.props.StringProperty(
        name="Keyframes",
        description="Name of the keyframe file in the take's folder",
        default="keyframes.json",
    )
    filter_glob: bpy.props.StringProperty(
        default=";".join(("*take.json", *(f"*{ending}" for ending in VIDEOS))), options={"HIDDEN"}
    )
    filter_folder: bpy.props.BoolProperty(default=True, options={"HIDDEN"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the file browser, unless a file was dropped."""
        if self.filepath:
            return self.execute(context)
        return browse(self, context)

    def run(self, context: bpy.types.Context) -> None:
        """Read the take, and only then change the scene."""
        from ...core.shoot.discovery import take_path
        from .take_to_scene import open_in_scene, read_for_scene

        open_in_scene(self, context, read_for_scene(take_path(chosen_path(self)), self.keyframes))


def _draw_import(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    menu.layout.operator(KEYMARK_OT_open_take.bl_idname, text="Keymark Take (take.json)")


def register() -> None:
    """Add the operator, and an entry to File > Import."""
    bpy.utils.register_class(KEYMARK_OT_open_take)
    bpy.types.TOPBAR_MT_file_import.append(_draw_import)


def unregister() -> None:
    """Remove both."""
    bpy.types.TOPBAR_MT_file_import.remove(_draw_import)
    bpy.utils.unregister_class(KEYMARK_OT_open_take)
