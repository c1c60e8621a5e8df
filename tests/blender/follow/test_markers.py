"""Markers: adding, picking, checking, and what is drawn of them."""

import shutil
from pathlib import Path
from types import SimpleNamespace

import bpy
import cv2
import numpy as np
import pytest
from keymark.core.errors import InputError
from keymark.core.progress import run
from keymark.core.take.take import Take
from keymark.operators.follow.marker_search import KEYMARK_OT_check_markers
from keymark.operators.follow.mask_previews import clear_previews, is_of_frame, preview_of, update_masks
from keymark.operators.footage.load_footage import update_clip_state
from keymark.operators.overlays.mask import free_height, tinted
from keymark.operators.shell.takes import active_take, add_take, take_by_identifier

pytestmark = pytest.mark.usefixtures("registered")

USUAL = ["trunk", "forearm.L", "forearm.R", "shin.L", "shin.R"]


@pytest.fixture
def loaded(tiny_take: Take) -> bpy.types.Scene:
    assert bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip)) == {"FINISHED"}
    return bpy.context.scene


def test_the_usual_five_are_added_at_once_and_only_where_missing() -> None:
    bpy.ops.keymark.add_usual_markers()
    take = active_take(bpy.context.scene)
    assert [marker.segment for marker in take.markers] == USUAL
    assert take.active_marker == 0 and not any(marker.is_picked for marker in take.markers)
    take.active_marker = 2
    bpy.ops.keymark.remove_marker()
    bpy.ops.keymark.add_usual_markers()
    assert sorted(marker.name for marker in take.markers) == sorted(USUAL)
    assert take.markers[take.active_marker].segment == "forearm.R"
    assert bpy.ops.keymark.add_usual_markers() == {"CANCELLED"}


def test_a_name_follows_its_segment_until_it_is_changed() -> None:
    bpy.ops.keymark.add_marker()
    (marker,) = active_take(bpy.context.scene).markers
    marker.segment = "foot.L"
    assert marker.name == "foot.L"
    marker.name = "sock"
    marker.segment = "foot.R"
    assert marker.name == "sock"


def test_a_pick_gives_the_active_marker_its_color_and_leaves_the_others(
    opened: bpy.types.Scene, tiny_take: Take
) -> None:
    take = active_take(opened)
    before = [tuple(marker.color) for marker in take.markers]
    take.active_marker = 3
    take.markers[3].color = (0.0, 0.0, 0.0)
    bpy.ops.keymark.pick_marker_color(pixel=pixel_of(tiny_take, "shin.L"))
    assert np.abs(np.array(take.markers[3].color) - before[3]).max() < 0.15
    assert [tuple(marker.color) for marker in take.markers if marker.name != "shin.L"] == [
        *before[:3],
        before[4],
    ]
    assert all(marker.has_readout(take) for marker in take.markers)


def test_the_eyedropper_beside_a_row_picks_that_marker_alone(
    opened: bpy.types.Scene, tiny_take: Take
) -> None:
    take = active_take(opened)
    before = [tuple(marker.color) for marker in take.markers]
    take.markers[1].color, take.active_marker = (0.0, 0.0, 0.0), 4
    bpy.ops.keymark.pick_marker_color(pixel=pixel_of(tiny_take, "forearm.L"), row=1)
    assert np.abs(np.array(take.markers[1].color) - before[1]).max() < 0.15
    assert tuple(take.markers[4].color) == before[4] and len(take.markers) == 5
    take.markers.clear()
    with pytest.raises(RuntimeError, match="Add the markers"):
        bpy.ops.keymark.pick_marker_color(pixel=pixel_of(tiny_take, "shin.L"))
    assert not len(take.markers)


