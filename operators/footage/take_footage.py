"""A take's footage in its scene: the camera it is put behind, and the state of its file."""

from contextlib import suppress
from itertools import islice
from pathlib import Path

import bpy

from ...core.errors import InputError
from ...core.markers.region_tracks import is_variable_frame_rate
from ..bridge.footage import attach_footage, clip_path, is_guess
from ..bridge.footage_camera import is_startup_camera, set_background, shows_behind, solved_camera
from ..shell.results import clear_review
from ..shell.takes import NO_GUESS, as_numbers, find_take, footage_of
from .camera_view import fit_beside_sidebar, look_through

GENERIC_STEM = "clip"  # File name, without its extension, of the clip in every saved take's folder
VIDEOS = (".mp4", ".mov", ".avi", ".mkv", ".webm", ".m4v", ".mpg", ".mts")
IMAGES = (".png", ".jpg", ".jpeg", ".tif", ".tiff")  # Extensions of the files that footage is loaded from


def give_footage(take: bpy.types.PropertyGroup, clip: bpy.types.MovieClip) -> None:
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


def clip_chosen(take: bpy.types.PropertyGroup) -> None:
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


def camera_chosen(take: bpy.types.PropertyGroup) -> None:
    """Update a take whose camera was set: the camera shows the clip and becomes the scene's."""
    camera, scene = take.camera, take.id_data
    if camera is None:
        return
    if take.clip is not None and camera.data.library is None and not shows_behind(camera, take.clip):
        set_background(camera.data, take.clip)
    if take == find_take(scene) and camera.name in scene.objects:
        scene.camera = camera


def update_clip_state(take: bpy.types.PropertyGroup) -> None:
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


def update_clip_digest(take: bpy.types.PropertyGroup) -> None:
    """Store the digest of a take's clip as it is on disk now; if it is missing, the stored one stays."""
    with suppress(InputError, ModuleNotFoundError):  # reported when the clip is read
        from ...core.markers.reading import footage_digest

        take.clip_state.contents = footage_digest(footage_of(take.id_data, take).path)


def is_missing(clip: bpy.types.MovieClip | None) -> bool:
    """Whether a clip's file is missing."""
    if clip is None:
        return False
    try:
        clip_path(clip)
    except InputError:
        return True
    return False


def take_name(path: Path) -> str:
    """Return the name for a take of a clip: the file's, or the folder's if the file is just called clip."""
    return path.parent.name if path.stem == GENERIC_STEM and path.parent.name else path.stem


def look_through_camera(context: bpy.types.Context, take: bpy.types.PropertyGroup) -> None:
    """Let the viewport of the context show the footage, which is visible only through the camera."""
    space, camera = context.space_data, take.camera
    if not isinstance(space, bpy.types.SpaceView3D) or space.region_3d is None or camera is None:
        return
    look_through(space, take.id_data, camera)
    fit_beside_sidebar(context.area, take.id_data.render, camera.data)


def show_range(context: bpy.types.Context) -> None:
    """Zoom the timelines to the scene's range of frames."""
    if bpy.app.background:  # there may be no screen
        return
    for area in context.screen.areas:
        region = next((each for each in area.regions if each.type == "WINDOW"), None)
        if area.ui_type == "TIMELINE" and region is not None:
            with context.temp_override(area=area, region=region):
                if bpy.ops.action.view_all.poll():
                    bpy.ops.action.view_all()


def lens_is_guess(take: bpy.types.PropertyGroup) -> bool:
    """Whether the take's camera still has the lens that was guessed."""
    return take.camera is not None and is_guess(take.camera.data, take.guessed_lens_mm)


def _camera_for(take: bpy.types.PropertyGroup, clip: bpy.types.MovieClip) -> bpy.types.Object | None:
    """Return the camera to put a clip behind; None for a new one.

    The take's own, unless another take uses it for another clip; else the one animated by the clip's camera
    solution; else that of a take with the same clip; else the scene's, unless a take uses it or it is the one
    of Blender's startup file.
    """
    scene = take.id_data
    others = [other for other in scene.keymark.takes if other != take]
    candidates = [
        *([take.camera] if take.camera not in {each.camera for each in others if each.clip != clip} else []),
        solved_camera(scene, clip),
        *(other.camera for other in others if other.clip == clip),
        *([scene.camera] if scene.camera not in {each.camera for each in others} else []),
    ]
    for camera in candidates:
        if camera is None or camera.type != "CAMERA" or camera.name not in scene.objects:
            continue
        if camera == take.camera or not is_startup_camera(camera):
            return camera
    return None
