"""Open a take from disk: footage, camera, actor, markers and keyframes."""

from pathlib import Path

import bpy

from ..footage.load_footage import VIDEOS
from ..footage.take_footage import look_through_camera, show_range
from ..shell.error_reports import reported
from ..shell.messages import say
from ..shell.requirements import all_met, idle, object_mode_possible
from ..shell.takes import active_take


class KEYMARK_OT_open_take(bpy.types.Operator):
    """Open a take: its footage behind its camera, its actor, its markers, and the keyframes posed for it"""

    bl_idname = "keymark.open_take"
    bl_label = "Open Take"
    bl_options = {"REGISTER", "UNDO"}

    filepath: bpy.props.StringProperty(
        name="File Path",
        description="The take's folder, or the take.json in it; of a shoot also a mere clip",
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

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Blender adds objects in Object Mode."""
        return all_met(cls, context, object_mode_possible, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file, unless one was dropped."""
        if self.filepath:
            return self.execute(context)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Read the take, and only then change the scene."""
        with reported(self):
            from ...core.shoot.discovery.take_path import take_path
            from .take_to_scene import read_for_scene, show_take

            opened = read_for_scene(take_path(Path(bpy.path.abspath(self.filepath))), self.keyframes)
            show_take(context, opened)
            look_through_camera(context, active_take(context.scene))
            show_range(context)
            for note in opened.notes:
                self.report({"WARNING"}, note)
            count = len(opened.take.keyframes)
            say(self, "INFO", "Opened {name} with {count} keyframes", name=opened.take.name, count=count)
            return {"FINISHED"}
        return {"CANCELLED"}


def _draw_import(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    menu.layout.operator(KEYMARK_OT_open_take.bl_idname, text="Keymark Take (take.json)")


def register() -> None:
    """Add the operator, and an entry to File > Import."""
    bpy.utils.register_class(KEYMARK_OT_open_take)
    bpy.types.TOPBAR_MT_file_import.append(_draw_import)


def unregister() -> None:
    """Take both away."""
    bpy.types.TOPBAR_MT_file_import.remove(_draw_import)
    bpy.utils.unregister_class(KEYMARK_OT_open_take)
