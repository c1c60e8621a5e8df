"""Still areas of a marker's color: proposed where it is sure that they are no marker, and nowhere else."""

import numpy as np
import pytest
from _drawn_clip import BLUE, PANEL, RED, STYLES, Ellipse, clip_of, draw, moving, with_panel
from keymark.core.footage.clips.clip import sample_clip
from keymark.core.footage.ignored_regions import IgnoredRegion
from keymark.core.footage.marker_check import MarkerCheck, check_markers
from keymark.core.footage.region_tracks import MarkerStyle
from keymark.core.footage.still_areas import places
from keymark.core.progress import run

FRAMES = 48


def check(images: list[np.ndarray], *ignored: IgnoredRegion, styles: object = STYLES) -> MarkerCheck:
    return run(check_markers(run(sample_clip(clip_of(images))), styles, None, ignored))  # type: ignore[arg-type]


def panelled(seed: int = 3) -> list[np.ndarray]:
    rng = np.random.default_rng(seed)
    return [with_panel(draw(moving(index), rng)) for index in range(FRAMES)]


def test_a_panel_is_named_with_its_box_and_gone_once_it_is_ignored() -> None:
    """The box holds the panel with its blended border and hardly more; blue, at rest, is left alone."""
    images = panelled()
    red, blue = check(images).readouts
    (box,) = red.still_boxes
    np.testing.assert_allclose(box, PANEL, atol=4.0)
    assert box[0] < PANEL[0] and box[1] < PANEL[1] and box[2] > PANEL[2] and box[3] > PANEL[3]
    assert any("stays still at the bottom left of the picture" in sentence for sentence in red.warnings)
    assert blue.still_boxes == () and blue.warnings == ()
    red, _ = check(images, *(IgnoredRegion(box=box) for box in red.still_boxes)).readouts
    assert red.still_boxes == () and red.warnings == () and red.distinctness > 0.9
    assert red.found == red.sampled


def test_a_bent_panel_takes_several_boxes_that_leave_its_inside_free() -> None:
    rng = np.random.default_rng(4)
    images = [draw(moving(index), rng) for index in range(FRAMES)]
    for image in images:
        image[150:230, 20:28] = image[150:230, 112:120] = RED[::-1]
        image[150:158, 20:120] = image[222:230, 20:120] = RED[::-1]
    red, _ = check(images).readouts
    covered = np.zeros((240, 320), dtype=bool)
    for left, top, right, bottom in red.still_boxes:
        covered[int(top) : int(bottom), int(left) : int(right)] = True
    assert covered[150:230, 20:28].all() and covered[222:230, 20:120].all()
    assert covered[165:215, 36:104].mean() < 0.05


def test_a_resting_marker_beside_moving_clutter_of_another_color_stays() -> None:
    rng = np.random.default_rng(6)
    red, blue = check([draw(moving(index), rng) for index in range(FRAMES)]).readouts
    assert red.still_boxes == blue.still_boxes == ()


def test_two_markers_of_one_color_are_never_proposed_to_be_left_out() -> None:
    rng = np.random.default_rng(8)

    def both(index: int) -> list[Ellipse]:
        return [*moving(index)[:1], (RED, (250.5, 120.5), (8.0, 18.0), 0.0)]

    styles = (MarkerStyle("one", "shin.L", RED), MarkerStyle("two", "shin.R", RED))
    result = check([draw(both(index), rng) for index in range(FRAMES)], styles=styles)
    assert all(readout.still_boxes == () for readout in result.readouts)


def test_a_panel_is_not_sure_where_the_marker_is_seldom_seen_beside_it() -> None:
    rng = np.random.default_rng(10)
    rest: Ellipse = (BLUE, (250.5, 120.5), (8.0, 18.0), 0.0)
    images = [
        with_panel(draw(moving(index) if index < FRAMES // 5 else [rest], rng)) for index in range(FRAMES)
    ]
    assert check(images).readouts[0].still_boxes == ()


def test_a_garment_of_somebody_who_sits_is_no_still_area() -> None:
    """Its outline sways by a few pixels with every breath, while another of its color moves about."""
    rng = np.random.default_rng(12)

    def both(index: int) -> list[Ellipse]:
        sway = 3.0 * np.sin(index / 3.0)
        return [*moving(index)[:1], (RED, (120.0 + sway, 190.0 + 0.5 * sway), (34.0, 26.0), 0.0)]

    images = [draw(both(index), rng) for index in range(FRAMES)]
    assert check(images, styles=STYLES[:1]).readouts[0].still_boxes == ()


def test_a_few_frames_prove_nothing() -> None:
    assert check(panelled()[:6]).readouts[0].still_boxes == ()


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
