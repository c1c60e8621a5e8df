"""Items of the motion overlays, and of keypoints with a motion and before there is one, without a screen."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from _performances import made_up_keypoints, made_up_review
from bpy_extras.view3d_utils import location_3d_to_region_2d
from keymark.core.body.human import HUMAN
from keymark.core.review.review import Review
from keymark.operators.follow.evidence import FrameKeypoints
from keymark.operators.overlays import motion
from keymark.operators.overlays.drawing import (
    SMALLEST,
    SOURCES,
    THROWN_OUT,
    Fill,
    Label,
    Stroke,
    Style,
    body_scale,
    merged,
)
from keymark.operators.overlays.legend import Sample, corner, legend
from keymark.operators.overlays.motion import (
    all_sources,
    compared_marks,
    not_yet_compared,
    paths,
    seen_marks,
    skeleton,
    window,
)
from keymark.operators.overlays.views import ClipView, world_view
from keymark.operators.shell import results, takes
from keymark.operators.shell.footage_view import FootageView
from mathutils import Matrix, Vector

FRAMES = 40
STYLE = Style(opacity=1.0, scale=1.0)
FOOTAGE = FootageView(None, (320, 240), np.array([10.0, 490.0]), np.array([640.0, -480.0]), None)
CAMERA_VIEW = ClipView(FOOTAGE, np.eye(4), SimpleNamespace(focal_px=400.0))


@pytest.fixture
def review() -> Review:
    rng = np.random.default_rng(4)
    turn = np.linspace(0.0, 2.0 * np.pi, 32, endpoint=False)
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    centers = rng.uniform(80.0, 160.0, (FRAMES, 2, 1, 2))
    observed = centers + 10.0 * ring
    observed[10:, 1] = np.nan
    points = rng.uniform(-0.5, 0.5, (FRAMES, 13, 3)) - [0.0, 0.0, 4.0]
    sigma = np.full((FRAMES, 13), 0.02)
    sigma[:, HUMAN.point_names.index("head")] = 0.09
    return Review(
        frames=np.arange(FRAMES) + 5.0,
        size=(320, 240),
        marker_names=("trunk", "shin.L"),
        point_names=HUMAN.point_names,
        observed=observed,
        predicted=centers + 12.0 * ring,
        points=points,
        image_points=np.array([160.0, 120.0]) + 400.0 * points[..., :2] / 4.0,
        sigma_m=sigma,
        speed=np.ones(FRAMES),
        confidence=np.ones(FRAMES),
        keyframe_indices=np.array([0, 12, 39]),
        weak_frames=(),
        contours=np.zeros((FRAMES, 0, 4, 2)),
        keypoints=made_up_keypoints(FRAMES),
        unsure=np.arange(FRAMES)[:, None] == [9, 9, 10],
    )


@pytest.fixture
def scene(registered: None, review: Review, monkeypatch: pytest.MonkeyPatch) -> bpy.types.Scene:
    scene = bpy.context.scene
    take = takes.add_take(scene, "Take")
    for name, color in (("shin.L", (1.0, 0.0, 0.0)), ("trunk", (0.0, 1.0, 0.0))):
        marker = take.markers.add()
        marker.name, marker.color = name, color
    monkeypatch.setattr(motion, "review_of", lambda asked: review if asked == take else None)
    return scene


def drawn(scene: bpy.types.Scene, view: ClipView = CAMERA_VIEW) -> list:
    """Everything that is drawn at the scene's frame."""
    region = SimpleNamespace(x=0, y=0, width=800, height=600, alignment="NONE")
    context = SimpleNamespace(area=SimpleNamespace(regions=[region], type="VIEW_3D"), region=region)
    return motion.picture(context, motion.shown(scene), view, scene.keymark.overlays)


def words(items: list) -> list[str]:
    return [item.words for item in items if isinstance(item, Label)]


def switch(scene: bpy.types.Scene, *on: str) -> None:
    settings = scene.keymark.overlays
    for part in ("observed", "predicted", "keypoints", "skeleton", "paths", "legend"):
        setattr(settings, f"show_{part}", part in on)


