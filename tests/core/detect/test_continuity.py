"""A path that jumps to somebody else is told from one that goes on, however fast."""

import numpy as np
import pytest
from keymark.core.arrays import Array
from keymark.core.detect.performer import same_person

FPS, FRAMES, POINTS = 30.0, 90, 17
SHAPE = np.random.default_rng(5).uniform([-25.0, -60.0], [25.0, 60.0], (POINTS, 2))


def walk(start: float, step: float, frames: int = FRAMES) -> Array:
    """(F, N, 2) somebody 120 pixels tall who walks across the picture, with limbs that swing."""
    time = np.arange(frames)[:, None]
    swing = 8.0 * np.sin(0.4 * time + np.arange(POINTS))
    return SHAPE + np.stack([start + step * time + swing, np.full((frames, POINTS), 120.0)], axis=-1)


@pytest.mark.parametrize("length", [1, 4, 20, 40])
def test_a_jump_to_somebody_else_and_back_is_left_out(length: int) -> None:
    path, other = walk(60.0, 2.0), walk(260.0, -3.0) + [0.0, 70.0]
    gone = np.arange(31, 31 + length)
    path[gone] = other[gone]
    np.testing.assert_array_equal(np.flatnonzero(~same_person(path, FPS)), gone)


def test_the_longer_part_is_the_performer_unless_the_picture_says_otherwise() -> None:
    path = walk(60.0, 2.0)
    path[30:] = walk(260.0, -3.0)[30:]
    np.testing.assert_array_equal(np.flatnonzero(~same_person(path, FPS)), np.arange(30))
    np.testing.assert_array_equal(
        np.flatnonzero(~same_person(path, FPS, {10: True, 50: False, 80: False})), np.arange(30, FRAMES)
    )


def test_where_they_cross_the_picture_tells_of_the_jump_back() -> None:
    path, other = walk(60.0, 2.0), walk(213.0, -1.0)
    gone = np.arange(31, 51)
    path[gone] = other[gone]  # who is met by the performer
    assert not same_person(path, FPS)[gone[0]] or same_person(path, FPS)[70]
    looked = {frame: frame not in gone for frame in (5, 15, 26, 36, 46, 57, 67, 80)}
    left_out = np.flatnonzero(~same_person(path, FPS, looked))
    assert left_out[0] == gone[0] and abs(left_out[-1] - gone[-1]) <= 1 and len(left_out) in (19, 20, 21)


def test_a_picture_that_differs_is_not_believed_where_nothing_jumps() -> None:
    assert same_person(walk(60.0, 2.0), FPS, {10: True, 30: False, 50: True}).all()


def test_nobody_is_lost_who_runs_leaps_or_is_seen_in_part() -> None:
    run = walk(0.0, 12.0, 40)
    run[10:14, 6:] = np.nan  # legs behind something
    run[20:26] = np.nan
    leap = walk(100.0, 0.0, 40)
    leap[..., 1] -= 4.0 * np.clip(np.arange(40) - 10, 0, 12)[:, None]
    for path in (run, leap, walk(0.0, 0.0, 1), np.full((5, POINTS, 2), np.nan)):
        assert same_person(path, FPS).all()


def test_limbs_that_are_exchanged_are_no_jump() -> None:
    path = walk(100.0, 1.0)
    path[20:30, ::3] = path[20:30, ::3][:, ::-1]
    assert same_person(path, FPS).all()
