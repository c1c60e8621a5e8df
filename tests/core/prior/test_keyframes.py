"""Keyframes: interpolation, turns the other way round, and how a performer differs from a library."""

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
    interpolate,
    with_offset,
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


FPS = 30.0
TRUTH = exercise(91)
SAID = Matched("walking", "step", False, 0.9)
STYLE = np.where(np.arange(TRUTH.skeleton.dof_count) < 3, 0.05, 0.15)


def matched(frames: list[int], library: Posture) -> list[Keyframe]:
    """Keyframes as a library would have them."""
    return [Keyframe(frame, library[frame], matched=SAID) for frame in frames]


def error(keyframes: tuple[Keyframe, ...]) -> float:
    """Mean distance of the matched ones from the truth, in the posture's unknowns."""
    off = [np.abs(k.posture.minus(TRUTH[k.index])).mean() for k in keyframes if k.matched is not None]
    return float(np.mean(off))


def in_order(*keyframes: Keyframe) -> tuple[Keyframe, ...]:
    return tuple(sorted(keyframes, key=lambda keyframe: keyframe.index))


def test_a_difference_that_lasts_is_taken_out_of_all_matched_keyframes() -> None:
    library = TRUTH.plus(np.tile(STYLE, (91, 1)))
    every = matched(list(range(3, 90, 6)), library)
    before = in_order(*every)
    one, doubt_one = with_offset(in_order(*every, Keyframe(30, TRUTH[30])), FPS)
    two, doubt_two = with_offset(in_order(*every, Keyframe(20, TRUTH[20]), Keyframe(70, TRUTH[70])), FPS)
    assert error(two) < 0.5 * error(before)
    assert error(two) < error(one) < 0.7 * error(before)
    assert doubt_two[doubt_two > 0.0].mean() < doubt_one[doubt_one > 0.0].mean() < 1.0


def test_posed_keyframes_stay_and_are_not_doubted() -> None:
    given = in_order(*matched([0, 30, 60, 90], TRUTH.plus(np.tile(STYLE, (91, 1)))), Keyframe(45, TRUTH[45]))
    changed, doubt = with_offset(given, FPS)
    assert changed[2] is given[2] and doubt[2] == 0.0
    assert [keyframe.index for keyframe in changed] == [0, 30, 45, 60, 90]
    assert all(keyframe.matched == SAID for keyframe in changed if keyframe.index != 45)


def test_without_posed_or_without_matched_ones_nothing_changes() -> None:
    unposed = in_order(*matched([0, 40, 80], TRUTH))
    posed = in_order(Keyframe(0, TRUTH[0]), Keyframe(80, TRUTH[80]))
    assert with_offset(unposed, FPS)[0] is unposed and with_offset(unposed, FPS)[1].tolist() == [1.0] * 3
    assert with_offset(posed, FPS)[0] is posed and with_offset(posed, FPS)[1].tolist() == [0.0] * 2


def test_a_posed_keyframe_far_from_all_matched_ones_says_little() -> None:
    near = with_offset(in_order(*matched([0, 10], TRUTH), Keyframe(12, TRUTH[60])), FPS)[0]
    far = with_offset(in_order(*matched([0, 10], TRUTH), Keyframe(60, TRUTH[60])), FPS)[0]
    moved = [np.abs(one[1].posture.minus(TRUTH[10])).mean() for one in (near, far)]
    assert moved[1] < 0.1 * moved[0]


def test_the_nearer_of_two_posed_keyframes_counts_more() -> None:
    drift = STYLE * np.linspace(0.0, 1.0, 91)[:, None]
    library = TRUTH.plus(drift)
    given = in_order(*matched(list(range(3, 90, 6)), library), Keyframe(2, TRUTH[2]), Keyframe(88, TRUTH[88]))
    changed, _ = with_offset(given, FPS)
    steps = [-k.posture.minus(library[k.index])[0] for k in changed if k.matched is not None]
    assert 0.0 < steps[0] < steps[-1] < 1.05 * drift[88, 0]


def test_postures_composed_for_the_footage_stay_and_are_doubted_less_near_posed_ones() -> None:
    said = Matched(COMPOSED, "step", False, 0.9)
    library = TRUTH.plus(np.tile(STYLE, (91, 1)))
    found = [Keyframe(frame, library[frame], matched=said) for frame in (0, 30, 60, 90)]
    changed, doubt = with_offset(in_order(*found, Keyframe(35, TRUTH[35])), FPS)
    assert all(np.abs(new.posture.minus(library[new.index])).max() < 1e-9 for new in changed if new.matched)
    assert doubt[1] < doubt[0] < 1.0 and doubt[1] < doubt[3] and doubt[2] == 0.0
    both = in_order(*found, *matched([15, 75], library), Keyframe(35, TRUTH[35]))
    moved = [np.abs(new.posture.minus(library[new.index])).max() > 0.05 for new in with_offset(both, FPS)[0]]
    assert moved == [False, True, False, True, False, True, False]
