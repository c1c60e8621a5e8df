"""All markers picked by one click each, as a script and as the clicks of a session."""

import bpy
import numpy as np
import pytest
from keymark.core.take.take import Take
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")

USUAL = ["trunk", "forearm.L", "forearm.R", "shin.L", "shin.R"]


@pytest.fixture
def loaded(tiny_take: Take) -> bpy.types.Scene:
    assert bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip)) == {"FINISHED"}
    return bpy.context.scene


def pixel_of(take: Take, segment: str) -> np.ndarray:
    """Where a marker is seen in the first frame [px]."""
    posture = take.keyframes[0].posture
    if segment == "trunk":
        return np.mean([pixel_of(take, "thigh.L"), pixel_of(take, "upper_arm.R")], axis=0)
    ends = take.body.segment_ends(take.body.pose(posture), segment)
    return take.camera.project(np.mean(ends, axis=0))[0]


def clicks(take: Take, *names: str) -> list[dict[str, object]]:
    return [{"name": name, "loc": tuple(pixel_of(take, name)), "time": 1.0} for name in names]


def test_five_clicks_make_the_usual_five(loaded: bpy.types.Scene, tiny_take: Take) -> None:
    loaded.frame_set(9)
    assert bpy.ops.keymark.pick_markers(clicks=clicks(tiny_take, *USUAL)) == {"FINISHED"}
    take = active_take(loaded)
    assert [marker.name for marker in take.markers] == USUAL
    for marker, style in zip(take.markers, tiny_take.markers, strict=True):
        assert (
            np.abs(255.0 * np.array(marker.color) - style.color_srgb).max() < 60.0
        )  # one is in its own shade
        assert marker.has_readout(take) and marker.distinctness > 0.8
    assert take.markers[0].area > 3.0 * take.markers[1].area > 0.0


def test_skipped_markers_stay_without_a_color(loaded: bpy.types.Scene, tiny_take: Take) -> None:
    bpy.ops.keymark.pick_markers(clicks=clicks(tiny_take, "shin.L", "trunk"))
    take = active_take(loaded)
    assert [marker.name for marker in take.markers if marker.is_picked] == ["trunk", "shin.L"]
    before = tuple(take.markers[0].color)
    bpy.ops.keymark.pick_markers(clicks=clicks(tiny_take, "shin.R"))
    assert [marker.is_picked for marker in take.markers] == [True, False, False, True, True]
    assert tuple(take.markers[0].color) == before
    assert [marker.has_readout(take) for marker in take.markers] == [True, False, False, True, True]


def test_a_list_of_its_own_is_kept(loaded: bpy.types.Scene, tiny_take: Take) -> None:
    for segment, name in (("shin.R", "sock"), ("forearm.L", "sleeve")):
        bpy.ops.keymark.add_marker()
        marker = active_take(loaded).markers[-1]
        marker.segment, marker.name = segment, name
    made = [
        {**click, "name": name}
        for click, name in zip(clicks(tiny_take, "shin.R", "forearm.L"), ("sock", "sleeve"), strict=True)
    ]
    bpy.ops.keymark.pick_markers(clicks=made)
    take = active_take(loaded)
    assert [(marker.name, marker.segment) for marker in take.markers] == [
        ("sock", "shin.R"),
        ("sleeve", "forearm.L"),
    ]
    assert all(marker.has_readout(take) for marker in take.markers)


@pytest.mark.parametrize(
    ("made", "sentence"),
    [
        ([], "Clicks is empty"),
        ([{"name": "tail", "loc": (50.0, 50.0), "time": 1.0}], "No marker is called 'tail'"),
        ([{"name": "trunk", "loc": (-4.0, 3.0), "time": 1.0}], "lies outside the footage"),
        ([{"name": "trunk", "loc": (50.0, 50.0), "time": 400.0}], "no frame at scene frame 400"),
    ],
)
def test_clicks_that_cannot_be_used_change_nothing(
    loaded: bpy.types.Scene, made: list[dict[str, object]], sentence: str
) -> None:
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.keymark.pick_markers(clicks=made)
    assert not len(active_take(loaded).markers)
