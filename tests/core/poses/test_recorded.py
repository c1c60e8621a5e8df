"""Corrected poses, number by number; what is found for clips is so in their own tests."""

import numpy as np
import pytest
from _performances import BODY as CORRECTED
from _performances import camera_around, natural_posture, points
from _recorded import assert_recorded
from keymark.core.body.human import LIMBS, TRUNK
from keymark.core.poses.depth_flip import flipped
from keymark.core.poses.dragged import dragged
from keymark.core.poses.turned import Facing, Sides, turned


@pytest.mark.parametrize("seed", [3])
def test_corrections(seed: int) -> None:
    posture, seen_by = natural_posture(seed), camera_around(seed + 100)
    ways = [one for part in (TRUNK, *LIMBS) for one in flipped(CORRECTED, posture, seen_by, part)]
    assert_recorded(f"flipped {seed}", *map(points, ways), share=1e-3)
    for sides in Sides:
        ways = [turned(CORRECTED, posture, seen_by, facing, sides).posture for facing in Facing]
        assert_recorded(f"turned {seed} {sides.name}", *map(points, ways), share=1e-3)
    names = CORRECTED.skeleton.point_names
    step = np.random.default_rng(seed).normal(0.0, 0.12, (len(names), 3))
    moved = []
    for row, name in enumerate(names):
        place = points(posture)[row] + step[row]
        moved.append(dragged(CORRECTED, posture, name, place, seen_by.sight(place), row % 2 == 0))
    assert_recorded(f"dragged {seed}", *map(points, moved), share=1e-3)
