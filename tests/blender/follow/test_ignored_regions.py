"""Regions of the picture that are never a marker: brushed, proposed, removed, saved, and respected."""

import json
from pathlib import Path

import bpy
import cv2
import numpy as np
import pytest
from keymark.core.markers.ignored_regions import IgnoredRegion
from keymark.core.progress import run
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take
from keymark.operators.bridge.take_from_scene import read_scene_take
from keymark.operators.follow.evidence import scene_evidence
from keymark.operators.follow.marker_tools import Brush
from keymark.operators.follow.mask_previews import ignored_mask, preview_of, update_masks
from keymark.operators.follow.properties import add_ignored_regions, ignored_regions
from keymark.operators.overlays.mask import hatched
from keymark.operators.shell.takes import active_take, footage_of

pytestmark = pytest.mark.usefixtures("registered")

FRAMES = 24
SIZE = (160, 120)
SLEEVE, PANEL = (40, 60, 200), (12, 70, 52, 110)
"""Blue, green, red of a sleeve; a panel of the same color, left, top, right, bottom."""


@pytest.fixture
def cluttered(tmp_path: Path) -> bpy.types.Scene:
    """A clip of a sleeve that moves past a panel of its very color, picked."""
    folder = tmp_path / "frames"
    folder.mkdir()
    rng = np.random.default_rng(1)
    for index in range(FRAMES):
        image = np.full((SIZE[1], SIZE[0], 3), (180, 190, 200), dtype=np.uint8)
        left, top, right, bottom = PANEL
        image[top:bottom, left:right] = SLEEVE
        x, y = place(index)
        cv2.ellipse(image, (round(x), round(y)), (12, 6), 0, 0, 360, SLEEVE, -1)
        noisy = np.clip(image + rng.normal(0.0, 2.0, image.shape), 0, 255).astype(np.uint8)
        cv2.imwrite(str(folder / f"{index + 1:04d}.png"), noisy)
    bpy.ops.keymark.load_footage(filepath=str(folder / "0001.png"))
    bpy.context.scene.frame_set(1)
    bpy.ops.keymark.add_marker()
    active_take(bpy.context.scene).markers[0].segment = "forearm.L"
    assert bpy.ops.keymark.pick_marker_color(pixel=place(0)) == {"FINISHED"}
    return bpy.context.scene


def place(index: int) -> tuple[float, float]:
    return 24.0 + 4.5 * index, 30.0


def brush(radius: float = 8.0) -> None:
    left, top, right, bottom = PANEL
    path = [
        {"name": "", "loc": (x, y), "time": float(row)}
        for row, y in enumerate(range(top, bottom + 1, 8))
        for x in (left, right)
    ]
    assert bpy.ops.keymark.ignore_region(path=path, radius=radius) == {"FINISHED"}


def test_a_brushed_panel_is_gone_from_masks_and_readouts(cluttered: bpy.types.Scene) -> None:
    take = active_take(cluttered)
    (sleeve,) = take.markers
    assert "stays still" in sleeve.warning and len(sleeve.still_areas)
    before = update_masks(cluttered).masks[0].coverage
    brush()
    assert [region.name for region in take.ignored_regions][:2] == ["Brushed", "Brushed.001"]
    assert sleeve.has_readout(take) and sleeve.warning == "" and not len(sleeve.still_areas)
    assert sleeve.found == sleeve.sampled and sleeve.area == pytest.approx(np.pi * 12 * 6, rel=0.2)
    after = update_masks(cluttered).masks[0].coverage
    left, top, right, bottom = PANEL
    assert before[top:bottom, left:right].mean() > 0.9 and not after[top:bottom, left:right].any()
    assert after[30, 24] > 0.9


def test_still_areas_are_left_out_by_one_click(cluttered: bpy.types.Scene) -> None:
    assert bpy.ops.keymark.ignore_still_areas() == {"FINISHED"}
    (region,) = ignored_regions(active_take(cluttered))
    np.testing.assert_allclose(region.box, PANEL, atol=4.0)
    assert active_take(cluttered).ignored_regions[0].name == "Still Area"
    with pytest.raises(RuntimeError, match="no still area of a marker"):
        bpy.ops.keymark.ignore_still_areas()


