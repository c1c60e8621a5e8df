"""The prior between keyframes."""

import numpy as np
import pytest
from _scene import exercise
from hypothesis import given, settings
from hypothesis import strategies as st
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.prior.keyframes import Keyframe, interpolate, interpolate_linearly

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


@pytest.mark.parametrize("method", [interpolate, interpolate_linearly])
def test_the_curve_passes_through_every_keyframe_and_is_held_outside(method) -> None:  # noqa: ANN001
    posed = keyframes()
    curve = method(posed, FRAMES)
    for keyframe in posed:
        assert np.abs(curve[keyframe.index].minus(keyframe.posture)).max() < 1e-9
    assert np.abs(curve[0].minus(posed[0].posture)).max() < 1e-9
    assert np.abs(curve[FRAMES - 1].minus(posed[-1].posture)).max() < 1e-9


def test_velocity_is_continuous_across_a_keyframe() -> None:
    """On a fine grid the step before a keyframe equals the step after it."""
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


def test_even_motion_is_reproduced_evenly() -> None:
    curve = interpolate(place_only([0.0, 1.0, 2.0], [0, 10, 20]), 21)
    np.testing.assert_allclose(curve.translation[:, 2], np.arange(21) / 10.0, atol=1e-12)


def test_a_turn_past_half_a_circle_keeps_its_direction() -> None:
    vectors = np.zeros((4, HUMAN.dof_count))
    turns = Posture.from_vector(HUMAN, vectors).plus(np.arange(4)[:, None] * 2.0 * np.eye(HUMAN.dof_count)[5])
    posed = tuple(Keyframe(10 * i, turns[i]) for i in range(4))
    curve = interpolate(posed, 31)
    steps = curve[np.arange(1, 31)].minus(curve[np.arange(30)])
    assert steps[:, 5].min() > 0.0
    assert steps[:, 5].sum() == pytest.approx(6.0)
