"""A take's footage in its scene: which camera a clip goes behind, and what is known of its file."""

from itertools import islice
from pathlib import Path

import bpy

from ...core.errors import InputError
from ...core.footage.clips.clip_timing import is_variable_frame_rate
from ..bridge.attach_footage import attach_footage, is_guess
from ..bridge.footage import clip_path
from ..bridge.footage_camera import is_startup_camera, set_background, shows_behind, solved_camera
from ..shell.results import clear_review
from ..shell.takes import find_take, footage_of
from .camera_view import fit_beside_sidebar, look_through

PLAIN_NAME = "clip"
"""What the clip in every take's folder is called."""
LOOKED_AT = 90
"""Frames whose times tell whether the rate varies; a phone's rate varies from the start."""


def give_footage(take: bpy.types.PropertyGroup, clip: bpy.types.MovieClip) -> None:
    """Put a clip behind a take's camera; the scene's size, rate and range follow."""
    scene = take.id_data
    attached = attach_footage(scene, clip, _camera_for(take, clip), take.guessed_lens_mm)
    take.guessed_lens_mm = attached.guessed_lens_mm or _guess_of_others(take, attached.camera)
    take.camera = attached.camera
    take.clip = clip  # has its state noted, see `clip_chosen`


def clip_chosen(take: bpy.types.PropertyGroup) -> None:
    """Follow a clip that was chosen for a take, by whatever way; what was found in another one is let go."""
    clip, before = take.clip, take.clip_state.contents
    if clip is not None and not shows_behind(take.camera, clip):
        give_footage(take, clip)  # which comes back here
        return
    note_clip(take)
    if clip is not None and before and take.clip_state.contents != before:
        take.reading_key = take.review_key = ""
        take.proposals.clear()
        take.notes.clear()
        clear_review(take)


def camera_chosen(take: bpy.types.PropertyGroup) -> None:
    """Follow a camera that was chosen for a take: it shows the clip, and the scene looks through it."""
    camera, scene = take.camera, take.id_data
    if camera is None:
        return
    if take.clip is not None and camera.data.library is None and not shows_behind(camera, take.clip):
        set_background(camera.data, take.clip)
    if take == find_take(scene) and camera.name in scene.objects:
        scene.camera = camera


def note_clip(take: bpy.types.PropertyGroup) -> None:
    """Look at a take's clip once and note what panels show of it."""
    state = take.clip_state
    state.missing = is_missing(take.clip)
    state.variable_rate = False
    if take.clip is None or state.missing:
        return
    note_contents(take)
    state.rate = footage_of(take.id_data, take).rate
    if take.clip.source == "MOVIE":
        state.variable_rate = _has_variable_rate(take)


def note_contents(take: bpy.types.PropertyGroup) -> None:
    """Note what a take's clip is known by, as it is on disk now; one that is not there stays what it was."""
    try:
        from ...core.footage.reading_key import footage_digest

        take.clip_state.contents = footage_digest(footage_of(take.id_data, take).path)
    except (InputError, ModuleNotFoundError):  # what reads the clip will say so
        return


def is_missing(clip: bpy.types.MovieClip | None) -> bool:
    """Whether a clip's file is not where the clip says."""
    if clip is None:
        return False
    try:
        clip_path(clip)
    except InputError:
        return True
    return False


def name_for(path: Path) -> str:
    """What to call a take of a clip: as its file, or as its folder where the file is just called clip."""
    return path.parent.name if path.stem == PLAIN_NAME and path.parent.name else path.stem


def look_through_camera(context: bpy.types.Context, take: bpy.types.PropertyGroup) -> None:
    """Let the viewport at work show the footage: otherwise nothing of it would be seen."""
    space, camera = context.space_data, take.camera
    if not isinstance(space, bpy.types.SpaceView3D) or space.region_3d is None or camera is None:
        return
    look_through(space, take.id_data, camera)
    fit_beside_sidebar(context.area, take.id_data.render, camera.data)


def show_range(context: bpy.types.Context) -> None:
    """Let the timelines span the scene's range, which the footage has just given it."""
    if bpy.app.background:  # nobody sees one, and Blender may have none
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
    """The camera to put a clip behind; None for a new one.

    The take's own, unless another take needs it for another clip; else one that moves as the clip's solution
    says; else that of a take with the same clip; else the scene's, if it is nobody's and not just Blender's.
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


def _guess_of_others(take: bpy.types.PropertyGroup, camera: bpy.types.Object) -> float:
    """The guess that a take with the same camera has noted; 0 for none."""
    takes = take.id_data.keymark.takes
    return next((other.guessed_lens_mm for other in takes if other != take and other.camera == camera), 0.0)


def _has_variable_rate(take: bpy.types.PropertyGroup) -> bool:
    try:
        stamps = footage_of(take.id_data, take).open().source.time_stamps()
        return is_variable_frame_rate(list(islice(stamps, LOOKED_AT)))
    except (InputError, ModuleNotFoundError):  # what reads the clip will say so
        return False
