"""Keypoints over the footage, with a motion and before there is one, without a screen."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from _performances import made_up_keypoints, made_up_review
from keymark.core.review.review import Review
from keymark.operators.follow.evidence import FrameKeypoints
from keymark.operators.overlays import motion
from keymark.operators.overlays.drawing import SOURCES, THROWN_OUT, Label, Stroke, Style
from keymark.operators.overlays.motion import all_sources, compared_marks, not_yet_compared, seen_marks
from keymark.operators.overlays.views import ClipView
from keymark.operators.shell import takes
from keymark.operators.shell.footage_view import FootageView

STYLE = Style(opacity=1.0, scale=1.0)
FOOTAGE = FootageView(None, (160, 120), np.array([10.0, 490.0]), np.array([640.0, -480.0]), None)
VIEW = ClipView(FOOTAGE, np.eye(4), SimpleNamespace(focal_px=400.0))
KEYPOINTS = made_up_keypoints()
ALL = all_sources(KEYPOINTS, ())


def seen_by(source: str, **points: tuple[float, float]) -> FrameKeypoints:
    pixel = np.array([list(points.values())], dtype=np.float64)
    return FrameKeypoints(source, tuple(points), pixel, np.ones(pixel.shape[:2]))


def centers(stroke: Stroke) -> np.ndarray:
    """Middles of the crosses of a stroke, two arms each."""
    return stroke.segments.reshape(-1, 2, 2, 2).mean(axis=(1, 2))


def test_crosses_lie_where_keypoints_are_seen_and_rings_where_the_motion_puts_them() -> None:
    links, rings, crosses, slanting, squares = compared_marks(KEYPOINTS, 0, FOOTAGE.to_region, ALL, STYLE)
    assert centers(crosses) == pytest.approx(FOOTAGE.to_region(KEYPOINTS.seen[0]))
    assert crosses.color[::2, :3].tolist() == [list(SOURCES[i][:3]) for i in (0, 0, 1)]
    assert links.segments[:, 1] == pytest.approx(FOOTAGE.to_region(KEYPOINTS.predicted[0]))
    around = rings.segments.reshape(3, -1, 2).mean(axis=1)
    assert around == pytest.approx(FOOTAGE.to_region(KEYPOINTS.predicted[0]))
    assert len(slanting.segments) == len(squares.segments) == 0


def test_what_is_not_believed_hidden_or_swapped_is_told_by_its_shape() -> None:
    _, _, upright, slanting, _ = compared_marks(KEYPOINTS, 1, FOOTAGE.to_region, ALL, STYLE)
    assert len(centers(upright)) == 2
    assert centers(slanting) == pytest.approx(FOOTAGE.to_region(KEYPOINTS.seen[1, :1]))
    assert slanting.color[0].tolist() == list(THROWN_OUT)
    steps = np.diff(slanting.segments, axis=1)[:, 0]
    assert np.abs(steps[:, 0]) == pytest.approx(np.abs(steps[:, 1]))
    links, _, upright, _, _ = compared_marks(KEYPOINTS, 2, FOOTAGE.to_region, ALL, STYLE)
    assert len(links.segments) == len(centers(upright)) == 2
    links, _, _, _, squares = compared_marks(KEYPOINTS, 4, FOOTAGE.to_region, ALL, STYLE)
    assert len(links.segments) == 3 and len(squares.segments) == 4


def test_only_what_the_motion_does_not_know_yet_is_drawn_beside_it() -> None:
    known = dict(zip(KEYPOINTS.names[:2], KEYPOINTS.seen[0, :2].tolist(), strict=True))
    again = seen_by("a detector", **known)
    assert not_yet_compared([again], KEYPOINTS, 0) == ()
    clicked = seen_by("clicks", **{"wrist.L": (5.0, 6.0)})
    (left,) = not_yet_compared([again, clicked], KEYPOINTS, 0)
    assert left.source == "clicks"
    both = FrameKeypoints(
        "a detector", again.names, np.concatenate([again.pixel, again.pixel + 30.0]), np.ones((2, 2))
    )
    (left,) = not_yet_compared([both], KEYPOINTS, 0)
    assert np.isfinite(left.pixel).all(axis=-1).tolist() == [[False, False], [True, True]]
    (other,) = seen_marks([left], FOOTAGE.to_region, ALL, STYLE)
    assert centers(other) == pytest.approx(FOOTAGE.to_region(both.pixel[1]))


@pytest.fixture
def scene(registered: None, monkeypatch: pytest.MonkeyPatch) -> bpy.types.Scene:
    scene, review = bpy.context.scene, made_up_review()
    take = takes.add_take(scene, "Take")
    monkeypatch.setattr(motion, "review_of", lambda asked: review if asked == take else None)
    return scene


def context_of() -> SimpleNamespace:
    region = SimpleNamespace(x=0, y=0, width=800, height=600, alignment="NONE")
    return SimpleNamespace(area=SimpleNamespace(regions=[region], type="VIEW_3D"), region=region)


def rows(scene: bpy.types.Scene, frame: int) -> list[str]:
    """The legend's words in a frame, from the top down."""
    scene.frame_set(frame)
    items = motion.picture(context_of(), motion.shown(scene), VIEW, scene.keymark.overlays)
    return [item.words for item in items if isinstance(item, Label)][::-1]


