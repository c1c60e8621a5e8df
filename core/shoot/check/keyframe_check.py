"""The check of a take's keyframes: fit to the actor, inside clip and picture, gaps between them."""

from collections.abc import Sequence

import numpy as np

from ...take.clip_check import check_frame_count, check_in_front
from ...take.take import Take
from .findings import Findings

LONGEST_GAP_S = 1.0
"""Longest gap between keyframes without a warning where none are found in it: ten in 100 frames are usual."""
FEWEST_IN_PICTURE = 0.5
"""Share of a keyframe's points that must lie in the picture."""
MOST_NAMED = 3


def check_keyframes(take: Take, frames: int, others_found: bool, findings: Findings) -> None:
    """Check keyframes that could be read."""
    _check_fit(take, findings)
    with findings.catching():
        check_frame_count(take, frames)  # first: a moving camera may lack the poses of keyframes
        check_in_front(take)
    if findings.problems or not take.keyframes:
        return
    if not others_found:
        _check_gaps(take, frames, findings)
    _check_picture(take, findings)


def _check_fit(take: Take, findings: Findings) -> None:
    if len(take.notes) <= MOST_NAMED:
        findings.warn(*take.notes)
        return
    residual = [keyframe.residual_m for keyframe in take.keyframes]
    findings.warn(
        f"the points of {len(take.notes)} of {len(take.keyframes)} keyframes are up to "
        f"{100 * max(residual):.0f} cm on average from any posture of this actor; check the actor's "
        "lengths, and whether these are the performer's own keyframes"
    )


def _check_gaps(take: Take, frames: int, findings: Findings) -> None:
    ends = [0, *(index for index in take.keyframe_indices if index < frames), frames - 1]
    gaps = np.diff(ends)
    longest = int(np.argmax(gaps))
    seconds = gaps[longest] / take.fps
    if seconds > LONGEST_GAP_S:
        first, last = ends[longest] + take.frame_start, ends[longest + 1] + take.frame_start
        findings.warn(
            f"{len(take.keyframes)} keyframes for {frames} frames are few: from frame {first} to "
            f"{last}, {seconds:.1f} s, there is none; pose more, or let --keyframes auto find the "
            "others"
        )


def _check_picture(take: Take, findings: Findings) -> None:
    width, height = take.camera.resolution
    outside = []
    for keyframe in take.keyframes:
        points = take.body.points(take.body.pose(keyframe.posture))
        x, y = np.moveaxis(take.camera.project(points, keyframe.index)[0], -1, 0)
        inside = (x >= 0.0) & (x <= width) & (y >= 0.0) & (y <= height)
        if inside.mean() < FEWEST_IN_PICTURE:
            outside.append(keyframe.index + take.frame_start)
    if outside:
        findings.warn(
            f"through this camera {_frames(outside)} would be seen outside the picture for the most "
            "part; check where the camera stands and its lens"
        )


def _frames(frames: Sequence[int]) -> str:
    named = ", ".join(str(frame) for frame in frames[:MOST_NAMED])
    more = f" and {len(frames) - MOST_NAMED} more" if len(frames) > MOST_NAMED else ""
    return f"keyframe {named}" if len(frames) == 1 else f"the keyframes {named}{more}"
