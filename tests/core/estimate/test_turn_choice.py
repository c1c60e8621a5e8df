"""Which way round the body turns between keyframes is decided by the footage."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from _scene import BODY, CAMERA, SEGMENTS, exercise, film, point_error_m
from keymark.core.body.posture import Posture, yawed_at
from keymark.core.estimate.turn_choice import doubted_turns
from keymark.core.estimate.whole_clip import Believed, Seen, WholeClipResult, estimate_whole_clip
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.keyframes import Keyframe, interpolate
from keymark.core.progress import Preview

FRAMES, EVERY = 76, 15
GAP = 1
"""The gap in which the performer turns, from frame 15 to 30."""


def turning(degrees: float) -> Posture:
    still = exercise(FRAMES)
    share = np.clip((np.arange(FRAMES) - EVERY) / EVERY, 0.0, 1.0)
    return yawed_at(still, np.radians(degrees) * share**2 * (3.0 - 2.0 * share), still.translation)


def estimate(
    truth: Posture, tracks: RegionTracks, earlier: WholeClipResult | None = None, off_rad: float = 0.0
) -> tuple[WholeClipResult, int]:
    """The estimate from a keyframe every half second, and how many frames were estimated.

    `off_rad` is an error of the last keyframe but one's head.
    """
    keys = [Keyframe(index, truth[index]) for index in range(0, FRAMES, EVERY)]
    step = np.zeros(BODY.skeleton.dof_count)
    step[BODY.skeleton.dof_names.index("neck.rotation_x")] = off_rad
    keys[-2] = replace(keys[-2], posture=keys[-2].posture.plus(step))
    prior, index = interpolate(tuple(keys), FRAMES), tuple(key.index for key in keys)
    job = estimate_whole_clip(BODY, CAMERA, Seen(tracks, SEGMENTS), Believed(prior, index), earlier=earlier)
    shown: set[int] = set()
    while True:
        try:
            done = next(job)
        except StopIteration as stop:
            return stop.value, len(shown)
        if isinstance(done, Preview):
            shown |= set(range(done.first, done.first + done.posture.batch[0]))


@cache
def turned(degrees: float) -> tuple[Posture, RegionTracks, WholeClipResult]:
    """A turn, its tracks and the estimate from them."""
    truth = turning(degrees)
    tracks = film(truth, 0.3)
    return truth, tracks, estimate(truth, tracks)[0]


def long_turn() -> tuple[Posture, RegionTracks, WholeClipResult]:
    """A turn by -214 degrees, which interpolation takes for one by 146."""
    return turned(-214.0)


@pytest.mark.parametrize(("degrees", "added"), [(-214.0, -1), (146.0, 0), (300.0, 1), (50.0, 0)])
def test_the_footage_says_which_way_round(degrees: float, added: int) -> None:
    truth, _, result = turned(degrees)
    turns = result.problem.turns.tolist()
    assert turns.pop(GAP) == added
    assert not any(turns)
    assert 1e3 * point_error_m(result.posture, truth).mean() < 40.0


def test_nothing_seen_decides_nothing() -> None:
    truth, tracks, _ = long_turn()
    blind = replace(
        tracks,
        centroid=np.full_like(tracks.centroid, np.nan),
        second_moment=np.full_like(tracks.second_moment, np.nan),
        quality=np.zeros_like(tracks.quality),
        area=np.full_like(tracks.area, np.nan),
    )
    result, _ = estimate(truth, blind)
    assert not result.problem.turns.any()


def test_nobody_turns_faster_than_a_dancer() -> None:
    problem = long_turn()[2].problem
    problem = problem.with_turns(np.zeros_like(problem.turns))
    every, cost = np.ones(len(problem.turns), dtype=bool), np.zeros(FRAMES)
    assert [doubt.gap for doubt in doubted_turns(problem, cost, every)] == [GAP]
    assert doubted_turns(problem, cost, ~every) == []
    assert doubted_turns(replace(problem, step_s=0.2 * problem.step_s), cost, every) == []
    bad = np.where(np.arange(FRAMES) > 60, 3.0, 0.0)
    assert {doubt.gap: doubt.turns for doubt in doubted_turns(problem, bad, every)}[4] in ((-1, 1), (1, -1))


def test_a_turn_stays_where_nothing_changed_and_is_decided_anew_elsewhere() -> None:
    truth, tracks, first = long_turn()
    same, frames = estimate(truth, tracks, first)
    assert frames == 0
    assert point_error_m(same.posture, first.posture).max() < 1e-9
    fresh, _ = estimate(truth, tracks, off_rad=0.1)
    again, frames = estimate(truth, tracks, first, off_rad=0.1)
    assert frames > 0
    assert again.problem.turns.tolist() == fresh.problem.turns.tolist() == [0, -1, 0, 0, 0]
    assert 1e3 * point_error_m(again.posture, fresh.posture).max() < 4.0
    seen = tracks.centroid.copy()
    seen[20:24, 1] += 2.0
    moved = replace(tracks, centroid=seen)
    anew, frames = estimate(truth, moved, first)
    assert frames > 0
    assert anew.problem.turns.tolist() == [0, -1, 0, 0, 0]
    assert 1e3 * point_error_m(anew.posture, estimate(truth, moved)[0].posture).max() < 4.0