def test_the_legend_tells_what_the_frame_shows(scene: bpy.types.Scene) -> None:
    sources = ["Keypoint of a detector", "Keypoint of Blender's tracks", "Where the motion puts it"]
    assert rows(scene, 1)[:3] == sources
    assert rows(scene, 2)[:4] == [*sources, "Keypoint not believed"]
    assert rows(scene, 5)[:4] == [*sources, "Left and right exchanged"]
    scene.keymark.overlays.show_keypoints = False
    assert not any("eypoint" in words for words in rows(scene, 2))


def test_without_markers_the_legend_says_nothing_of_them(
    scene: bpy.types.Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    full = made_up_review().to_arrays()
    none = {name: full[name][:, :0] for name in ("observed", "predicted")}
    weak = {name: full[name][:0] for name in full if name.startswith("weak")}
    bare = Review.from_arrays({**full, **none, **weak, "marker_names": full["marker_names"][:0]})
    monkeypatch.setattr(motion, "review_of", lambda _take: bare)
    assert not any("arker" in words for words in rows(scene, 1))
    assert "Contour as the motion predicts it" in rows(scene, 1)
    scene.keymark.overlays.show_predicted = False
    assert not any("ontour" in words for words in rows(scene, 1))


def test_contours_are_dashed_where_the_motion_puts_them(scene: bpy.types.Scene) -> None:
    review = made_up_review()
    scene.frame_set(1)
    strokes, _ = motion.PARTS["predicted"](motion.shown(scene), VIEW, STYLE)
    strokes = [stroke for stroke in strokes if isinstance(stroke, Stroke)][len(review.marker_names) :]
    whole = np.linalg.norm(np.diff(FOOTAGE.to_region(review.contours[0]), axis=1), axis=-1).sum()
    inked = sum(np.linalg.norm(np.diff(stroke.segments, axis=1), axis=-1).sum() for stroke in strokes)
    assert inked == pytest.approx(0.6 * whole, rel=0.05)


def test_keypoints_are_drawn_before_there_is_a_motion(registered: None) -> None:
    settings = bpy.context.scene.keymark.overlays
    seen = (seen_by("a detector", **{"head": (80.0, 10.0), "ankle.L": (82.0, 100.0)}),)
    items = motion.picture_keypoints(context_of(), seen, FOOTAGE, settings)
    assert centers(items[0]) == pytest.approx(FOOTAGE.to_region(seen[0].pixel[0]))
    assert [item.words for item in items if isinstance(item, Label)] == ["Keypoint of a detector"]
    far = (seen_by("a detector", **{"head": (80.0, 50.0), "ankle.L": (82.0, 60.0)}),)
    small = motion.picture_keypoints(context_of(), far, FOOTAGE, settings)[0]
    assert np.ptp(small.segments[0], axis=0).max() < np.ptp(items[0].segments[0], axis=0).max()
    nobody = (FrameKeypoints("a detector", ("head",), np.full((1, 1, 2), np.nan), np.zeros((1, 1))),)
    assert len(motion.picture_keypoints(context_of(), nobody, FOOTAGE, settings)[0].segments) == 0
