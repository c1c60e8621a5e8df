"""Keyframes: interpolation, turns the other way round, and the doubt in found ones."""

import numpy as np
import pytest
from _scene import BODY, exercise
from hypothesis import given, settings
from hypothesis import strategies as st
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture, headings_rad, yawed_at
from keymark.core.prior.keyframes import (
    Keyframe,
    Matched,
    found_doubt,
    interpolate,
    with_turns,
)
from keymark.core.prior.texts import COMPOSED

INDICES = (2, 9, 20, 26, 40)
FRAMES = 44


def keyframes(indices: tuple[int, ...] = INDICES) -> tuple[Keyframe, ...]:
    posed = exercise(60)[np.array(indices)]
    return tuple(Keyframe(index, posed[i]) for i, index in enumerate(indices))


def place_only(values: list[float], indices: list[int]) -> tuple[Keyframe, ...]:
    """Keyframes that differ in the hips' height alone."""
    vectors = np.zeros((len(values), HUMAN.dof_count))
    vectors[:, 2] = values
    posed = Posture.from_vector(HUMAN, vectors)
    return tuple(Keyframe(index, posed[i]) for i, index in enumerate(indices))


def test_the_curve_passes_through_every_keyframe_and_is_held_outside() -> None:
    posed = keyframes()
    curve = interpolate(posed, FRAMES)
    for keyframe in posed:
        assert np.abs(curve[keyframe.index].minus(keyframe.posture)).max() < 1e-9
    assert np.abs(curve[0].minus(posed[0].posture)).max() < 1e-9
    assert np.abs(curve[FRAMES - 1].minus(posed[-1].posture)).max() < 1e-9


def test_velocity_is_continuous_across_a_keyframe() -> None:
    fine = 200
    posed = tuple(Keyframe(k.index * fine, k.posture) for k in keyframes())
    curve = interpolate(posed, INDICES[-1] * fine + 1)
    for keyframe in posed[1:-1]:
        i = keyframe.index
        before = curve[i].minus(curve[i - 1])
        after = curve[i + 1].minus(curve[i])
        np.testing.assert_allclose(before, after, atol=2e-6)


@settings(max_examples=60)
@given(
    st.lists(st.floats(-1.0, 1.0), min_size=2, max_size=7),
    st.lists(st.integers(1, 12), min_size=6, max_size=6),
)
def test_no_component_overshoots_its_neighboring_keyframes(values: list[float], gaps: list[int]) -> None:
    indices = [0, *np.cumsum(gaps[: len(values) - 1]).tolist()]
    curve = interpolate(place_only(values, indices), indices[-1] + 1).translation[:, 2]
    for i in range(len(values) - 1):
        low, high = sorted(values[i : i + 2])
        stretch = curve[indices[i] : indices[i + 1] + 1]
        assert stretch.min() >= low - 1e-12 and stretch.max() <= high + 1e-12


def test_a_turn_past_half_a_circle_keeps_its_direction() -> None:
    vectors = np.zeros((4, HUMAN.dof_count))
    turns = Posture.from_vector(HUMAN, vectors).plus(np.arange(4)[:, None] * 2.0 * np.eye(HUMAN.dof_count)[5])
    posed = tuple(Keyframe(10 * i, turns[i]) for i in range(4))
    curve = interpolate(posed, 31)
    steps = curve[np.arange(1, 31)].minus(curve[np.arange(30)])
    assert steps[:, 5].min() > 0.0
    assert steps[:, 5].sum() == pytest.approx(6.0)


TURNS_AT = np.array([5, 15, 30, 40])
TURNING_FRAMES = 48


def facing() -> Posture:
    """Four postures that face 0, 20, 166 and 180 degrees."""
    still = exercise(4)
    return yawed_at(still, np.radians([0.0, 20.0, 166.0, 180.0]) - headings_rad(still), still.translation)


def short_way() -> Posture:
    """The short way round: 146 degrees in the middle."""
    keys = tuple(Keyframe(int(k), posture) for k, posture in zip(TURNS_AT, facing(), strict=True))
    return interpolate(keys, TURNING_FRAMES)


def test_the_other_way_round_passes_through_the_same_keyframes() -> None:
    short, long = short_way(), with_turns(short_way(), TURNS_AT, np.array([0, -1, 0]))
    np.testing.assert_allclose(long[TURNS_AT].rotations, short[TURNS_AT].rotations, atol=1e-9)
    heading = np.unwrap(headings_rad(long))
    np.testing.assert_allclose(np.degrees(heading[30] - heading[15]), -214.0, atol=1e-6)
    steps = np.degrees(np.diff(heading[15:31]))
    assert steps.max() < 0.0 and steps.min() > 2.5 * -214.0 / 15
    assert np.abs(np.degrees(np.diff(heading, n=2))).max() < 12.0  # no jump in speed at the keyframes
    np.testing.assert_array_equal(long.translation, short.translation)
    np.testing.assert_array_equal(long.rotations[:, 1:], short.rotations[:, 1:])
    np.testing.assert_array_equal(long.rotations[:6], short.rotations[:6])
    np.testing.assert_array_equal(long.rotations[40:], short.rotations[40:])


def test_a_whole_turn_more_is_seen_on_the_way_only() -> None:
    short = short_way()
    assert with_turns(short, TURNS_AT, np.zeros(3, dtype=np.intp)) is short
    heading = np.unwrap(headings_rad(with_turns(short, TURNS_AT, np.array([0, 1, 0]))))
    np.testing.assert_allclose(np.degrees(heading[30] - heading[15]), 506.0, atol=1e-6)
    both = with_turns(short, TURNS_AT, np.array([1, -1, 0]))
    points = BODY.points(BODY.pose(both))
    np.testing.assert_allclose(points[TURNS_AT], BODY.points(BODY.pose(short))[TURNS_AT], atol=1e-9)


FOUND = Matched(COMPOSED, "step", False, 0.9)


@pytest.mark.parametrize(
    ("found", "posed", "doubt"),
    [
        ((0, 40, 80), (), (1.0, 1.0, 1.0)),
        ((), (0, 80), (0.0, 0.0)),
        ((0, 30, 60, 90), (35,), (0.852, 0.575, 0.0, 0.824, 0.872)),
        ((0, 10), (60,), (0.9995, 0.9995, 0.0)),  # far from all that was found
        ((0, 10), (12,), (0.812, 0.656, 0.0)),
    ],
)
def test_found_keyframes_are_doubted_less_near_posed_ones(
    found: tuple[int, ...], posed: tuple[int, ...], doubt: tuple[float, ...]
) -> None:
    posture = Posture.rest(BODY.skeleton)
    every = [Keyframe(frame, posture, matched=FOUND) for frame in found]
    every += [Keyframe(frame, posture) for frame in posed]
    given = tuple(sorted(every, key=lambda keyframe: keyframe.index))
    np.testing.assert_allclose(found_doubt(given, 30.0), doubt, atol=6e-4)
