"""Load a clip as the footage behind the camera."""

from pathlib import Path

import bpy

from .failures import reported
from .requirements import all_met, idle
from .takes import add_take, find_take, free_camera

VIDEOS = "*.mp4;*.mov;*.avi;*.mkv;*.webm;*.m4v;*.mpg;*.mts;*.png;*.jpg;*.jpeg;*.tif;*.tiff"


class KEYMARK_OT_load_footage(bpy.types.Operator):
    """Load a clip behind the camera, and set the scene's size, frame rate and range from it"""

    bl_idname = "keymark.load_footage"
    bl_label = "Load Footage"
    bl_options = {"REGISTER", "UNDO"}

    filepath: bpy.props.StringProperty(
        name="File Path", description="A video, or one image of a numbered sequence", subtype="FILE_PATH"
    )
    filter_glob: bpy.props.StringProperty(default=VIDEOS, options={"HIDDEN"})
    filter_folder: bpy.props.BoolProperty(default=True, options={"HIDDEN"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Not while a job reads other footage."""
        return all_met(cls, context, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Load it."""
        with reported(self):
            from .bridge.scene_footage import attach_footage

            scene = context.scene
            path = Path(bpy.path.abspath(self.filepath))
            take = find_take(scene)
            camera = free_camera(scene, take)
            clip, camera = attach_footage(scene, path, camera)
            take = take or add_take(scene, path.stem)
            take.clip, take.camera = clip, camera
            self.report(
                {"INFO"},
                f"Loaded {clip.name}: {clip.frame_duration} frames of {clip.size[0]} x {clip.size[1]}",
            )
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_load_footage,))
