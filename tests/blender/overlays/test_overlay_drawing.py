"""Drawing into a picture off the screen, where this Blender can do that without a window."""

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace

import gpu
import numpy as np
import pytest
from keymark.core.camera.camera import Camera
from keymark.core.markers.regions import mask_outlines
from keymark.operators.follow.mask_previews import ColorMask, Preview
from keymark.operators.overlays import drawing
from keymark.operators.overlays import mask as mask_overlay
from keymark.operators.shell.footage_view import FootageView
from mathutils import Matrix

WIDTH, HEIGHT = 96, 64
Drawn = Callable[[Callable[[], None]], np.ndarray]

pytestmark = pytest.mark.skipif(
    not hasattr(gpu, "init"), reason="Blender before 5.2 draws nothing without a window"
)


@pytest.fixture
def drawn() -> Drawn:
    gpu.init()

    def picture(draw: Callable[[], None]) -> np.ndarray:
        screen = gpu.types.GPUOffScreen(WIDTH, HEIGHT)
        region = Matrix(((2 / WIDTH, 0, 0, -1), (0, 2 / HEIGHT, 0, -1), (0, 0, 1, 0), (0, 0, 0, 1)))
        with screen.bind(), gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
            framebuffer = gpu.state.active_framebuffer_get()
            framebuffer.clear(color=(0.0, 0.0, 0.0, 0.0))
            gpu.matrix.load_matrix(Matrix.Identity(4))
            gpu.matrix.load_projection_matrix(region)
            gpu.state.blend_set("ALPHA")
            draw()
            gpu.state.blend_set("NONE")
            pixels = framebuffer.read_color(0, 0, WIDTH, HEIGHT, 4, 0, "FLOAT").to_list()
        screen.free()
        return np.array(pixels)

    return picture


ORANGE = (1.0, 0.5, 0.0, 1.0)


def test_a_line_has_its_color_and_its_dark_edge(drawn: Drawn) -> None:
    line = np.array([[[8.0, 32.0], [88.0, 32.0]]])
    picture = drawn(lambda: drawing.Stroke(line, ORANGE, 6.0, halo=1.0).draw())
    assert picture[32, 48] == pytest.approx(ORANGE, abs=0.01)
    assert picture[35, 48, :3] == pytest.approx(0.0, abs=0.2)
    assert picture[35, 48, 3] > 0.2
    assert picture[42, 48, 3] == 0.0


def test_each_segment_may_have_a_color(drawn: Drawn) -> None:
    pair = np.array([[[8.0, 16.0], [88.0, 16.0]], [[8.0, 48.0], [88.0, 48.0]]])
    colors = [(1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 1.0)]
    picture = drawn(lambda: drawing.Stroke(pair, colors, 4.0).draw())
    assert picture[16, 48] == pytest.approx(colors[0], abs=0.01)
    assert picture[48, 48] == pytest.approx(colors[1], abs=0.01)


def test_polygons_are_filled_and_unfinished_ones_left_out(drawn: Drawn) -> None:
    boxes = np.array([[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0]]) + np.array(
        [[[5.0, 5.0]], [[np.nan, 5.0]], [[60.0, 30.0]]]
    )
    colors = [(1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0), (0.0, 0.0, 1.0, 0.5)]
    picture = drawn(lambda: drawing.Fill(boxes, colors).draw())
    assert picture[15, 15] == pytest.approx(colors[0], abs=0.01)
    assert picture[40, 70, 2:] == pytest.approx([0.5, 0.5], abs=0.01)
    assert picture[..., 1].max() == 0.0
    one = drawn(lambda: drawing.Fill(boxes[:1], ORANGE).draw())
    assert one[15, 15] == pytest.approx(ORANGE, abs=0.01)
    assert one[40, 70, 3] == 0.0


def test_a_texture_begins_at_the_bottom(drawn: Drawn) -> None:
    pixels = np.zeros((3, 2, 4))
    pixels[0, 1] = (1.0, 0.0, 0.5, 1.0)
    rows: list[list[float]] = []
    drawn(lambda: rows.extend(drawing.texture(pixels).read().to_list()))
    assert np.ravel(rows)[-4:] == pytest.approx([255, 0, 127.5, 255], abs=1)
    assert np.count_nonzero(rows) == 3


