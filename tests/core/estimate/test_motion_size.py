"""How far the motion departs from the prior is learned from postures that are known."""

from collections.abc import Generator
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from _scene import BODY, CAMERA, SEGMENTS, belief_in, exercise, film, point_error_m
from keymark.core.body.posture import Posture
from keymark.core.estimate.clip_problem import ClipProblem, Seen
from keymark.core.estimate.refinement import (
    LARGEST_OF_ALL,
    LARGEST_PER_GAP_S,
    USUAL_SIZE,
    adapted,
    followed_markers,
    limb_sizes,
)
from keymark.core.estimate.whole_clip import estimate_whole_clip
from keymark.core.estimate.window_problem import WindowProblem
from keymark.core.estimate.windows import Window, windows
from keymark.core.prior.keyframes import Keyframe, interpolate
from keymark.core.progress import run
from keymark.core.terms.term import ClipState

FRAMES, EVERY = 61, 15
WHOLE = [Window(0, FRAMES, 0, FRAMES)]
COLUMN = {name: number for number, name in enumerate(BODY.skeleton.dof_names)}
LIMB = next(limb for limb in BODY.skeleton.limbs if COLUMN["elbow.L.flexion"] in limb)
OTHERS = np.setdiff1d(np.arange(len(COLUMN)), LIMB)
GAP = slice(2 * EVERY, 3 * EVERY)
"""The gap in which the performer leaves the line."""


@cache
def problem(segments: tuple[str, ...] = SEGMENTS) -> ClipProblem:
    """Of the exercise with a keyframe every half second, nothing learned yet."""
    truth = exercise(FRAMES)
    tracks = film(truth, 0.3)
    worn = [SEGMENTS.index(segment) for segment in segments]
    tracks = replace(
        tracks,
        names=segments,
        **{
            name: getattr(tracks, name)[:, worn]
            for name in ("centroid", "second_moment", "area", "quality", "clipped")
        },
    )
    keys = tuple(Keyframe(index, truth[index]) for index in range(0, FRAMES, EVERY))
    index = tuple(key.index for key in keys)
    job = estimate_whole_clip(
        BODY, CAMERA, Seen(tracks, segments), belief_in(interpolate(keys, FRAMES), index)
    )
    found = run(job).problem
    return replace(
        found, limb_size=np.ones_like(found.limb_size), depth_factor=np.ones_like(found.depth_factor)
    )


def about(clip: ClipProblem, posture: Posture, spans: list[Window]) -> list[ClipState]:
    """States with these F postures."""
    starts = [clip.start(window) for window in spans]
    return [
        replace(start, variation=np.linalg.solve(start.factor, posture[window.frames].minus(start.prior).T).T)
        for start, window in zip(starts, spans, strict=True)
    ]


def trembling(size: np.ndarray, seed: int = 3) -> list[ClipState]:
    """A state whose unknowns' second differences have these root mean squares (D,)."""
    noise = np.random.default_rng(seed).normal(size=(FRAMES - 2, len(COLUMN)))
    noise /= np.sqrt((noise**2).mean(axis=0))
    variation = np.zeros((FRAMES, len(COLUMN)))
    variation[2:] = np.cumsum(np.cumsum(noise * size, axis=0), axis=0)
    return [replace(problem().start(WHOLE[0]), variation=variation)]


def bulging(meters: float, frames: slice = GAP) -> Posture:
    """The prior, from which the pelvis departs to the side between two keyframes."""
    step = np.zeros((FRAMES, len(COLUMN)))
    phase = np.linspace(0.0, np.pi, frames.stop - frames.start + 1)[:-1]
    step[frames, COLUMN["pelvis.location_x"]] = meters * np.sin(phase)
    return problem().prior.plus(step)


def learn(
    clip: ClipProblem,
    posture: Posture,
    spans: list[Window] = WHOLE,
) -> tuple[ClipProblem, list[ClipState]]:
    """What is learned from these F postures."""
    return finished(adapted(clip, spans, about(clip, posture, spans)))


def finished(
    job: Generator[None, None, tuple[ClipProblem, list[ClipState]]],
) -> tuple[ClipProblem, list[ClipState]]:
    while True:
        try:
            next(job)
        except StopIteration as stop:
            return stop.value


@pytest.fixture
def unsettled(monkeypatch: pytest.MonkeyPatch) -> None:
    """States are left as they were given."""
    monkeypatch.setattr(WindowProblem, "converge", lambda self, steps: iter(()))


