"""The readout of markers: numbers and warnings on clips whose colors are known, and previews."""

from collections.abc import Callable, Generator, Sequence
from typing import TypeVar

import numpy as np
import pytest
from _drawn_clip import BLUE, PANEL, RED, STYLES, Ellipse, clip_of, draw, film, moving, tracked, with_panel
from keymark.core.markers.ignored_regions import IgnoredRegion
from keymark.core.markers.marker_check import Likeness, MarkerCheck, check_markers, marker_warnings, places
from keymark.core.markers.region_tracks import ExpectedRegions, MarkerStyle
from keymark.core.markers.regions import color_masks, mask_outlines
from keymark.core.progress import run
from keymark.core.video.clip import sample_clip

Result = TypeVar("Result")
GREEN = (40, 220, 60)


def result_of(job: Generator[float, None, Result]) -> Result:
    """Drive a part to its end; its fractions must rise from 0 to 1."""
    fractions = []
    while True:
        try:
            fractions.append(next(job))
        except StopIteration as stop:
            assert fractions[0] == 0.0 and fractions[-1] == 1.0 and fractions == sorted(fractions)
            return stop.value


def check(
    images: list[np.ndarray], styles: Sequence[MarkerStyle] = STYLES, expected: ExpectedRegions | None = None
) -> MarkerCheck:
    return result_of(check_markers(result_of(sample_clip(clip_of(images))), styles, expected))


def words(result: MarkerCheck) -> str:
    return "\n".join(sentence for readout in result.readouts for sentence in readout.warnings)


def test_clear_colors_are_found_everywhere_with_their_areas() -> None:
    red, blue = check(film(moving, 40, 1)).readouts
    assert (red.name, red.found, red.sampled) == ("red", 24, 24) and blue.found == 24
    assert red.area_px == pytest.approx(np.pi * 16 * 6, rel=0.06)
    assert blue.area_share == pytest.approx(np.pi * 8 * 18 / (320 * 240), rel=0.06)
    assert min(red.distinctness, blue.distinctness) > 0.95
    assert red.warnings == blue.warnings == ()


def test_a_marker_is_found_in_the_frames_that_show_it_and_no_others() -> None:
    images = film(lambda index: moving(index)[index >= 10 :], 40, 2)
    result = check(images)
    red, blue = result.readouts
    assert (red.found, blue.found) == (6, 24)
    assert "red is found in only 6 of 24 frames" in words(result) and not blue.warnings


def test_one_color_that_is_nowhere_does_not_hide_the_others() -> None:
    images = film(moving, 20, 3)
    result = check(images, (*STYLES, MarkerStyle("shin", "shin.L", GREEN)))
    red, blue, shin = result.readouts
    assert (shin.found, shin.area_px, shin.distinctness) == (0, 0.0, 0.0)
    assert "[40, 220, 60], which matches nothing in the clip" in shin.warnings[0]
    assert red.found == blue.found == 20 and red.warnings == blue.warnings == ()
    np.testing.assert_allclose(red.distinctness, check(images).readouts[0].distinctness, atol=0.01)


def test_a_wall_of_a_markers_color_is_named() -> None:
    styles = (MarkerStyle("wall", "trunk", (200, 190, 176)), STYLES[1])
    wall, blue = check(film(moving, 20, 4), styles).readouts
    assert wall.found == 0 and wall.distinctness == 0.0
    assert "of the picture around the markers have too" in wall.warnings[0]
    assert blue.found == 20 and blue.distinctness > 0.9


def test_a_background_that_comes_near_a_markers_color_makes_it_less_distinct() -> None:
    distinctness = []
    for share in (0.0, 0.8, 0.85):
        rng = np.random.default_rng(5)
        curtain = (1.0 - share) * np.array((200.0, 190.0, 176.0)) + share * np.array(RED)
        images = []
        for index in range(20):
            image = draw(moving(index), rng)
            noise = rng.normal(0.0, 6.0, (90, 320, 3))
            image[150:] = np.clip(curtain[::-1] + noise, 0, 255).astype(np.uint8)
            images.append(image)
        distinctness.append(check(images).readouts[0].distinctness)
    assert distinctness[0] > 0.995 > distinctness[1] > 0.98 > distinctness[2]


