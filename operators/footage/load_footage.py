"""A take's footage: loaded, found again or used from this file, and its guessed camera confirmed."""

from pathlib import Path

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator, browse, chosen_file, warn
from ..shell.fields import HIDDEN, SKIP_SAVE, Switch, Text
from ..shell.notices import give_notices
from ..shell.requirements import footage, idle, of_take
from ..shell.takes import active_take, add_take, find_take
from .properties import confirm_placement
from .take_footage import (
    IMAGES,
    VIDEOS,
    give_footage,
    lens_is_guess,
    look_through_camera,
    show_range,
    take_name,
    update_clip_state,
)


def any_clip(_context: bpy.types.Context, _state: object) -> str | None:
    """The file has a clip."""
    return None if bpy.data.movieclips else "This file has no clip; load the footage"


class KEYMARK_OT_use_clip(BaseOperator, bpy.types.Operator):
    """Use a clip that is in this file already, with the lens and the camera solution of its tracking"""

    bl_label = "Use Clip"
    requirements = (any_clip, idle)

    clip: Text("Clip", "Name of the clip in this file; without one, the scene's own", options=SKIP_SAVE)
    as_new_take: Switch(
        "As New Take",
        "Add a take for this clip, instead of giving the active take another clip",
        options=SKIP_SAVE,
    )

    def run(self, context: bpy.types.Context) -> set[str] | None:
        scene, clips = context.scene, bpy.data.movieclips
        clip = clips.get(self.clip) if self.clip else scene.active_clip or clips[0]
        if clip is None:
            names = ", ".join(each.name for each in clips)
            self.report({"ERROR"}, f"This file has no clip '{self.clip}'; it has {names}")
            return {"CANCELLED"}
        take = None if self.as_new_take else find_take(scene)
        take = take or add_take(scene, take_name(Path(bpy.path.abspath(clip.filepath, library=clip.library))))
        give_footage(take, clip)
        look_through_camera(context, take)
        show_range(context)
        return None


guessed_lens = of_take(lambda state: state.take.guessed_lens_mm > 0.0, "The lens is not a guess")


class KEYMARK_OT_keep_lens(BaseOperator, bpy.types.Operator):
    """Confirm that the camera's focal length is right, so that it no longer counts as a guess"""

    bl_label = "Confirm Lens"
    requirements = (guessed_lens,)

    def run(self, context: bpy.types.Context) -> None:
        camera = active_take(context.scene).camera
        for take in context.scene.keymark.takes:
            if take.camera == camera:
                take.guessed_lens_mm = 0.0


guessed_placement = of_take(lambda state: state.placement_is_guess, "The camera's place is not a guess")


class KEYMARK_OT_keep_camera(BaseOperator, bpy.types.Operator):
    """Confirm the height and the tilt of the camera, so that they no longer count as a guess"""

    bl_label = "Confirm Camera"
    requirements = (guessed_placement,)

    def run(self, context: bpy.types.Context) -> None:
        confirm_placement(active_take(context.scene))


def hide_startup_cube(context: bpy.types.Context) -> None:
    """Hide the cube of Blender's startup file where nobody has touched it; Alt H brings it back."""
    cube = context.view_layer.objects.get("Cube")
    if cube is None or cube.type != "MESH" or len(cube.data.vertices) != 8:
        return
    changed = len(cube.modifiers) or cube.animation_data is not None or cube.location.length >= 1e-4
    if not changed and all(abs(length - 2.0) < 1e-4 for length in cube.dimensions):
        cube.hide_set(True)


def load_into_take(context: bpy.types.Context, path: Path, as_new_take: bool) -> bpy.types.PropertyGroup:
    """Load a clip behind the camera of a take, a new one or the active one, and show it."""
    from ..bridge.footage_to_scene import load_footage

    scene = context.scene
    clip = load_footage(path)
    take = None if as_new_take else find_take(scene)
    take = take or add_take(scene, take_name(path))
    give_footage(take, clip)
    hide_startup_cube(context)
    look_through_camera(context, take)
    show_range(context)
    return take


PATTERNS = ";".join(f"*{extension}" for extension in VIDEOS + IMAGES)


class KEYMARK_OT_load_footage(BaseOperator, bpy.types.Operator):
    """Load a clip behind the camera, and set the scene's size, frame rate and range from it"""

    bl_label = "Load Footage"
    requirements = (idle,)

    filepath: Text(
        "File Path", "A video, or one image of a numbered sequence", subtype="FILE_PATH", options=SKIP_SAVE
    )
    as_new_take: Switch(
        "As New Take",
        "Add a take for this clip, instead of giving the active take another clip",
        options=SKIP_SAVE,
    )
    filter_glob: Text(default=PATTERNS, options=HIDDEN)
    filter_folder: Switch(default=True, options=HIDDEN)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the file browser, unless a file was dropped; a dropped one never replaces a clip."""
        if not self.filepath:
            return browse(self, context)
        take = find_take(context.scene)
        self.as_new_take = take is not None and take.clip is not None
        return self.execute(context)

    def run(self, context: bpy.types.Context) -> None:
        path = chosen_file(self, "a video, or one image of a numbered sequence")
        take = load_into_take(context, path, self.as_new_take)
        clip, extent = (
            take.clip,
            f"{take.clip.frame_duration} frames of {take.clip.size[0]} x {take.clip.size[1]}",
        )
        self.report({"INFO"}, f"Loaded {clip.name}: {extent} pixels")
        if lens_is_guess(take):
            guess = f"The lens is a guess: {take.guessed_lens_mm:.1f} mm"
            self.report({"INFO"}, f"{guess}; set it in the step Clip if you know it")


class KEYMARK_OT_relocate_clip(BaseOperator, bpy.types.Operator):
    """Choose where the take's clip is now; markers, keyframes, motion and camera stay as they are"""

    bl_label = "Find Clip"
    requirements = (footage, idle)

    filepath: Text(
        "File Path",
        "Where the clip is now: the video, or one image of the sequence",
        subtype="FILE_PATH",
        options=SKIP_SAVE,
    )
    filter_glob: Text(default=PATTERNS, options=HIDDEN)
    filter_folder: Switch(default=True, options=HIDDEN)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self.filepath = bpy.path.abspath(active_take(context.scene).clip.filepath)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def run(self, context: bpy.types.Context) -> None:
        """Check the file, and only then set the clip's path."""
        from ...core.video.clip import Clip
        from ..bridge.footage_to_scene import clip_file, stored_path

        take = active_take(context.scene)
        clip, path = take.clip, chosen_file(self, "the video, or one image of the sequence")
        if clip.library is not None:
            raise InputError(
                f"clip '{clip.name}' is linked from {clip.library.filepath}; find it in that file, or "
                "load it here"
            )
        size, count = (clip.size[0], clip.size[1]), clip.frame_duration
        found = Clip.open(path, size=size)
        clip.filepath = stored_path(clip_file(path))
        context.view_layer.update()  # makes Blender read the clip again
        for scene in bpy.data.scenes:
            for other in scene.keymark.takes:
                if other.clip == clip and scene.library is None:
                    update_clip_state(other)
        give_notices(take, "footage", "clip")
        if not all(size) or (found.size == size and clip.frame_duration == count):
            self.report({"INFO"}, f"Found {clip.name}")
            return
        sentence = (
            f"{path.name} has {clip.frame_duration} frames of {found.size[0]} x {found.size[1]} pixels, "
            f"the clip had {count} of {size[0]} x {size[1]}; check that it is the right one"
        )
        give_notices(take, "footage", "clip", (warn(self, sentence),))