def test_a_removed_region_is_searched_again(cluttered: bpy.types.Scene) -> None:
    bpy.ops.keymark.ignore_still_areas()
    take = active_take(cluttered)
    bpy.ops.keymark.remove_ignored_region()
    assert not len(take.ignored_regions) and not take.markers[0].has_readout(take)
    assert preview_of(take) is not None  # of the markers as they were first checked
    with pytest.raises(RuntimeError, match="No region of the picture is left out"):
        bpy.ops.keymark.remove_ignored_region()


def test_a_region_may_count_in_some_frames_only(cluttered: bpy.types.Scene) -> None:
    take = active_take(cluttered)
    bpy.ops.keymark.ignore_still_areas()
    (region,) = take.ignored_regions
    assert (region.first_frame, region.last_frame) == (1, FRAMES)
    assert take.markers[0].has_readout(take)
    region.some_frames = True
    assert not take.markers[0].has_readout(take)
    region.first_frame, region.last_frame = 5, 8
    assert ignored_regions(take)[0].frames == (4, 7)
    take.clip.frame_start = 11
    assert (region.first_frame, region.last_frame) == (15, 18)
    shown = []
    for frame in (14, 15, 18, 19):
        cluttered.frame_set(frame)
        shown.append(ignored_mask(take) is not None)
    assert shown == [False, True, True, False]
    region.first_frame = 30
    assert region.last_frame == 30


def test_a_path_that_cannot_be_used_is_refused(cluttered: bpy.types.Scene) -> None:
    with pytest.raises(RuntimeError, match="Path is empty"):
        bpy.ops.keymark.ignore_region()
    assert not len(active_take(cluttered).ignored_regions)


def test_regions_go_into_the_take_and_come_back(
    opened: bpy.types.Scene, tiny_take: Take, tmp_path: Path
) -> None:
    said = (
        IgnoredRegion(box=(1.0, 2.5, 30.0, 40.0)),
        IgnoredRegion(stroke=((5.1, 5.0), (9.5, 7.2)), radius_px=4.3, frames=(2, 5)),
    )
    take = active_take(opened)
    add_ignored_regions(take, said)
    assert ignored_regions(take) == said
    assert bpy.ops.keymark.save_take(directory=str(tmp_path / "saved")) == {"FINISHED"}
    assert read_take(tmp_path / "saved").ignored_regions == said
    written = json.loads((tmp_path / "saved" / "take.json").read_text(encoding="utf-8"))
    assert written["ignored_regions"][1]["frames"] == [3, 6]
    assert bpy.ops.keymark.open_take(filepath=str(tmp_path / "saved" / "take.json")) == {"FINISHED"}
    assert ignored_regions(active_take(bpy.context.scene)) == said


def test_a_scenes_take_has_its_regions_while_markers_are_followed(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    add_ignored_regions(take, (IgnoredRegion(box=(1.0, 2.5, 30.0, 40.0)),))
    footage = footage_of(opened, take)

    def read() -> Take:
        return run(read_scene_take(footage, take.armature, take.keyframe_action, scene_evidence(take)))[0]

    assert read().ignored_regions == ignored_regions(take)
    take.follow.use_markers = False
    assert read().ignored_regions == ()


def test_a_brush_keeps_what_can_be_seen_of_a_path(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("keymark.core.markers.ignored_regions.MOST_POINTS", 20)
    tool = Brush(200)
    assert tool.radius_px == 6.0
    tool.press((10.0, 10.0))
    for step in range(100):
        tool.move((10.0 + 0.5 * step, 10.0))
    points = [len(region.stroke) for region in tool.regions()]
    assert len(points) == 2 and max(points) == 20
    assert tool.regions()[1].stroke[0] == tool.regions()[0].stroke[-1]
    tool.grow(100)
    assert tool.radius_px == 100.0
    tool.grow(-100)
    assert tool.radius_px == 1.0


def test_what_is_ignored_is_hatched_and_nothing_else() -> None:
    mask = np.zeros((30, 40), dtype=np.uint8)
    mask[10:20, 10:30] = 255
    picture = hatched(mask)
    assert not picture[mask == 0].any()
    inside = picture[mask > 0]
    assert (inside[:, 3] > 0.5).all() and set(inside[:, 0].tolist()) == {0.0, 1.0}
