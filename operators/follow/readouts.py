"""What keypoints, tracks and contours see in the current frame, as labels of the panels."""

import bpy
import numpy as np

from ..bridge.footage_camera import may_move
from ..bridge.scene_evidence import tracks_at
from ..shell.takes import footage_of
from .click_points import clicked_here
from .frame_keypoints import FrameKeypoints, keypoints_at
from .tracks import assigned_tracks


def seen_label(frame: FrameKeypoints) -> str:
    """What a source sees in a frame, of the person of whom it sees most: `27 of 33 points, score 0.91`."""
    seen = np.isfinite(frame.pixel).all(axis=-1)
    if not seen.any():
        return "Nobody in this frame"
    row = int(seen.sum(axis=-1).argmax())
    return (
        f"{int(seen[row].sum())} of {len(frame.names)} points, score "
        f"{float(frame.score[row][seen[row]].mean()):.2f}"
    )


def keypoints_label(take: bpy.types.PropertyGroup) -> str:
    """How many points all files and clicks see in the current frame, as in `27 of 33`; empty without any."""
    if not take.follow.use_keypoints:
        return "Off"
    sources = [each for each in keypoints_at(take, take.id_data.frame_current) if not each.is_tracked]
    if not sources:
        return ""
    seen = sum(each.seen_count for each in sources)
    return f"{seen} of {sum(len(each.names) for each in sources)}"


def tracks_label(take: bpy.types.PropertyGroup) -> str:
    """How many of the assigned tracks are seen in the current frame: `4 of 6`; empty without any."""
    if not take.follow.use_tracks:
        return "Off"
    assigned = assigned_tracks(take)
    if not assigned:
        return ""
    scene = take.id_data
    seen = len(tracks_at(footage_of(scene, take), scene.frame_current, assigned))
    return f"{seen} of {len(assigned)}"


def contours_label(take: bpy.types.PropertyGroup) -> str:
    """Whether contours can be followed."""
    if not take.follow.use_contours:
        return "Off"
    if take.camera is None:
        return ""
    return "Camera moves" if may_move(take.camera) else "Camera stands still"


def clicked_label(take: bpy.types.PropertyGroup) -> str:
    """How many points were clicked on in the current frame, and in all."""
    return f"{len(clicked_here(take))} here, {len(take.follow.clicks)} in all"
