"""The bone under the mouse: the nearest, of those over each other the one in front, and none far away."""

import bpy
import numpy as np
import pytest
from keymark.operators.character.pick_bone import is_visible, nearest_segment

ENDS = np.array([[[0.0, 0.0], [100.0, 0.0]], [[0.0, 50.0], [100.0, 50.0]], [[50.0, 0.0], [50.0, 0.0]]])
"""Two bones across, and one seen along its length."""


@pytest.mark.parametrize(
    ("point", "depths", "found"),
    [
        ((20.0, 10.0), (1.0, 1.0, 1.0), 0),
        ((20.0, 45.0), (1.0, 1.0, 1.0), 1),
        ((130.0, 0.0), (1.0, 1.0, 1.0), None),
        ((115.0, 48.0), (1.0, 1.0, 1.0), 1),
        ((50.0, 1.0), (2.0, 1.0, 1.5), 2),
        ((50.0, 1.0), (1.0, 1.0, 1.5), 0),
    ],
)
def test_the_nearest_bone_is_found(
    point: tuple[float, float], depths: tuple[float, ...], found: int | None
) -> None:
    assert nearest_segment(np.array(point), ENDS, np.array(depths), 25.0) == found


def test_hidden_bones_are_not_picked(registered: None, rig: bpy.types.Object) -> None:
    bones, posed = rig.data.bones, rig.pose.bones
    assert is_visible(posed["head"])
    hidden, shown = (rig.data.collections.new(name) for name in ("Hidden", "Shown"))
    hidden.assign(bones["head"])
    hidden.is_visible = False
    assert not is_visible(posed["head"])
    shown.assign(bones["head"])
    assert is_visible(posed["head"])
    holder = posed["head"] if hasattr(posed["head"], "hide") else bones["head"]
    holder.hide = True
    assert not is_visible(posed["head"])
