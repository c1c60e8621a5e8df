"""Load a clip as a take's footage, behind its camera."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.file_browser import browse, chosen_file
from ..shell.requirements import idle
from ..shell.takes import add_take, find_take
from .startup_cube import hide_startup_cube
from .take_footage import (
    IMAGES,
    VIDEOS,
    give_footage,
    lens_is_guess,
    look_through_camera,
    show_range,
    take_name,
)

PATTERNS = ";".join(f"*{extension}" for extension in VIDEOS + IMAGES)


class KEYMARK_OT_load_footage(BaseOperator, bpy.types.Operator):
    """Load a clip behind the camera, and set the scene's size, frame rate and range from it"""

    bl_idname = "keymark.load_footage"
    bl_label = "Load Footage"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (idle,)

    filepath: bpy.props.StringProperty(
        name="File Path",
        description="A video, or one image of a numbered sequence",
        subtype="FILE_PATH",
        options={"SKIP_SAVE"},
    )
    as_new_take: bpy.props.BoolProperty(
        name="As New Take",
        description="Add a take for this clip, instead of giving the active take another clip",
        default=False,
        options={"SKIP_SAVE"},
    )
    filter_glob: bpy.props.StringProperty(default=PATTERNS, options={"HIDDEN"})
    filter_folder: bpy.props.BoolProperty(default=True, options={"HIDDEN"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the file browser, unless a file was dropped; a dropped one never replaces a clip."""
        if not self.filepath:
            return browse(self, context)
        take = find_take(context.scene)
        self.as_new_take = take is not None and take.clip is not None
        return self.execute(context)

    def run(self, context: bpy.types.Context) -> None:
        """Load the clip and put it behind the camera."""
        from ..bridge.footage_to_scene import load_footage

        scene = context.scene
        path = chosen_file(self, "a video, or one image of a numbered sequence")
        clip = load_footage(path)
        take = None if self.as_new_take else find_take(scene)
        take = take or add_take(scene, take_name(path))
        give_footage(take, clip)
        hide_startup_cube(context)
        look_through_camera(context, take)
        show_range(context)
        self._report_footage(context, take)

    def _report_footage(self, context: bpy.types.Context, take: bpy.types.PropertyGroup) -> None:
        clip = take.clip
        self.report(
            {"INFO"},
            f"Loaded {clip.name}: {clip.frame_duration} frames of {clip.size[0]} x {clip.size[1]} pixels",
        )
        if lens_is_guess(take):
            self.report(
                {"INFO"},
                f"The lens is a guess: {take.guessed_lens_mm:.1f} mm; set it in the Footage panel if "
                "you know it",
            )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_load_footage,))
