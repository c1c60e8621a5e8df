"""A take's footage in its scene: the camera it is put behind, and the state of its file."""

from contextlib import suppress
from itertools import islice
from pathlib import Path

import bpy
from bpy.types import Context, Event, MovieClip, Object, Operator, PropertyGroup

from ...core.errors import InputError
from ...core.files.paths import VIDEOS
from ...core.markers.region_tracks import is_variable_frame_rate
from ..bridge.footage import attach_footage, is_guess, is_missing
from ..bridge.footage_camera import is_startup_camera, set_background, shows_behind, solved_camera
from ..shell import need
from ..shell.base_operator import BaseOperator, browse, chosen_file, operator, warn
from ..shell.fields import HIDDEN, SKIP_SAVE, File, Switch, Text
from ..shell.notes import give_notices
from ..shell.results import clear_review
from ..shell.takes import NO_GUESS, active_take, add_take, as_numbers, find_take, footage_of
from .camera_view import fit_beside_sidebar, look_through
from .properties import confirm_placement

GENERIC_STEM = "clip"  # File name, without its extension, of the clip in every saved take's folder
IMAGES = (".png", ".jpg", ".jpeg", ".tif", ".tiff")  # Extensions of the files that footage is loaded from


def give_footage(take: PropertyGroup, clip: MovieClip) -> None:
    """Put a clip behind a take's camera; the scene's size, rate and range follow."""
    scene = take.id_data
    attached = attach_footage(scene, clip, _camera_for(take, clip), take.guessed_lens_mm)
    shared = [other for other in scene.keymark.takes if other != take and other.camera == attached.camera]
    take.guessed_lens_mm = attached.guessed_lens_mm or (shared[0].guessed_lens_mm if shared else 0.0)
    if attached.camera != take.camera:
        take.guessed_placement = tuple(shared[0].guessed_placement) if shared else NO_GUESS
    if attached.guessed_placement is not None:
        take.guessed_placement = as_numbers(attached.guessed_placement)
    take.camera = attached.camera
    take.clip = clip  # its update notes the state, see `clip_chosen`


def clip_chosen(take: PropertyGroup) -> None:
    """Update a take whose clip was set; results, keypoints and lines from another clip are dropped."""
    clip, before = take.clip, take.clip_state.contents
    if clip is not None and not shows_behind(take.camera, clip):
        give_footage(take, clip)  # sets the clip, and so calls this again
        return
    update_clip_state(take)
    if clip is not None and before and take.clip_state.contents != before:
        take.reading_key = take.review_key = ""
        take.proposals.clear()
        take.notes.clear()
        take.notices.clear()
        clear_review(take)
        take.camera_findings = ""
        for drawn in (take.camera_lines, take.follow.files, take.follow.tracks, take.follow.clicks):
            drawn.clear()


def camera_chosen(take: PropertyGroup) -> None:
    """Update a take whose camera was set: the camera shows the clip and becomes the scene's."""
    camera, scene = take.camera, take.id_data
    if camera is None:
        return
    if take.clip is not None and camera.data.library is None and not shows_behind(camera, take.clip):
        set_background(camera.data, take.clip)
    if take == find_take(scene) and camera.name in scene.objects:
        scene.camera = camera


def update_clip_state(take: PropertyGroup) -> None:
    """Check a take's clip, and store the state that panels show."""
    state = take.clip_state
    state.missing = is_missing(take.clip)
    state.variable_rate = False
    if take.clip is None or state.missing:
        return
    update_clip_digest(take)
    state.rate = footage_of(take.id_data, take).rate
    if take.clip.source == "MOVIE":
        with suppress(InputError, ModuleNotFoundError):  # reported when the clip is read
            stamps = footage_of(take.id_data, take).open().source.time_stamps()
            # A phone's rate varies from the start.
            state.variable_rate = is_variable_frame_rate(list(islice(stamps, 90)))


def update_clip_digest(take: PropertyGroup) -> None:
    """Store the digest of a take's clip as it is on disk now; if it is missing, the stored one stays."""
    with suppress(InputError, ModuleNotFoundError):  # reported when the clip is read
        from ...core.markers.reading import footage_digest

        take.clip_state.contents = footage_digest(footage_of(take.id_data, take).path)


def take_name(path: Path) -> str:
    """Return the name for a take of a clip: the file's, or the folder's if the file is just called clip."""
    return path.parent.name if path.stem == GENERIC_STEM and path.parent.name else path.stem


def look_through_camera(context: Context, take: PropertyGroup) -> None:
    """Let the viewport of the context show the footage, which is visible only through the camera."""
    space, camera = context.space_data, take.camera
    if not isinstance(space, bpy.types.SpaceView3D) or space.region_3d is None or camera is None:
        return
    look_through(space, take.id_data, camera)
    fit_beside_sidebar(context.area, take.id_data.render, camera.data)


def show_range(context: Context) -> None:
    """Zoom the timelines to the scene's range of frames."""
    if bpy.app.background:  # there may be no screen
        return
    for area in context.screen.areas:
        region = next((each for each in area.regions if each.type == "WINDOW"), None)
        if area.ui_type == "TIMELINE" and region is not None:
            with context.temp_override(area=area, region=region):
                if bpy.ops.action.view_all.poll():
                    bpy.ops.action.view_all()