def test_the_frame_that_the_scene_shows_is_drawn(scene: bpy.types.Scene) -> None:
    scene.frame_set(5)
    assert motion.shown(scene).index == 0
    scene.frame_set(20, subframe=0.4)
    assert motion.shown(scene).index == 15
    scene.frame_set(4)
    assert motion.shown(scene) is None
    scene.frame_set(45)
    assert motion.shown(scene) is None


def test_outlines_have_their_markers_colors_and_lie_on_the_footage(scene: bpy.types.Scene) -> None:
    switch(scene, "observed")
    scene.frame_set(5)
    first, second = drawn(scene)
    assert first.color[:3] == (0.0, 1.0, 0.0)
    assert second.color[:3] == (1.0, 0.0, 0.0)
    what = motion.shown(scene)
    center = what.review.observed[0, 0].mean(axis=0)
    assert first.segments.mean(axis=(0, 1)) == pytest.approx([10 + 2 * center[0], 490 - 2 * center[1]])


def test_a_hidden_marker_is_named_where_it_is_predicted(scene: bpy.types.Scene) -> None:
    switch(scene, "observed", "predicted", "legend")
    scene.frame_set(5)
    assert not any("idden" in line for line in words(drawn(scene)))
    scene.frame_set(20)
    items = drawn(scene)
    assert "shin.L hidden" in words(items)
    assert "Hidden: shin.L" in words(items)
    trunk_seen, shin_seen, *predicted = [item for item in items if isinstance(item, Stroke)][:4]
    assert len(shin_seen.segments) == 0
    assert all(len(stroke.segments) > 8 for stroke in predicted)
    inked = np.linalg.norm(np.diff(predicted[0].segments, axis=1), axis=-1).sum()
    whole = np.linalg.norm(np.diff(trunk_seen.segments, axis=1), axis=-1).sum() * 1.2
    assert inked == pytest.approx(0.6 * whole, rel=0.05)


def test_without_the_footage_there_are_no_outlines(scene: bpy.types.Scene) -> None:
    region = SimpleNamespace(width=800, height=600)
    looking = SimpleNamespace(perspective_matrix=Matrix.Identity(4), view_matrix=Matrix.Identity(4))
    scene.frame_set(20)
    lines = words(drawn(scene, world_view(region, looking, None)))
    assert lines == ["Uncertain point", "Performer's right", "Performer's left"]  # from the bottom up


def test_hands_and_heads_whose_turn_is_hardly_seen_are_named_in_their_frames(scene: bpy.types.Scene) -> None:
    switch(scene, "skeleton", "legend")
    for frame, named in ((13, []), (14, ["left hand, right hand"]), (15, ["head"])):
        scene.frame_set(frame)
        said = [line for line in words(drawn(scene)) if "hardly" in line]
        assert said == [f"Turn hardly seen: {one}" for one in named]


def test_what_is_switched_off_is_not_drawn(scene: bpy.types.Scene) -> None:
    scene.frame_set(20)
    switch(scene)
    assert drawn(scene) == []
    switch(scene, "paths")
    assert discs(drawn(scene)) > 0


def discs(items: list) -> int:
    return sum(len(item.corners) for item in items if isinstance(item, Fill))


def test_an_uncertain_point_is_a_ring_in_a_circle_of_its_size(review: Review) -> None:
    places = CAMERA_VIEW.point_positions(review, np.array([3]))[0]
    meter = CAMERA_VIEW.pixels_per_meter(review, 3)
    items = skeleton(review, 3, places, meter, STYLE)
    assert discs(items) == 12
    circle = items[-1].segments.reshape(-1, 2)
    head = review.point_names.index("head")
    assert np.linalg.norm(circle - places[head], axis=-1) == pytest.approx(0.09 * meter[head], rel=0.01)
    assert meter[head] == pytest.approx(2.0 * 400.0 / -review.points[3, head, 2])
    unknown = SimpleNamespace(point_names=review.point_names, sigma_m=np.full_like(review.sigma_m, np.nan))
    items = skeleton(unknown, 3, places, meter, STYLE)
    assert discs(items) == 13


