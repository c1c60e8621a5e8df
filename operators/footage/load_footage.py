"""Load a clip as the footage behind the camera."""

from pathlib import Path

import bpy

from ..shell.error_reports import reported
from ..shell.messages import say
from ..shell.requirements import all_met, idle
from ..shell.takes import add_take, find_take
from .occluding_objects import names_in_the_way
from .take_footage import give_footage, lens_is_guess, look_through_camera, name_for, show_range

VIDEOS = (".mp4", ".mov", ".avi", ".mkv", ".webm", ".m4v", ".mpg", ".mts")
IMAGES = (".png", ".jpg", ".jpeg", ".tif", ".tiff")
NAMED = 3
"""So many of the objects that hide the footage are named."""
PATTERNS = ";".join(f"*{extension}" for extension in VIDEOS + IMAGES)


class KEYMARK_OT_load_footage(bpy.types.Operator):
    """Load a clip behind the camera, and set the scene's size, frame rate and range from it"""

    bl_idname = "keymark.load_footage"
    bl_label = "Load Footage"
    bl_options = {"REGISTER", "UNDO"}

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

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Not while a job reads other footage."""
        return all_met(cls, context, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file, unless one was dropped; a dropped one never takes another's place."""
        if not self.filepath:
            context.window_manager.fileselect_add(self)
            return {"RUNNING_MODAL"}
        take = find_take(context.scene)
        self.as_new_take = take is not None and take.clip is not None
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Load it."""
        with reported(self):
            from ..bridge.footage_to_scene import load_footage

            scene = context.scene
            path = Path(bpy.path.abspath(self.filepath))
            clip = load_footage(path)
            take = None if self.as_new_take else find_take(scene)
            take = take or add_take(scene, name_for(path))
            give_footage(take, clip)
            look_through_camera(context, take)
            show_range(context)
            say(
                self,
                "INFO",
                "Loaded {name}: {count} frames of {width} x {height} pixels",
                name=clip.name,
                count=clip.frame_duration,
                width=clip.size[0],
                height=clip.size[1],
            )
            if lens_is_guess(take):
                say(
                    self,
                    "INFO",
                    "The lens is a guess: {lens:.1f} mm; set it in the Footage panel if you know it",
                    lens=take.guessed_lens_mm,
                )
            hiding = names_in_the_way(context, take)
            if hiding:
                say(
                    self,
                    "WARNING",
                    "In front of the footage: {names}; to see the performer, select what hides them and "
                    "press H (Alt H brings it back)",
                    names=", ".join(hiding[:NAMED] + (["..."] if len(hiding) > NAMED else [])),
                )
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_load_footage,))