def test_clutter_of_a_markers_color_is_named_with_its_share() -> None:
    bucket: Ellipse = (RED, (280.0, 205.0), (22.0, 16.0), 0.0)
    result = check(film(lambda index: [*moving(index), bucket], 40, 6))
    red, blue = result.readouts
    assert red.area_px == pytest.approx(np.pi * 16 * 6, rel=0.06)
    share = 22 * 16 / (22 * 16 + 16 * 6)
    assert red.distinctness == pytest.approx(1.0 - share, abs=0.05) and blue.distinctness > 0.95
    assert "% of the pixels with the color of red are something else" in words(result)


def test_markers_of_one_color_are_named_both_and_each_is_found() -> None:
    other: Ellipse = (RED, (200.0, 200.0), (9.0, 14.0), 0.0)
    styles = (*STYLES, MarkerStyle("twin", "shin.L", (RED[0] - 4, RED[1], RED[2] + 3)))
    places = np.array([[moving(index)[0][1], moving(index)[1][1], other[1]] for index in range(40)])
    expected = ExpectedRegions(places, np.full((40, 3), 40.0))
    result = check(film(lambda index: [*moving(index), other], 40, 7), styles, expected)
    red, blue, twin = result.readouts
    assert result.groups == ((0, 2), (1,))
    assert "red has almost the same color as twin" in red.warnings[0]
    assert "twin has almost the same color as red" in twin.warnings[0]
    assert red.found == twin.found == 24 and blue.warnings == ()
    share = 16 * 6 / (16 * 6 + 9 * 14)
    assert [red.distinctness, twin.distinctness] == pytest.approx([share, 1.0 - share], abs=0.05)
    assert twin.area_px == pytest.approx(np.pi * 9 * 14, rel=0.08)


def test_colors_that_light_may_make_equal_are_named() -> None:
    rng = np.random.default_rng(8)
    dark = (150, 52, 40)
    images = []
    for index in range(24):
        shapes: list[Ellipse] = [moving(index)[0], (dark, (250.5, 120.5), (8.0, 18.0), 0.0)]
        images.append(draw(shapes, rng, 6.0, 1.0 - 0.4 * (index % 2)))
    result = check(images, (STYLES[0], MarkerStyle("dark", "trunk", dark)))
    assert "colors too alike" in words(result) or "almost the same color" in words(result)
    assert "red" in words(result) and "dark" in words(result)


def test_sentences_say_with_what_a_color_is_confused() -> None:
    clear = Likeness((), (("blue", 0.02),), 0.05, 0.01, 0.0)
    assert marker_warnings("red", 24, 24, 300.0, clear) == ()
    (other,) = marker_warnings("red", 24, 24, 300.0, clear._replace(claimed=(("blue", 0.3),)))
    assert other == "red and blue have colors too alike: 30 % of red would pass for blue"
    (wall,) = marker_warnings("red", 24, 24, 300.0, clear._replace(background=0.25))
    assert wall.startswith("the background has the color of red: 25 %")


def test_a_tiny_marker_is_called_small() -> None:
    rng = np.random.default_rng(9)
    images = [draw([(RED, (60.0 + 3 * i, 90.0), (4.0, 2.5), 0.0), moving(i)[1]], rng, 1.0) for i in range(24)]
    red, blue = check(images).readouts
    assert any("red is small in the picture" in sentence for sentence in red.warnings)
    assert blue.warnings == ()


def test_previews_show_what_the_extraction_measures() -> None:
    images = film(moving, 12, 10)
    tracks = tracked(images)
    masks = color_masks(images[5], check(images).model)
    assert masks.shape == (2, 240, 320)
    np.testing.assert_allclose(masks.sum(axis=(1, 2)), tracks.area[5], rtol=0.02)
    assert masks.max() <= 1.0 and masks[0][120, 250] == 0.0 and masks[1][120, 250] == 1.0


def test_outlines_run_along_the_edge_of_what_is_covered() -> None:
    mask = draw([((255, 255, 255), (60.0, 50.0), (12.0, 5.0), 0.0)], np.random.default_rng(0), 0.0)
    bright = (mask.min(axis=2) > 220).astype(np.float32)
    bright[100:106, 200:206] = 1.0
    long, short = mask_outlines(bright, 2.0)
    radius = np.hypot((long[:, 0] - 120.0) / 24.0, (long[:, 1] - 100.0) / 10.0)
    assert np.abs(radius - 1.0).max() < 0.15 and len(long) > len(short)
    assert short.min(axis=0) == pytest.approx([400.0, 200.0], abs=1.1)
    assert short.max(axis=0) == pytest.approx([412.0, 212.0], abs=1.1)
    assert mask_outlines(np.zeros((4, 4), dtype=np.float32), 1.0) == []