def test_a_path_is_solid_behind_and_dashed_ahead() -> None:
    assert window(12, FRAMES).tolist() == list(range(28))
    assert window(38, FRAMES).tolist() == list(range(23, 40))
    frames = np.arange(17)
    places = np.stack([30.0 * frames, np.full(len(frames), 7.0)], axis=-1)
    items = paths(["wrist.L"], places[None], frames, 12, np.array([0, 12, 39]), STYLE)
    past, ahead, dots, _, marks = items
    assert past.segments[..., 0].max() == pytest.approx(360.0)
    assert len(past.segments) == 12
    assert ahead.segments[..., 0].min() == pytest.approx(360.0)
    inked = np.diff(ahead.segments[..., 0], axis=1).sum()
    assert inked == pytest.approx(0.6 * 120.0)
    assert len(dots.corners) == 15
    assert marks.corners.mean(axis=1) == pytest.approx(np.array([[0.0, 7.0], [360.0, 7.0]]))


def test_the_viewports_projection_is_blenders() -> None:
    region = SimpleNamespace(width=640, height=480)
    view = Matrix.LocRotScale(Vector((0.3, -1.0, 0.5)), Matrix.Rotation(0.7, 3, "X").to_quaternion(), None)
    lens = Matrix(((1.9, 0, 0.1, 0), (0, 2.5, 0.0, 0), (0, 0, -1.01, -0.2), (0, 0, -1, 0)))
    looking = SimpleNamespace(perspective_matrix=lens @ view.inverted(), view_matrix=view.inverted())
    seen = world_view(region, looking, None)
    points = np.random.default_rng(8).normal(size=(20, 3)) * 2.0
    places = seen.project(points)
    before = 0
    for point, place in zip(points, places, strict=True):
        expected = location_3d_to_region_2d(region, looking, Vector(point))
        if expected is None:
            assert np.isnan(place).all()
        else:
            before += 1
            assert place == pytest.approx(tuple(expected), rel=1e-4, abs=0.01)
    assert 3 < before < 20
    at = view @ Vector((0.1, 0.2, -3.0))
    beside = view @ Vector((0.2, 0.2, -3.0))
    pair = SimpleNamespace(points=np.array([[at, beside]], dtype=float))
    here, there = seen.point_positions(pair, np.array([0]))[0]
    assert seen.pixels_per_meter(pair, 0)[0] == pytest.approx(10.0 * np.linalg.norm(there - here), rel=1e-4)


def test_a_far_body_is_drawn_finer() -> None:
    assert body_scale(np.array([200.0, np.nan, 300.0]), 1.0) == 1.0
    assert body_scale(np.array([80.0]), 1.0) == pytest.approx(0.5)
    assert body_scale(np.array([160.0]), 2.0) == pytest.approx(0.5)
    assert body_scale(np.array([1.0]), 1.0) == SMALLEST


def test_a_legend_stands_on_a_ground_that_holds_all_of_it() -> None:
    assert legend((), 40.0, 30.0, STYLE) == ()
    rows = [(sample, f"Like {sample.name}, explained at length") for sample in Sample]
    ground, *rest = legend(tuple(rows), 40.0, 30.0, STYLE)
    assert len(words(rest)) == len(rows)
    low, high = ground.corners[0].min(axis=0), ground.corners[0].max(axis=0)
    labels = [item for item in rest if isinstance(item, Label)]
    assert all(low[1] < label.y < high[1] - 8.0 and low[0] < label.x < high[0] for label in labels)


