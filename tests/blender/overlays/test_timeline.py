"""The timeline overlay as arrays and items; draw handlers in Blender, and their failures."""

from dataclasses import replace
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from _performances import made_up_review
from keymark.core.errors import InputError
from keymark.core.markers.reading import Reading
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.take.take import Take
from keymark.operators.overlays import registry
from keymark.operators.overlays.drawing import Fill, Label, Stroke
from keymark.operators.overlays.registry import Overlay, guarded
from keymark.operators.overlays.timeline import (
    MODES,
    ROOMY,
    SLIM,
    Timeline,
    confidence_strip,
    in_view,
    picture,
    relative,
    speed_graph,
)
from keymark.operators.shell.results import keep_reading, keep_review, keep_speed
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")

VIEW = Timeline(origin=20.0, scale=10.0, width=200.0, height=60.0, pixel=1.0, sizes=ROOMY)


@pytest.fixture
def take(tiny_take: Take) -> bpy.types.PropertyGroup:
    bpy.ops.keymark.open_take(filepath=str(tiny_take.folder / "take.json"))
    return active_take(bpy.context.scene)


def reading(frames: int = 13) -> Reading:
    """One marker that stands still, jumps by five pixels in the middle and stands again."""
    centroid = np.zeros((frames, 1, 2))
    centroid[frames // 2 :, 0, 0] = 5.0
    ones = np.ones((frames, 1))
    second = np.broadcast_to(np.eye(2), (frames, 1, 2, 2))
    tracks = RegionTracks(
        ("trunk",), centroid, second, ones, ones, ones > 1.0, np.arange(frames) / 25.0, (160, 120)
    )
    return Reading(tracks, key="reading-of-this-test")


def items_of(take: bpy.types.PropertyGroup, kind: type, view: Timeline = VIEW) -> list:
    return [item for item in picture(bpy.context.scene, take, view) if isinstance(item, kind)]


def test_a_take_of_which_nothing_is_known_draws_nothing(take: bpy.types.PropertyGroup) -> None:
    assert picture(bpy.context.scene, take, VIEW) == []


def test_proposals_are_filled_once_posed(take: bpy.types.PropertyGroup) -> None:
    for frame in (1, 4, 7):
        take.proposals.add().frame = frame
    (outline,), (filled,) = items_of(take, Stroke), items_of(take, Fill)
    assert len(outline.segments) == 3 * 4
    assert filled.corners.mean(axis=1)[:, 0] == pytest.approx([30.0, 90.0])
    assert [TakeState(take).is_posed(frame) for frame in (1.0, 4.0, 7.4)] == [True, False, True]


def test_the_graph_rises_where_the_markers_move(take: bpy.types.PropertyGroup) -> None:
    keep_reading(take, reading())
    area = items_of(take, Fill)[0]
    heights = area.corners[:, 3, 1] - VIEW.floor
    assert heights.argmax() in (5, 6) and heights.max() <= VIEW.height and heights[0] < 1.0
    assert [label.words for label in items_of(take, Label)] == ["Speed in the footage"]
    take.proposals.add().frame = 7
    *_, diamond = items_of(take, Fill)
    assert diamond.corners[0, :, 1].mean() - VIEW.floor > 0.5 * VIEW.height
    assert items_of(take, Label, replace(VIEW, sizes=SLIM)) == []


def test_without_markers_the_graph_is_the_speed_that_keyframes_were_proposed_by(
    take: bpy.types.PropertyGroup,
) -> None:
    bare = reading()
    tracks = RegionTracks.unmarked(bare.tracks.time_s, (160, 120))
    keep_reading(take, Reading(tracks, key="reading-of-no-marker"))
    assert items_of(take, Fill) == []
    keep_review(take, made_up_review())
    reviewed = items_of(take, Fill)[0].corners[:, 3, 1]
    assert len(reviewed) == 12 and reviewed.argmax() in (5, 6)
    rising = np.arange(13.0)
    keep_speed(take, rising + 1.0, rising)
    assert np.all(np.diff(items_of(take, Fill)[0].corners[:, 3, 1]) > 0.0)


def test_confidence_is_told_by_height_and_color(take: bpy.types.PropertyGroup) -> None:
    keep_review(take, made_up_review())
    *_, ground, bars = items_of(take, Fill)
    heights = bars.corners[:, 2, 1] - bars.corners[:, 1, 1]
    assert heights == pytest.approx(ROOMY.strip * made_up_review().confidence)
    (across, up), reach = ground.corners[0].T, (VIEW.frame_x([0.5]), VIEW.frame_x([13.5]))
    assert (across.min(), across.max()) == (pytest.approx(reach[0]), pytest.approx(reach[1]))
    assert np.ptp(up) == pytest.approx(ROOMY.strip)
    assert bars.color[0, 2] > bars.color[6, 2] and bars.color[6, 0] > bars.color[0, 0]
    keep_review(take, replace(made_up_review(), confidence=np.full(13, np.nan)))
    assert len(items_of(take, Fill)) == 1  # the speed


def test_weak_frames_point_until_they_are_posed(take: bpy.types.PropertyGroup) -> None:
    for frame in (4.0, 9.0):
        take.review.weak_frames.add().frame = frame
    assert len(items_of(take, Fill)[0].corners) == 2
    take.review.weak_frames[0].frame = 7.0  # where a keyframe is
    (triangle,) = items_of(take, Fill)[0].corners
    assert triangle[0, 0] == pytest.approx(110.0) and triangle[0, 1] < triangle[1:, 1].min()


def test_a_long_clip_is_drawn_no_finer_than_can_be_seen_and_no_further() -> None:
    x, values = np.linspace(0.0, 300.0, 3000), np.full(3000, 0.9)
    values[1234] = 0.1
    places, lowest = in_view(x, values, 300.0, np.fmin)
    assert len(places) <= 201 and lowest.min() == 0.1
    assert in_view(x, values, 300.0, np.fmax)[1].min() == 0.9
    assert len(in_view(x[:10] * 100.0, values[:10], 300.0, np.fmin)[0]) == 10
    shown, _ = in_view(np.arange(-100.0, 500.0, 10.0), np.zeros(60), 200.0, np.fmin)
    assert (shown[0], shown[-1]) == (-10.0, 200.0)


def test_figures_keep_gaps_and_their_range() -> None:
    frames, values = np.arange(5.0), np.array([0.5, np.nan, 1.0, -1.0, 0.75])
    _, bars = confidence_strip(frames, values, VIEW)
    assert np.isnan(bars.corners).any((1, 2)).tolist() == [False, True, False, False, False]
    assert bars.color.min() >= 0.0 and bars.color.max() <= 1.0
    area, *_ = speed_graph(frames, values, VIEW)
    assert np.isnan(area.corners).any((1, 2)).tolist() == [True, True, False, False]
    heights = relative(np.array([0.0, 1.0, 1.0, 50.0, np.nan]))
    assert np.nanmax(heights) <= 1.0 and np.isnan(heights[-1])


def test_the_editors_modes_exist() -> None:
    known = {item.identifier for item in bpy.types.SpaceDopeSheetEditor.bl_rna.properties["mode"].enum_items}
    assert set(MODES) - {"TIMELINE"} <= known


@pytest.fixture(autouse=True)
def blending(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    modes: list[str] = []
    monkeypatch.setattr(registry, "gpu", SimpleNamespace(state=SimpleNamespace(blend_set=modes.append)))
    registry.FAILURES.clear()
    return modes


@pytest.mark.parametrize(
    ("error", "calls", "said"),
    [
        (ValueError("no such marker"), 1, "no such marker"),
        (ValueError(), 1, "ValueError"),
        (InputError("camera 'Camera' is of type ORTHO; footage needs a perspective one"), 2, None),
    ],
)
def test_an_unexpected_failure_alone_is_logged_and_switches_that_overlay_off(
    caplog: pytest.LogCaptureFixture, blending: list[str], error: Exception, calls: int, said: str | None
) -> None:
    drawn: list[bpy.types.Context] = []

    def draw(context: bpy.types.Context) -> tuple[()]:
        drawn.append(context)
        raise error

    handler = guarded(Overlay("Broken", draw, "SpaceView3D"))
    handler()
    handler()
    assert len(drawn) == calls and blending == ["ALPHA", "NONE"] * calls
    assert list(registry.FAILURES.values()) == ([said] if said else [])
    assert len(caplog.records) == bool(said) == ("'Broken' failed" in caplog.text)
    registry.FAILURES.clear()
    handler()
    guarded(Overlay("Sound", lambda context: drawn.append(context) or (), "SpaceView3D"))()
    assert len(drawn) == calls + 2


def test_what_is_not_dragged_is_hidden_meanwhile(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[bpy.types.Context] = []
    handlers = [
        guarded(Overlay("Any", lambda context: calls.append(context) or (), "SpaceView3D", correcting))
        for correcting in (True, False)
    ]
    for handler in handlers:
        handler()
    assert len(calls) == 2
    monkeypatch.setattr(registry, "job_is_running", lambda _context, job: job == "keymark.drag_joints")
    for handler in handlers:
        handler()
    assert len(calls) == 3


def test_every_overlay_can_be_handed_to_blender() -> None:
    for each in registry.OVERLAYS:
        space = getattr(bpy.types, each.space)
        handler = space.draw_handler_add(guarded(each), (), "WINDOW", "POST_PIXEL")
        assert handler is not None, each
        space.draw_handler_remove(handler, "WINDOW")
        with pytest.raises(ValueError):  # it is gone
            space.draw_handler_remove(handler, "WINDOW")


def test_without_a_screen_no_handler_is_added() -> None:
    registry.register()
    assert registry._handlers == []
    registry.unregister()
