"""The color code of left and right: one hue a side, wherever it is shown."""

import colorsys

import pytest
from keymark.core.body.human import HUMAN, LIGHT, SHADED, STRONG, side_of
from keymark.core.report import canvas

SAME_HUE = 0.06
"""Of the circle of hues; blue and orange are 0.45 apart."""


def hue(rgb: tuple[int, int, int]) -> float:
    return colorsys.rgb_to_hsv(*(level / 255.0 for level in rgb))[0]


@pytest.mark.parametrize("side", ["L", "R"])
def test_a_side_has_one_hue_in_all_its_strengths(side: str) -> None:
    hues = [hue(strength[side]) for strength in (LIGHT, STRONG, SHADED)]
    assert max(hues) - min(hues) < SAME_HUE
    assert (0.5 < hues[0] < 0.7) == (side == "L")


def test_reports_have_the_same_colors() -> None:
    assert canvas.LEFT[::-1] == STRONG["L"] and canvas.RIGHT[::-1] == STRONG["R"]


def test_every_segment_and_point_has_a_side() -> None:
    assert {side_of(segment.name) for segment in HUMAN.segments} == {"L", "R", ""}
    assert side_of("shoulder.L") == "L" and side_of("head") == "" and side_of("Left.001") == ""