def test_neighbors_that_are_alike_are_drawn_at_once() -> None:
    line = np.zeros((2, 2, 2))
    red, blue = (1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 1.0)
    thin = [Stroke(line, red, 1.0), Stroke(line + 1.0, [blue, red], 1.0)]
    items = merged([*thin, Stroke(line, red, 2.0), Label("x", 0.0, 0.0), Fill(np.zeros((3, 4, 2)), blue)])
    assert [type(item) for item in items] == [Stroke, Stroke, Label, Fill]
    assert items[0].segments[:, 0, 0].tolist() == [0.0, 0.0, 1.0, 1.0]
    assert items[0].color.tolist() == [list(color) for color in (red, red, blue, red)]
    squares = merged(
        [Fill(np.zeros((1, 4, 2)), red), Fill(np.zeros((2, 4, 2)), blue), Fill(np.zeros((1, 8, 2)), red)]
    )
    assert [len(item.corners) for item in squares] == [3, 1]


def test_the_legend_keeps_clear_of_what_covers_the_region() -> None:

    def other(kind: str, alignment: str, x: int, y: int, width: int, height: int) -> SimpleNamespace:
        return SimpleNamespace(type=kind, alignment=alignment, x=x, y=y, width=width, height=height)

    own = other("WINDOW", "NONE", 100, 50, 800, 600)
    tools, header = other("TOOLS", "LEFT", 100, 50, 60, 600), other("HEADER", "TOP", 100, 624, 800, 26)
    closed = other("TOOLS", "LEFT", 100, 50, 1, 1)
    alone = corner(SimpleNamespace(type="VIEW_3D", regions=[own, closed]), own, 1.0)
    x, y = corner(SimpleNamespace(type="VIEW_3D", regions=[own, tools, header]), own, 1.0)
    assert (x - alone[0], y - alone[1]) == (60.0, -26.0)
    assert alone[1] < own.height


def test_a_lost_review_draws_nothing(registered: None) -> None:
    scene = bpy.context.scene
    assert motion.shown(scene) is None
    take = takes.add_take(scene, "Take")
    take.review_key = "review-" + 32 * "0"
    results.clear_cache()
    assert motion.shown(scene) is None


SMALL = FootageView(None, (160, 120), np.array([10.0, 490.0]), np.array([640.0, -480.0]), None)
VIEW = ClipView(SMALL, np.eye(4), SimpleNamespace(focal_px=400.0))
KEYPOINTS = made_up_keypoints()
ALL = all_sources(KEYPOINTS, ())


def seen_by(source: str, **points: tuple[float, float]) -> FrameKeypoints:
    pixel = np.array([list(points.values())], dtype=np.float64)
    return FrameKeypoints(source, tuple(points), pixel, np.ones(pixel.shape[:2]))


def centers(stroke: Stroke) -> np.ndarray:
    """Middles of the crosses of a stroke, two arms each."""
    return stroke.segments.reshape(-1, 2, 2, 2).mean(axis=(1, 2))


def test_crosses_lie_where_keypoints_are_seen_and_rings_where_the_motion_puts_them() -> None:
    links, rings, crosses, slanting, squares = compared_marks(KEYPOINTS, 0, SMALL.to_region, ALL, STYLE)
    assert centers(crosses) == pytest.approx(SMALL.to_region(KEYPOINTS.seen[0]))
    assert crosses.color[::2, :3].tolist() == [list(SOURCES[i][:3]) for i in (0, 0, 1)]
    assert links.segments[:, 1] == pytest.approx(SMALL.to_region(KEYPOINTS.predicted[0]))
    around = rings.segments.reshape(3, -1, 2).mean(axis=1)
    assert around == pytest.approx(SMALL.to_region(KEYPOINTS.predicted[0]))
    assert len(slanting.segments) == len(squares.segments) == 0


