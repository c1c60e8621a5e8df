"""Estimating again after a change: only what it touches, and to the same result as from the beginning."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from _scene import BODY, CAMERA, SEGMENTS, exercise, film, point_error_m
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera
from keymark.core.estimate.warm_start import blend_weight, revised_windows
from keymark.core.estimate.whole_clip import (
    Believed,
    Seen,
    WholeClipOptions,
    WholeClipResult,
    estimate_whole_clip,
)
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.keyframes import Keyframe, interpolate
from keymark.core.progress import Preview

pytestmark = pytest.mark.slow

FRAMES, EVERY, MOVED = 216, 6, 18
TOLERANCE_MM = 4.0
"""At the one worst point; on average it is a twentieth."""
FARTHEST_MM = 12.0
"""At the worst point in a few frames that hardly anything determines, for which all keyframes count."""
TRUTH = exercise(FRAMES)
TRACKS = film(TRUTH, 0.3)
OPTIONS = WholeClipOptions(window_s=5.0, margin_s=2.0)


def posed(seed: int = 5) -> tuple[Keyframe, ...]:
    rng = np.random.default_rng(seed)
    index = [*range(0, FRAMES, EVERY), FRAMES - 1]
    error = rng.normal(0.0, 0.03, (len(index), BODY.skeleton.dof_count))
    error[:, :3] *= 0.3
    return tuple(Keyframe(i, TRUTH[i].plus(step)) for i, step in zip(index, error, strict=True))


def moved() -> tuple[Keyframe, ...]:
    """The same with one posed half as far off."""
    keyframes = posed()
    posture = keyframes[MOVED].posture
    better = posture.plus(0.5 * TRUTH[keyframes[MOVED].index].minus(posture))
    changed = replace(keyframes[MOVED], posture=better)
    return (*keyframes[:MOVED], changed, *keyframes[MOVED + 1 :])


def estimate(
    keyframes: tuple[Keyframe, ...],
    earlier: WholeClipResult | None = None,
    tracks: RegionTracks = TRACKS,
    camera: Camera = CAMERA,
) -> tuple[WholeClipResult, list[Preview]]:
    prior = interpolate(keyframes, FRAMES)
    index = tuple(keyframe.index for keyframe in keyframes)
    seen, believed = Seen(tracks, SEGMENTS), Believed(prior, index)
    job = estimate_whole_clip(BODY, camera, seen, believed, OPTIONS, earlier)
    shown = []
    while True:
        try:
            done = next(job)
        except StopIteration as stop:
            return stop.value, shown
        if isinstance(done, Preview):
            shown.append(done)


@cache
def first() -> WholeClipResult:
    return estimate(posed())[0]


def estimated_frames(shown: list[Preview]) -> int:
    frames = {preview.first + k for preview in shown for k in range(preview.posture.batch[0])}
    return len(frames)


def largest_mm(one: Posture, other: Posture) -> float:
    """Largest distance of any point [mm]."""
    return 1e3 * float(point_error_m(one, other).max())


def test_nothing_changed_costs_nothing_and_changes_nothing() -> None:
    again, shown = estimate(posed(), first())
    assert estimated_frames(shown) == 0
    assert largest_mm(again.posture, first().posture) < 1e-9
    assert np.array_equal(again.covariance, first().covariance)


def test_a_moved_keyframe_is_as_from_the_beginning_at_a_part_of_the_cost() -> None:
    fresh, all_shown = estimate(moved())
    again, shown = estimate(moved(), first())
    assert estimated_frames(all_shown) == FRAMES
    assert estimated_frames(shown) < 0.5 * FRAMES
    apart = 1e3 * point_error_m(again.posture, fresh.posture)
    changed = slice((MOVED - 1) * EVERY, (MOVED + 1) * EVERY + 1)
    assert apart[changed].max() < TOLERANCE_MM and apart.max() < FARTHEST_MM
    assert apart.mean() < 0.4 and np.quantile(apart, 0.99) < 2.0
    std = np.sqrt(np.diagonal(fresh.covariance, axis1=-2, axis2=-1))
    differ = np.abs(again.covariance - fresh.covariance) / (std[:, :, None] * std[:, None, :])
    assert differ.max() < 0.25
    assert largest_mm(first().posture, fresh.posture) > 2.0 * TOLERANCE_MM
    back, _ = estimate(posed(), again)
    assert largest_mm(back.posture, first().posture) < TOLERANCE_MM


def test_keyframes_may_come_and_go() -> None:
    keyframes = posed()
    index = MOVED * EVERY + EVERY // 2
    keyframes = (*keyframes[:MOVED], Keyframe(index, first().posture[index]), *keyframes[MOVED + 1 :])
    again, _ = estimate(keyframes, first())
    assert largest_mm(again.posture, estimate(keyframes)[0].posture) < TOLERANCE_MM


def test_frames_seen_differently_are_estimated_again() -> None:
    centroid = TRACKS.centroid.copy()
    centroid[127:132, 1] += 3.0  # between two keyframes
    other = replace(TRACKS, centroid=centroid)
    again, shown = estimate(posed(), first(), other)
    assert 0 < estimated_frames(shown) < 0.5 * FRAMES
    assert largest_mm(again.posture, estimate(posed(), tracks=other)[0].posture) < TOLERANCE_MM


def test_an_estimate_before_another_camera_is_not_used() -> None:
    stand = CAMERA.matrix_world.copy()
    stand[0, 3] += 0.05
    other = replace(CAMERA, matrix_world=stand)
    assert estimated_frames(estimate(posed(), first(), camera=other)[1]) == FRAMES


def test_windows_around_changes_reach_beyond_them_and_never_keep_a_frame_twice() -> None:
    changed = np.zeros(1000, dtype=bool)
    changed[[3, 300, 330]] = True
    changed[600:900] = True
    found = revised_windows(changed, 100, 20)
    kept = [(window.keep_first, window.keep_last) for window in found]
    assert kept[:2] == [(0, 24), (280, 351)]
    assert kept[2][0] == 580 and kept[-1][1] == 920 and len(kept) == 5
    assert all(a[1] <= b[0] for a, b in zip(kept, kept[1:], strict=False))
    assert all(w.first == max(w.keep_first - 20, 0) and w.last == min(w.keep_last + 20, 1000) for w in found)
    share = blend_weight(changed, 20)
    assert (share[600:910] == 1.0).all() and share[580] == 0.0 and 0.0 < share[585] < share[588] < 1.0
    assert np.abs(np.diff(share)).max() < 0.2
    nothing = np.zeros(10, dtype=bool)
    assert revised_windows(nothing, 100, 20) == [] and not blend_weight(nothing, 20).any()
