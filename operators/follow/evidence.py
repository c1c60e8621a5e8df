"""What a take follows in its footage, as far as it is switched on."""

from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING

import bpy
from bpy.types import PropertyGroup

from ..bridge.scene_evidence import ClickedPoint, SceneEvidence, file_state
from ..shell.takes import assigned_tracks, footage_of
from .marker_properties import ignored_regions
from .marker_styles import marker_styles

if TYPE_CHECKING:
    from ...core.markers.region_tracks import MarkerStyle


def scene_evidence(take: PropertyGroup) -> SceneEvidence:
    """What a take follows.

    Raises:
        InputError: Two markers have one name or one segment.
    """
    follow = take.follow
    files = [entry for entry in follow.files if entry.is_used and follow.use_keypoints]
    return SceneEvidence(
        markers=followed_markers(take),
        files=tuple(keypoint_path(entry) for entry in files),
        tracks=assigned_tracks(take) if follow.use_tracks else (),
        clicks=clicked_points(take) if follow.use_keypoints else (),
        depth_hints=bool(follow.use_depth_hints),
        contours=bool(follow.use_contours),
        ignored_regions=ignored_regions(take) if follow.use_markers else (),
        reference=Path(bpy.path.abspath(follow.reference)) if follow.reference else None,
    )


def followed_markers(take: PropertyGroup) -> "tuple[MarkerStyle, ...]":
    """The styles of a take's markers, none where these are switched off."""
    return marker_styles(take) if take.follow.use_markers else ()


def clicked_points(take: PropertyGroup) -> tuple[ClickedPoint, ...]:
    """The points that were clicked on."""
    return tuple(ClickedPoint(click.point, click.frame, tuple(click.pixel)) for click in take.follow.clicks)


def clip_frame(take: PropertyGroup) -> int:
    """The scene's current frame, counted from the clip's first."""
    scene = take.id_data
    return int(scene.frame_current - footage_of(scene, take).first_frame)


def clicked_here(take: PropertyGroup) -> list[str]:
    """The points that were clicked on in the current frame."""
    return [click.point for click in take.follow.clicks if click.frame == clip_frame(take)]


# --- Keypoint files on disk


LOOKED_S = 2.0  # Time for which a file's state counts as it was: drawing reads no folder each time

_states: dict[Path, tuple[float, str | None]] = {}
"""Time at which a path was looked at [s], and the state it had."""


def recent_state(path: Path) -> str | None:
    """A file's state as of a moment ago (see `file_state`); None where it is missing."""
    now = monotonic()
    looked, state = _states.get(path, (-LOOKED_S, None))
    if now - looked >= LOOKED_S:
        state = file_state(path)
        _states[path] = now, state
    return state


def forget_states() -> None:
    """Look at every file anew."""
    _states.clear()


def keypoint_path(entry: PropertyGroup) -> Path:
    """The path of a file of keypoints, which may be missing.

    Blender keeps relative paths of its own in step when a .blend is saved elsewhere, those of extensions not:
    so the one from the root is used where nothing, or another file, lies at the relative one.
    """
    relative, absolute = Path(bpy.path.abspath(entry.filepath)), Path(entry.absolute_path)
    if not entry.absolute_path or relative == absolute:
        return relative
    state = recent_state(relative)
    if state is None or (state != entry.contents and recent_state(absolute) == entry.contents):
        return absolute if recent_state(absolute) is not None else relative
    return relative


def add_keypoint_file(take: PropertyGroup, path: Path, replace: bool = False) -> None:
    """Add a file of keypoints to a take, switched on and chosen; one that it has is not added twice.

    With `replace` it takes the place of the chosen one.
    """
    from ...core.files.paths import real_path
    from ..bridge.footage_to_scene import stored_path

    follow = take.follow
    known = [keypoint_path(entry) for entry in follow.files]
    if path in known:
        follow.active_file = known.index(path)
    elif not (replace and follow.active_file < len(known)):
        follow.files.add()
        follow.active_file = len(known)
    entry = follow.files[follow.active_file]
    entry.is_used = True
    entry.filepath, entry.absolute_path = stored_path(path), str(real_path(path))
    entry.contents = file_state(path) or ""