def test_what_is_not_believed_hidden_or_swapped_is_told_by_its_shape() -> None:
    _, _, upright, slanting, _ = compared_marks(KEYPOINTS, 1, SMALL.to_region, ALL, STYLE)
    assert len(centers(upright)) == 2
    assert centers(slanting) == pytest.approx(SMALL.to_region(KEYPOINTS.seen[1, :1]))
    assert slanting.color[0].tolist() == list(THROWN_OUT)
    steps = np.diff(slanting.segments, axis=1)[:, 0]
    assert np.abs(steps[:, 0]) == pytest.approx(np.abs(steps[:, 1]))
    links, _, upright, _, _ = compared_marks(KEYPOINTS, 2, SMALL.to_region, ALL, STYLE)
    assert len(links.segments) == len(centers(upright)) == 2
    links, _, _, _, squares = compared_marks(KEYPOINTS, 4, SMALL.to_region, ALL, STYLE)
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
    (other,) = seen_marks([left], SMALL.to_region, ALL, STYLE)
    assert centers(other) == pytest.approx(SMALL.to_region(both.pixel[1]))


@pytest.fixture
def reviewed(registered: None, monkeypatch: pytest.MonkeyPatch) -> bpy.types.Scene:
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


def test_the_legend_tells_what_the_frame_shows(reviewed: bpy.types.Scene) -> None:
    sources = ["Keypoint of a detector", "Keypoint of Blender's tracks", "Where the motion puts it"]
    assert rows(reviewed, 1)[:3] == sources
    assert rows(reviewed, 2)[:4] == [*sources, "Keypoint not believed"]
    assert rows(reviewed, 5)[:4] == [*sources, "Left and right exchanged"]
    reviewed.keymark.overlays.show_keypoints = False
    assert not any("eypoint" in words for words in rows(reviewed, 2))


def test_without_markers_the_legend_says_nothing_of_them(
    reviewed: bpy.types.Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    full = made_up_review().to_arrays()
    none = {name: full[name][:, :0] for name in ("observed", "predicted")}
    weak = {name: full[name][:0] for name in full if name.startswith("weak")}
    bare = Review.from_arrays({**full, **none, **weak, "marker_names": full["marker_names"][:0]})
    monkeypatch.setattr(motion, "review_of", lambda _take: bare)
    assert not any("arker" in words for words in rows(reviewed, 1))
    assert "Contour as the motion predicts it" in rows(reviewed, 1)
    reviewed.keymark.overlays.show_predicted = False
    assert not any("ontour" in words for words in rows(reviewed, 1))


def test_contours_are_dashed_where_the_motion_puts_them(reviewed: bpy.types.Scene) -> None:
    review = made_up_review()
    reviewed.frame_set(1)
    strokes, _ = motion.PARTS["predicted"](motion.shown(reviewed), VIEW, STYLE)
    strokes = [stroke for stroke in strokes if isinstance(stroke, Stroke)][len(review.marker_names) :]
    whole = np.linalg.norm(np.diff(SMALL.to_region(review.contours[0]), axis=1), axis=-1).sum()
    inked = sum(np.linalg.norm(np.diff(stroke.segments, axis=1), axis=-1).sum() for stroke in strokes)
    assert inked == pytest.approx(0.6 * whole, rel=0.05)


def test_keypoints_are_drawn_before_there_is_a_motion(registered: None) -> None:
    settings = bpy.context.scene.keymark.overlays
    seen = (seen_by("a detector", **{"head": (80.0, 10.0), "ankle.L": (82.0, 100.0)}),)
    items = motion.picture_keypoints(context_of(), seen, SMALL, settings)
    assert centers(items[0]) == pytest.approx(SMALL.to_region(seen[0].pixel[0]))
    assert [item.words for item in items if isinstance(item, Label)] == ["Keypoint of a detector"]
    far = (seen_by("a detector", **{"head": (80.0, 50.0), "ankle.L": (82.0, 60.0)}),)
    small = motion.picture_keypoints(context_of(), far, SMALL, settings)[0]
    assert np.ptp(small.segments[0], axis=0).max() < np.ptp(items[0].segments[0], axis=0).max()
    nobody = (FrameKeypoints("a detector", ("head",), np.full((1, 1, 2), np.nan), np.zeros((1, 1))),)
    assert len(motion.picture_keypoints(context_of(), nobody, SMALL, settings)[0].segments) == 0
