"""Which way round the body turns between keyframes is decided by the footage."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from _scene import BODY, CAMERA, SEGMENTS, belief_in, exercise, film, point_error_m
from keymark.core.body.posture import Posture, yawed_at
from keymark.core.estimate.clip_problem import Seen
from keymark.core.estimate.refinement import doubted_turns
from keymark.core.estimate.whole_clip import WholeClipResult, estimate_whole_clip
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.keyframes import Keyframe, interpolate
from keymark.core.progress import run

FRAMES, EVERY = 76, 15
GAP = 1
"""The gap in which the performer turns, from frame 15 to 30."""


def turning(degrees: float) -> Posture:
    still = exercise(FRAMES)
    share = np.clip((np.arange(FRAMES) - EVERY) / EVERY, 0.0, 1.0)
    return yawed_at(still, np.radians(degrees) * share**2 * (3.0 - 2.0 * share), still.translation)


def estimate(truth: Posture, tracks: RegionTracks) -> WholeClipResult:
    """The estimate from a keyframe every half second."""
    keys = tuple(Keyframe(index, truth[index]) for index in range(0, FRAMES, EVERY))
    belief = belief_in(interpolate(keys, FRAMES), tuple(key.index for key in keys))
    return run(estimate_whole_clip(BODY, CAMERA, Seen(tracks, SEGMENTS), belief))


@cache
def turned(degrees: float) -> tuple[Posture, RegionTracks, WholeClipResult]:
    """A turn, its tracks and the estimate from them."""
    truth = turning(degrees)
    tracks = film(truth, 0.3)
    return truth, tracks, estimate(truth, tracks)


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
    assert not estimate(truth, blind).problem.turns.any()


def test_nobody_turns_faster_than_a_dancer() -> None:
    problem = long_turn()[2].problem
    problem = problem.with_turns(np.zeros_like(problem.turns))
    cost, data = np.zeros(FRAMES), problem.data
    assert [doubt.gap for doubt in doubted_turns(problem, cost)] == [GAP]
    tracks = replace(data.seen.tracks, time_s=0.2 * data.time_s)
    fast = replace(data, seen=replace(data.seen, tracks=tracks))
    assert doubted_turns(replace(problem, data=fast), cost) == []
    bad = np.where(np.arange(FRAMES) > 60, 3.0, 0.0)
    assert {doubt.gap: doubt.turns for doubt in doubted_turns(problem, bad)}[4] in ((-1, 1), (1, -1))