def test_words_are_light_with_a_dark_outline(drawn: Drawn) -> None:
    picture = drawn(lambda: drawing.Label("Hidden", 90.0, 30.0, size=14.0, align="right").draw())
    inked = picture[..., 3] > 0.5
    assert picture[inked, :3].max() > 0.9
    assert picture[inked, :3].min() < 0.1
    columns = np.flatnonzero(inked.any(axis=0))
    assert columns[-1] <= 93
    width, height = drawing.text_size("Hidden", 14.0)
    assert columns[-1] - columns[0] == pytest.approx(width, abs=6)
    assert 6 < height < 24


@pytest.mark.parametrize(
    "nothing",
    [
        drawing.Stroke(np.empty((0, 2, 2)), ORANGE, halo=1.0),
        drawing.Fill(np.empty((0, 4, 2)), ORANGE),
        drawing.Fill(np.full((2, 4, 2), np.nan), np.ones((2, 4))),
    ],
)
def test_nothing_to_draw_is_no_failure(drawn: Drawn, nothing: drawing.Item) -> None:
    assert drawn(nothing.draw).max() == 0.0


def paint(preview: Preview, view: FootageView) -> None:
    for item in mask_overlay.mask_items(preview, view):
        item.draw()


def test_fading_keeps_the_hue() -> None:
    assert drawing.faded((0.2, 0.4, 0.6), 0.5) == (0.2, 0.4, 0.6, 0.5)
    assert drawing.faded((0.2, 0.4, 0.6, 0.5), 0.5) == (0.2, 0.4, 0.6, 0.25)


@pytest.mark.parametrize("distortion", [None, (-0.2, 0.05, 0.0)])
def test_masks_lie_where_the_view_shows_their_pixels(
    drawn: Drawn, camera: Camera, distortion: tuple[float, float, float] | None
) -> None:
    lens = None if distortion is None else replace(camera, matrix_world=np.eye(4), distortion=distortion)
    view = FootageView(SimpleNamespace(), (160, 120), np.array([8.0, 60.0]), np.array([80.0, -56.0]), lens)
    coverage = np.zeros((30, 40), dtype=np.float32)
    coverage[4:12, 4:14] = 1.0
    mask = ColorMask("trunk", (0.0, 1.0, 0.0), coverage, mask_outlines(coverage, 4.0))
    preview = Preview(SimpleNamespace(), ("trunk",), (mask.color,), masks=(mask,))
    picture = drawn(lambda: paint(preview, view))
    inside = view.to_region([[36.0, 32.0], [22.0, 22.0], [48.0, 42.0]])
    outside = view.to_region([[100.0, 100.0], [74.0, 32.0], [130.0, 20.0]])
    for x, y in inside:
        assert picture[int(y), int(x), 1] > 0.4
    for x, y in outside:
        assert picture[int(y), int(x), 1] < 0.05 and picture[int(y), int(x), 3] > 0.3
    x, y = view.to_region(mask.outlines[0][0])
    near = picture[int(y) - 2 : int(y) + 3, int(x) - 2 : int(x) + 3]
    assert near[..., :3].min(axis=-1).max() > 0.8  # the outline is white


def test_a_texture_is_made_anew_only_for_other_masks(drawn: Drawn) -> None:
    view = FootageView(SimpleNamespace(), (40, 30), np.array([8.0, 60.0]), np.array([80.0, -56.0]), None)
    masks = [
        (ColorMask("a", (1.0, 0.0, 0.0), np.full((30, 40), level, dtype=np.float32), []),)
        for level in (0.0, 1.0)
    ]
    preview = Preview(SimpleNamespace(), ("a",), ((1.0, 0.0, 0.0),), masks=masks[0])
    drawn(lambda: paint(preview, view))
    first = mask_overlay._textures["masks 0.5"][1]
    drawn(lambda: paint(preview, view))
    assert mask_overlay._textures["masks 0.5"][1] is first
    preview.masks = masks[1]
    assert drawn(lambda: paint(preview, view))[32, 48, 0] > 0.5
    mask_overlay.detach()
    assert not mask_overlay._textures
