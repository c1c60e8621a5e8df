"""Outlier takes of a shoot, and estimates of a conversion's cost."""

import pytest
from keymark.core.shoot.check.take_check import TakeCheck, estimate_cost, flag_outliers


def check(width: int | None, fps: float = 25.0) -> TakeCheck:
    return TakeCheck("take", (), (), None if width is None else (width, 240), fps)


def test_an_outlier_among_many_is_flagged() -> None:
    warned = flag_outliers([check(320), check(320), check(640), check(320), check(320, 30.0), check(None)])
    assert [len(one.warnings) for one in warned] == [0, 0, 1, 0, 1, 0]
    assert "640 x 240 pixels" in warned[2].warnings[0] and "25 frames per second" in warned[4].warnings[0]


@pytest.mark.parametrize("widths", [(320, 320, 320, 640), (320, 320, 320, 640, 640, 640)])
def test_without_a_usual_value_there_is_no_outlier(widths: tuple[int, ...]) -> None:
    assert all(one.warnings == () for one in flag_outliers([check(width) for width in widths]))


def test_longer_and_larger_clips_cost_more() -> None:
    small = estimate_cost(100, (320, 240), "map", None)
    assert estimate_cost(200, (320, 240), "map", None).seconds > small.seconds
    assert estimate_cost(100, (1920, 1080), "map", None).seconds > small.seconds
    named, every = (
        estimate_cost(100, (320, 240), "map", "walking"),
        estimate_cost(100, (320, 240), "map", "auto"),
    )
    assert small.seconds < named.seconds == every.seconds
    assert estimate_cost(200, (320, 240), "map", None).size_bytes > small.size_bytes