def lens_is_guess(take: PropertyGroup) -> bool:
    """Whether the take's camera still has the lens that was guessed."""
    return take.camera is not None and is_guess(take.camera.data, take.guessed_lens_mm)


def _camera_for(take: PropertyGroup, clip: MovieClip) -> Object | None:
    """The camera to put a clip behind, one of Blender's startup file aside; None for a new one."""
    scene = take.id_data
    rest = [other for other in scene.keymark.takes if other != take]
    candidates = [
        *([take.camera] if take.camera not in {each.camera for each in rest if each.clip != clip} else []),
        solved_camera(scene, clip),
        *(other.camera for other in rest if other.clip == clip),
        *([scene.camera] if scene.camera not in {each.camera for each in rest} else []),
    ]
    for camera in candidates:
        if camera is None or camera.type != "CAMERA" or camera.name not in scene.objects:
            continue
        if camera == take.camera or not is_startup_camera(camera):
            return camera
    return None


any_clip = need.of_context(lambda _: bpy.data.movieclips, "This file has no clip; load the footage")


class KEYMARK_OT_use_clip(BaseOperator, bpy.types.Operator):
    """Use a clip that is in this file already, with the lens and the camera solution of its tracking"""

    bl_label = "Use Clip"
    requirements = (any_clip, need.idle)

    clip: Text("Clip", "Name of the clip in this file; without one, the scene's own", options=SKIP_SAVE)
    as_new_take: Switch(
        "As New Take",
        "Add a take for this clip, instead of giving the active take another clip",
        options=SKIP_SAVE,
    )

    def run(self, context: Context) -> set[str] | None:
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


guessed_lens = need.of_take(lambda state: state.take.guessed_lens_mm > 0.0, "The lens is not a guess")


@operator("Confirm Lens", guessed_lens)
def keep_lens(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Confirm that the camera's focal length is right, so that it no longer counts as a guess"""
    camera = active_take(context.scene).camera
    for take in context.scene.keymark.takes:
        if take.camera == camera:
            take.guessed_lens_mm = 0.0


guessed_placement = need.of_take(lambda state: state.placement_is_guess, "The camera's place is not a guess")


@operator("Confirm Camera", guessed_placement)
def keep_camera(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Confirm the height and the tilt of the camera, so that they no longer count as a guess"""
    confirm_placement(active_take(context.scene))


def hide_startup_cube(context: Context) -> None:
    """Hide the cube of Blender's startup file where nobody has touched it; Alt H brings it back."""
    cube = context.view_layer.objects.get("Cube")
    if cube is None or cube.type != "MESH" or len(cube.data.vertices) != 8:
        return
    changed = len(cube.modifiers) or cube.animation_data is not None or cube.location.length >= 1e-4
    if not changed and all(abs(length - 2.0) < 1e-4 for length in cube.dimensions):
        cube.hide_set(True)


def load_into_take(context: Context, path: Path, as_new_take: bool) -> PropertyGroup:
    """Load a clip behind the camera of a take, a new one or the active one, and show it."""
    from ..bridge.result_files import load_footage

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
    requirements = (need.idle,)

    filepath: File("A video, or one image of a numbered sequence")
    as_new_take: Switch(
        "As New Take",
        "Add a take for this clip, instead of giving the active take another clip",
        options=SKIP_SAVE,
    )
    filter_glob: Text(default=PATTERNS, options=HIDDEN)
    filter_folder: Switch(default=True, options=HIDDEN)

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Show the file browser, unless a file was dropped; a dropped one never replaces a clip."""
        if not self.filepath:
            return browse(self, context)
        take = find_take(context.scene)
        self.as_new_take = take is not None and take.clip is not None
        return self.execute(context)

    def run(self, context: Context) -> None:
        path = chosen_file(self, "a video, or one image of a numbered sequence")
        take = load_into_take(context, path, self.as_new_take)
        clip = take.clip
        extent = f"{clip.frame_duration} frames of {clip.size[0]} x {clip.size[1]}"
        self.report({"INFO"}, f"Loaded {clip.name}: {extent} pixels")
        if lens_is_guess(take):
            guess = f"The lens is a guess: {take.guessed_lens_mm:.1f} mm"
            self.report({"INFO"}, f"{guess}; set it in the step Clip if you know it")


class KEYMARK_OT_relocate_clip(BaseOperator, bpy.types.Operator):
    """Choose where the take's clip is now; markers, keyframes, motion and camera stay as they are"""

    bl_label = "Find Clip"
    requirements = (need.footage, need.idle)

    filepath: File("Where the clip is now: the video, or one image of the sequence")
    filter_glob: Text(default=PATTERNS, options=HIDDEN)
    filter_folder: Switch(default=True, options=HIDDEN)

    def invoke(self, context: Context, event: Event) -> set[str]:
        self.filepath = bpy.path.abspath(active_take(context.scene).clip.filepath)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def run(self, context: Context) -> None:
        """Check the file, and only then set the clip's path."""
        from ...core.video.clip import Clip
        from ..bridge.result_files import clip_file, stored_path

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