def test_a_limb_that_moves_more_than_keyframes_tell_gets_a_larger_size() -> None:
    size = np.full(len(COLUMN), USUAL_SIZE)
    np.testing.assert_allclose(limb_sizes(problem(), WHOLE, trembling(size)), 1.0)
    size[LIMB] *= 2.0
    found = limb_sizes(problem(), WHOLE, trembling(size))
    np.testing.assert_allclose(found[OTHERS], 1.0)
    assert 1.3 < found[LIMB[0]] < 2.0 and np.ptp(found[LIMB]) == 0.0


def test_sizes_have_bounds() -> None:
    usual = np.full(len(COLUMN), USUAL_SIZE)
    np.testing.assert_array_equal(limb_sizes(problem(), WHOLE, trembling(0.01 * usual)), 1.0)
    wild = trembling(100.0 * usual)
    np.testing.assert_allclose(limb_sizes(problem(), WHOLE, wild), LARGEST_PER_GAP_S * EVERY / 30.0)
    for frames, largest in (([0, FRAMES - 1], LARGEST_OF_ALL), ([0], 1.0)):
        belief = replace(problem().data.belief, frame=np.array(frames))
        sparse = replace(problem(), data=replace(problem().data, belief=belief))
        np.testing.assert_array_equal(limb_sizes(sparse, WHOLE, wild), largest)


def test_windows_tell_the_same_as_the_whole_clip() -> None:
    size = np.full(len(COLUMN), 2.0 * USUAL_SIZE)
    whole = trembling(size)
    spans = list(windows(FRAMES, 20, 6))
    assert len(spans) == 3
    cut = [whole[0].of_frames(window.frames) for window in spans]
    np.testing.assert_array_equal(limb_sizes(problem(), spans, cut), limb_sizes(problem(), WHOLE, whole))


def test_where_the_prior_misses_across_the_line_of_sight_its_depth_is_trusted_less(unsettled: None) -> None:
    still, _ = learn(problem(), problem().prior)
    near, _ = learn(problem(), bulging(0.1))
    far, _ = learn(problem(), bulging(0.3))
    others = np.ones(FRAMES, dtype=bool)
    others[GAP] = False
    for found in (still, near, far):
        np.testing.assert_array_equal(found.depth_factor[others], still.depth_factor[others])
        assert (np.ptp(found.depth_factor[GAP], axis=0) == 0.0).all()
    assert (near.depth_factor[GAP] > 1.5 * still.depth_factor[GAP]).all()
    assert (far.depth_factor[GAP] > 1.5 * near.depth_factor[GAP]).all()


def test_postures_stay_as_they_are_when_sizes_change(unsettled: None) -> None:
    swings = np.zeros((FRAMES, len(COLUMN)))
    swings[:, LIMB] = np.sin(2.0 * np.pi * np.arange(FRAMES) / 8.0)[:, None]
    posture = replace(problem().start(WHOLE[0]), variation=swings).posture
    found, states = learn(problem(), posture)
    assert found.limb_size[LIMB].min() > 1.1
    assert point_error_m(states[0].posture, posture).max() < 1e-9
    np.testing.assert_array_equal(states[0].factor, found.accelerations)


def test_nothing_is_learned_where_markers_do_not_show_the_whole_body() -> None:
    clip = problem(("trunk", "forearm.L"))
    posture = exercise(FRAMES, 0.5)
    states = about(clip, posture, WHOLE)
    same, kept = finished(adapted(clip, WHOLE, states))
    assert same is clip and kept is states
    other, _ = learn(problem(), posture)
    assert other is not problem()


@pytest.mark.parametrize(
    ("lost", "there", "followed"),
    [
        ({}, slice(None), [True] * 5),
        ({1: slice(20, 28)}, slice(None), [True] * 5),
        ({1: slice(20, 29)}, slice(None), [True, False, True, True, True]),
        ({1: slice(20, 26), 3: slice(20, 61)}, slice(None), [True, True, True, False, True]),
        ({4: slice(30, 61)}, slice(0, 35), [True] * 5),
    ],
)
def test_a_marker_tells_where_its_limb_is_unless_it_is_lost_for_a_quarter_of_a_second(
    lost: dict[int, slice], there: slice, followed: list[bool]
) -> None:
    """Frames in which the performer is not there do not count."""
    data = problem().data
    quality, seen = data.observed.quality.copy(), np.zeros(FRAMES, dtype=bool)
    seen[there] = True
    for marker, frames in lost.items():
        quality[frames, marker] = 0.0
    tracks = replace(data.seen.tracks, quality=quality)
    data = replace(data, seen=replace(data.seen, tracks=tracks, there=seen))
    assert followed_markers(data) == followed