def test_a_pick_outside_changes_nothing(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    before = [(marker.name, tuple(marker.color), marker.sampled) for marker in take.markers]
    with pytest.raises(RuntimeError, match="lies outside the footage"):
        bpy.ops.keymark.pick_marker_color(pixel=(-4.0, 3.0))
    assert [(marker.name, tuple(marker.color), marker.sampled) for marker in take.markers] == before


def test_a_check_reads_out_all_markers_and_warns_of_those_that_go_wrong(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    take.markers[1].color = (0.1, 0.95, 0.9)
    take.markers[4].color = take.markers[3].color
    assert bpy.ops.keymark.check_markers() == {"FINISHED"}
    trunk, nowhere, right, *twins = take.markers
    assert (nowhere.found, nowhere.area, nowhere.distinctness) == (0, 0.0, 0.0)
    assert "matches nothing in the clip" in nowhere.warning
    assert trunk.found == right.found == 13 and not trunk.warning
    assert "almost the same color as shin.R" in twins[0].warning
    assert "almost the same color as shin.L" in twins[1].warning


def test_a_readout_is_never_stale(opened: bpy.types.Scene) -> None:
    take = active_take(opened)

    def checked() -> bool:
        return all(marker.has_readout(take) for marker in take.markers)

    assert not checked()
    bpy.ops.keymark.check_markers()
    assert checked()
    take.markers[2].color = (0.2, 0.3, 0.9)
    assert not any(marker.has_readout(take) for marker in take.markers)
    bpy.ops.keymark.check_markers()
    take.markers[0].name = "body"
    assert not checked()
    bpy.ops.keymark.check_markers()
    bpy.ops.keymark.add_marker()
    assert [marker.has_readout(take) for marker in take.markers] == [True] * 5 + [False]
    bpy.ops.keymark.remove_marker()
    assert checked()
    bpy.ops.keymark.remove_marker()
    assert not checked()
    bpy.ops.keymark.check_markers()
    take.clip = None
    assert not checked()


def test_markers_without_a_color_are_left_out_of_a_check(loaded: bpy.types.Scene, tiny_take: Take) -> None:
    bpy.ops.keymark.add_usual_markers()
    take = active_take(loaded)
    with pytest.raises(RuntimeError, match="Pick the color of a marker first"):
        bpy.ops.keymark.check_markers()
    take.active_marker = 1
    bpy.ops.keymark.pick_marker_color(pixel=pixel_of(tiny_take, "forearm.L"))
    bpy.ops.keymark.check_markers()
    assert [marker.has_readout(take) for marker in take.markers] == [False, True, False, False, False]


def test_masks_are_made_of_the_frame_that_is_shown(opened: bpy.types.Scene, tiny_take: Take) -> None:
    clear_previews()
    take = active_take(opened)
    assert update_masks(opened) is None
    bpy.ops.keymark.check_markers()
    opened.frame_set(1)
    first = update_masks(opened).masks
    assert [mask.label for mask in first] == USUAL and first[0].coverage.shape == (120, 160)
    for mask, marker in zip(first, take.markers, strict=True):
        assert float(mask.coverage.sum()) == pytest.approx(marker.area, rel=0.4)
    arm = first[1].outlines[0].mean(axis=0)
    assert np.linalg.norm(arm - pixel_of(tiny_take, "forearm.L")) < 6.0
    opened.frame_set(13)
    assert np.linalg.norm(update_masks(opened).masks[1].outlines[0].mean(axis=0) - arm) > 10.0
    opened.frame_set(40)
    assert update_masks(opened).masks == ()
    take.markers[0].color = (0.9, 0.1, 0.1)
    assert preview_of(take) is None


def test_showing_masks_looks_for_the_colors_first(opened: bpy.types.Scene) -> None:
    clear_previews()
    assert bpy.ops.keymark.show_masks() == {"FINISHED"}
    assert bpy.context.window_manager.keymark_show_masks
    assert len(preview_of(active_take(opened)).masks) == 5
    bpy.ops.keymark.show_masks()
    assert not bpy.context.window_manager.keymark_show_masks


def test_everything_but_the_masks_is_darkened(opened: bpy.types.Scene) -> None:
    bpy.ops.keymark.check_markers()
    masks = update_masks(opened).masks
    picture = tinted(masks)
    trunk = masks[0].coverage == 1.0
    assert picture.shape == (120, 160, 4) and trunk.any()
    assert picture[trunk][:, :3] == pytest.approx(np.broadcast_to(masks[0].color, (trunk.sum(), 3)), abs=1e-5)
    assert tuple(picture[0, 0, :3]) == (0.0, 0.0, 0.0) and 0.0 < picture[0, 0, 3] < picture[trunk][0, 3]


def test_names_move_up_past_those_that_are_there() -> None:
    taken = [(0.0, 10.0, 50.0, 8.0), (20.0, 18.0, 50.0, 8.0), (200.0, 0.0, 10.0, 99.0)]
    assert free_height((10.0, 12.0, 40.0, 8.0), taken) == 26.0
    assert free_height((80.0, 12.0, 40.0, 8.0), taken) == 12.0
    assert free_height((10.0, 40.0, 40.0, 8.0), taken) == 40.0


def test_what_was_looked_for_is_stored_with_the_markers_it_was_looked_for(opened: bpy.types.Scene) -> None:
    job = SimpleNamespace(pixel=(80.0, 60.0), report=lambda *_: None)
    operator = KEYMARK_OT_check_markers
    first = active_take(opened).identifier
    found = run(operator.start(job, opened))
    add_take(opened, "Other")
    operator.finish(job, opened, found)
    assert all(
        marker.has_readout(take_by_identifier(opened, first))
        for marker in take_by_identifier(opened, first).markers
    )
    assert not len(active_take(opened).markers)
    take_by_identifier(opened, first).markers[2].color = (0.2, 0.2, 0.9)
    with pytest.raises(InputError, match="changed while they were looked for"):
        operator.finish(job, opened, found)
    assert not take_by_identifier(opened, first).markers[0].has_readout(take_by_identifier(opened, first))


def test_without_all_colors_nothing_is_reconstructed(opened: bpy.types.Scene) -> None:
    bpy.ops.keymark.add_marker()
    for operator in ("reconstruct", "propose_keyframes"):
        with pytest.raises(RuntimeError, match="Pick the colors of all markers first"):
            getattr(bpy.ops.keymark, operator)()


def test_a_clip_that_was_replaced_on_disk_is_looked_at_again(opened: bpy.types.Scene, tmp_path: Path) -> None:
    take = active_take(opened)
    clip = tmp_path / "clip.mp4"
    shutil.copy(bpy.path.abspath(take.clip.filepath), clip)
    take.clip.filepath = str(clip)
    bpy.ops.keymark.check_markers()
    assert take.markers[0].found == 13
    first = preview_of(take)
    writer = cv2.VideoWriter(str(clip), cv2.VideoWriter_fourcc(*"mp4v"), 25.0, (160, 120))
    for _ in range(13):
        writer.write(np.full((120, 160, 3), 90, np.uint8))
    writer.release()
    update_clip_state(take)
    assert not take.markers[0].has_readout(take) and preview_of(take) is None
    bpy.ops.keymark.check_markers()
    assert take.markers[0].has_readout(take) and take.markers[0].found == 0
    assert preview_of(take) is not None is not first


def test_masks_follow_a_clip_that_is_moved_in_time(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    bpy.ops.keymark.check_markers()
    opened.frame_set(5)
    before = update_masks(opened).masks
    assert update_masks(opened).masks is before
    take.clip.frame_start += 4
    assert not is_of_frame(preview_of(take), opened)
    assert update_masks(opened).masks is not before


def test_another_clip_leaves_nothing_of_the_one_before(opened: bpy.types.Scene, tmp_path: Path) -> None:
    take = active_take(opened)
    bpy.ops.keymark.propose_keyframes()
    take.method = "interpolation"
    bpy.ops.keymark.reconstruct()
    take.clip = take.clip
    assert take.reading_key and take.review_key and len(take.proposals) and take.review.frame_count == 13
    other = tmp_path / "other.mp4"
    shutil.copy(bpy.path.abspath(take.clip.filepath), other)
    with other.open("ab") as file:
        file.write(bytes(64))
    take.clip = bpy.data.movieclips.load(str(other))
    assert not take.reading_key and not take.review_key
    assert not len(take.proposals) and take.review.frame_count == 0 and not len(take.review.weak_frames)
    assert take.motion_action is not None and take.keyframe_action is not None


def test_masks_that_cannot_be_made_are_not_switched_on(opened: bpy.types.Scene, tmp_path: Path) -> None:
    clear_previews()
    active_take(opened).clip.filepath = str(tmp_path / "gone.mp4")
    with pytest.raises(RuntimeError, match="the footage is not there") as caught:
        bpy.ops.keymark.show_masks()
    assert "Traceback" not in str(caught.value)
    assert not bpy.context.window_manager.keymark_show_masks


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
