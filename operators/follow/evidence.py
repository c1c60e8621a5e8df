"""What a take follows in its footage, as far as it is switched on."""

from typing import TYPE_CHECKING

import bpy

from ..bridge.footage_camera import may_move
from ..bridge.scene_evidence import ClickedPoint, SceneEvidence
from ..shell.takes import find_take
from .ignored_regions import ignored_regions
from .keypoint_paths import keypoint_path
from .marker_styles import marker_styles
from .tracks import assigned_tracks

if TYPE_CHECKING:
    from ...core.footage.region_tracks import MarkerStyle


def scene_evidence(take: bpy.types.PropertyGroup) -> SceneEvidence:
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
    )


def followed_markers(take: bpy.types.PropertyGroup) -> "tuple[MarkerStyle, ...]":
    """The styles of a take's markers, none where these are switched off.

    Raises:
        InputError: Two markers have one name or one segment.
    """
    return marker_styles(take) if take.follow.use_markers else ()


def clicked_points(take: bpy.types.PropertyGroup) -> tuple[ClickedPoint, ...]:
    """The points that were clicked on."""
    return tuple(ClickedPoint(click.point, click.frame, tuple(click.pixel)) for click in take.follow.clicks)


def has_keypoints(take: bpy.types.PropertyGroup) -> bool:
    """Whether a take follows any keypoints: files, motion tracks or clicked points."""
    follow = take.follow
    loaded = follow.use_keypoints and (any(entry.is_used for entry in follow.files) or len(follow.clicks))
    return bool(loaded or (follow.use_tracks and assigned_tracks(take)))


def has_contours(take: bpy.types.PropertyGroup) -> bool:
    """Whether a take's contours can be followed: they are switched on, and the camera stands still."""
    return bool(take.follow.use_contours and take.camera is not None and not may_move(take.camera))


# --- Requirements of operators that follow the footage


def anything_to_follow(context: bpy.types.Context) -> str | None:
    """The take follows markers, keypoints, tracks or contours."""
    take = find_take(context.scene)
    if take is None or _has_points(take) or has_contours(take):
        return None  # a take without footage says so itself
    if take.follow.use_contours and take.camera is not None:
        return "Load keypoints, assign tracks or add markers first: contours need a camera that stands still"
    return "Switch on the contours, load keypoints, assign tracks or add markers first (What to Follow)"


def keypoint_files(context: bpy.types.Context) -> str | None:
    """The take has a file of keypoints."""
    take = find_take(context.scene)
    return None if take and len(take.follow.files) else "Load keypoints first"


def points_to_follow(context: bpy.types.Context) -> str | None:
    """The take follows markers, keypoints or tracks; contours alone are not enough."""
    take = find_take(context.scene)
    if take is None or _has_points(take):
        return None
    return "Load keypoints, assign tracks or add markers first; this needs more than contours"


def _has_points(take: bpy.types.PropertyGroup) -> bool:
    return bool((take.follow.use_markers and len(take.markers)) or has_keypoints(take))
