"""What a take follows in its footage, as far as it is switched on."""

from typing import TYPE_CHECKING

import bpy

from ..bridge.clicked_keypoints import ClickedPoint
from ..bridge.footage_camera import may_move
from ..bridge.scene_evidence import SceneEvidence
from ..markers.ignored_regions import ignored_regions
from ..markers.marker_styles import marker_styles
from .assigned_tracks import assigned_tracks
from .keypoint_paths import keypoint_path

if TYPE_CHECKING:
    from ...core.footage.marker_style import MarkerStyle


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
