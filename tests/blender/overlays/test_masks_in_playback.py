"""Masks in playback: made as long as they cost little of a frame's time."""

from types import SimpleNamespace

import pytest
from keymark.operators.overlays.mask import LARGEST_SHARE, Cost


@pytest.mark.parametrize(("share", "is_fast"), [(0.5 * LARGEST_SHARE, True), (2.0 * LARGEST_SHARE, False)])
@pytest.mark.parametrize("fps", [24, 60])
def test_masks_that_slow_playback_down_are_left_out(share: float, is_fast: bool, fps: int) -> None:
    scene = SimpleNamespace(render=SimpleNamespace(fps=fps, fps_base=1.001))
    cost = Cost()
    assert cost.is_fast(scene)
    cost.last_s = share * 1.001 / fps
    assert cost.is_fast(scene) is is_fast