FRAMES = 48


def check_ignoring(images: list[np.ndarray], *ignored: IgnoredRegion, styles: object = STYLES) -> MarkerCheck:
    return run(check_markers(run(sample_clip(clip_of(images))), styles, None, ignored))  # type: ignore[arg-type]


def panelled(seed: int = 3) -> list[np.ndarray]:
    rng = np.random.default_rng(seed)
    return [with_panel(draw(moving(index), rng)) for index in range(FRAMES)]


def test_a_panel_is_named_with_its_box_and_gone_once_it_is_ignored() -> None:
    images = panelled()
    red, blue = check_ignoring(images).readouts
    (box,) = red.still_boxes
    np.testing.assert_allclose(box, PANEL, atol=4.0)
    assert box[0] < PANEL[0] and box[1] < PANEL[1] and box[2] > PANEL[2] and box[3] > PANEL[3]
    assert any("stays still at the bottom left of the picture" in sentence for sentence in red.warnings)
    assert blue.still_boxes == () and blue.warnings == ()
    red, _ = check_ignoring(images, *(IgnoredRegion(box=box) for box in red.still_boxes)).readouts
    assert red.still_boxes == () and red.warnings == () and red.distinctness > 0.9
    assert red.found == red.sampled


def test_a_bent_panel_takes_several_boxes_that_leave_its_inside_free() -> None:
    rng = np.random.default_rng(4)
    images = [draw(moving(index), rng) for index in range(FRAMES)]
    for image in images:
        image[150:230, 20:28] = image[150:230, 112:120] = RED[::-1]
        image[150:158, 20:120] = image[222:230, 20:120] = RED[::-1]
    red, _ = check_ignoring(images).readouts
    covered = np.zeros((240, 320), dtype=bool)
    for left, top, right, bottom in red.still_boxes:
        covered[int(top) : int(bottom), int(left) : int(right)] = True
    assert covered[150:230, 20:28].all() and covered[222:230, 20:120].all()
    assert covered[165:215, 36:104].mean() < 0.05


REST: Ellipse = (RED, (250.5, 120.5), (8.0, 18.0), 0.0)
RESTING: Ellipse = (BLUE, (250.5, 120.5), (8.0, 18.0), 0.0)
TWINS = (MarkerStyle("one", "shin.L", RED), MarkerStyle("two", "shin.R", RED))


def swaying(index: int) -> Ellipse:
    """A garment of somebody who sits."""
    sway = 3.0 * np.sin(index / 3.0)
    return (RED, (120.0 + sway, 190.0 + 0.5 * sway), (34.0, 26.0), 0.0)


@pytest.mark.parametrize(
    ("shapes", "styles", "panel"),
    [
        (moving, STYLES, False),  # a resting marker beside moving clutter of another color
        (lambda index: [*moving(index)[:1], REST], TWINS, False),  # two markers of one color
        (lambda index: moving(index) if index < FRAMES // 5 else [RESTING], STYLES, True),  # seldom beside it
        (lambda index: [*moving(index)[:1], swaying(index)], STYLES[:1], False),
    ],
)
def test_what_is_not_sure_is_no_still_area(
    shapes: Callable[[int], list[Ellipse]], styles: tuple[MarkerStyle, ...], panel: bool
) -> None:
    images = film(shapes, FRAMES, 6)
    images = [with_panel(image) for image in images] if panel else images
    readouts = check_ignoring(images, styles=styles).readouts[: 2 - panel]
    assert all(readout.still_boxes == () for readout in readouts)


def test_a_few_frames_prove_nothing() -> None:
    assert check_ignoring(panelled()[:6]).readouts[0].still_boxes == ()


@pytest.mark.parametrize(
    ("box", "place"),
    [
        ((0.0, 0.0, 30.0, 30.0), "at the top left"),
        ((140.0, 100.0, 180.0, 140.0), "in the middle"),
        ((280.0, 100.0, 320.0, 140.0), "at the right"),
        ((100.0, 220.0, 220.0, 240.0), "at the bottom"),
    ],
)
def test_a_place_is_named_in_thirds_of_the_picture(
    box: tuple[float, float, float, float], place: str
) -> None:
    assert places([box, box], (320, 240)) == (place,)
