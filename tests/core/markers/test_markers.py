"""Moments of shapes, and markers found on drawn clips and on rendered takes with their truth."""

import json
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from _drawn_clip import (
    BLUE,
    RED,
    SIZE,
    STYLES,
    Drawn,
    Ellipse,
    clip_of,
    draw,
    film,
    finish,
    moving,
    path,
    track_markers,
    tracked,
)
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.errors import InputError
from keymark.core.markers import markers
from keymark.core.markers.color_learning import learn_colors
from keymark.core.markers.markers import regions_of_frame
from keymark.core.markers.moments import axis_angle_difference, centroid_and_second_moment, characteristics
from keymark.core.markers.region_tracks import ExpectedRegions, MarkerStyle
from keymark.core.video.clip import Clip


def raw_moments(weights: np.ndarray) -> np.ndarray:
    """Eq. 1 for pixels that are unit squares of even weight."""
    x, y = np.meshgrid(np.arange(weights.shape[1]) + 0.5, np.arange(weights.shape[0]) + 0.5)
    own = 1.0 / 12.0
    return np.array([np.sum(weights * of) for of in (1.0, x, y, x * x + own, x * y, y * y + own)])


def measured(mask: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return centroid_and_second_moment(raw_moments(mask))


def ellipse(angle: float, a: float = 60.0, b: float = 24.0, size: int = 160) -> np.ndarray:
    """An ellipse with soft edges, 8 x 8 points a pixel; `angle` from x towards y downwards."""
    fine = (np.arange(size * 8) + 0.5) / 8 - size / 2
    x, y = np.meshgrid(fine, fine)
    along, across = x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)
    inside = ((along / a) ** 2 + (across / b) ** 2 <= 1.0).astype(np.float64)
    return inside.reshape(size, 8, size, 8).mean(axis=(1, 3))


def test_a_rectangle_of_whole_pixels_has_exactly_the_rectangles_moments() -> None:
    mask = np.zeros((20, 30), dtype=bool)
    mask[4:10, 10:14] = True
    centroid, second = measured(mask)
    np.testing.assert_allclose(centroid, [12.0, 7.0])
    np.testing.assert_allclose(second, [[16 / 12, 0.0], [0.0, 3.0]], atol=1e-12)


@pytest.mark.parametrize("angle", np.linspace(-1.5, 1.5, 7))
def test_an_ellipse_gives_its_angle_and_the_square_of_its_axes_ratio(angle: float) -> None:
    found = characteristics(*measured(ellipse(angle)))
    assert found.x == pytest.approx(80.0) and found.y == pytest.approx(80.0)
    assert axis_angle_difference(found.angle_rad, angle) == pytest.approx(0.0, abs=2e-3)
    assert found.ratio == pytest.approx((60 / 24) ** 2, rel=5e-3)
    _, second = measured(ellipse(angle))
    np.testing.assert_allclose(np.linalg.eigvalsh(second), [24**2 / 4, 60**2 / 4], rtol=5e-3)


def test_an_empty_region_is_not_a_number() -> None:
    centroid, second = measured(np.zeros((5, 5)))
    assert np.isnan(centroid).all() and np.isnan(second).all()


@given(st.floats(-20.0, 20.0), st.floats(-20.0, 20.0))
def test_axis_angles_differ_by_less_than_a_right_angle(first: float, second: float) -> None:
    difference = axis_angle_difference(first, second)
    assert -np.pi / 2 <= difference <= np.pi / 2
    assert np.sin(difference - (first - second)) == pytest.approx(0.0, abs=1e-9)


@given(st.floats(-1.5, 1.5), st.floats(0.5, 50.0), st.floats(1.05, 400.0))
def test_characteristics_recover_the_axes_a_matrix_was_made_of(
    angle: float, smaller: float, ratio: float
) -> None:
    """Also for long thin regions, where the smaller eigenvalue is easily lost in rounding."""
    axis = np.array([np.cos(angle), np.sin(angle)])
    normal = np.array([-axis[1], axis[0]])
    matrix = smaller * ratio * np.outer(axis, axis) + smaller * np.outer(normal, normal)
    found = characteristics([1.0, 2.0], matrix)
    assert axis_angle_difference(found.angle_rad, angle) == pytest.approx(0.0, abs=1e-6)
    assert found.ratio == pytest.approx(ratio, rel=1e-6)


def test_regions_of_known_place_size_and_direction_are_measured_to_a_fraction_of_a_pixel() -> None:
    tracks = tracked(film(moving, 40, 1))
    truth = np.array([path(index) for index in range(40)])
    assert tracks.visible.all() and tracks.names == ("red", "blue") and tracks.size == SIZE
    assert np.abs(tracks.centroid[:, 0] - truth).max() < 0.2
    assert np.abs(tracks.centroid[:, 1] - [250.5, 120.5]).max() < 0.2
    np.testing.assert_allclose(tracks.area[:, 0], np.pi * 16 * 6, rtol=0.06)
    np.testing.assert_allclose(tracks.area[:, 1], np.pi * 8 * 18, rtol=0.06)
    np.testing.assert_allclose(np.linalg.eigvalsh(tracks.second_moment[:, 0])[:, 1], 16**2 / 4, rtol=0.1)
    assert tracks.quality.min() > 0.8 and not tracks.clipped.any()
    np.testing.assert_allclose(tracks.time_s, np.arange(40) / 30.0)


def test_a_hidden_marker_is_not_a_number_and_comes_back() -> None:
    tracks = tracked(film(lambda index: moving(index)[1 if 15 <= index < 25 else 0 :], 40, 2))
    hidden = np.zeros(40, dtype=bool)
    hidden[15:25] = True
    np.testing.assert_array_equal(~tracks.visible[:, 0], hidden)
    assert np.isnan(tracks.second_moment[hidden, 0]).all() and np.isnan(tracks.area[hidden, 0]).all()
    assert (tracks.quality[hidden, 0] == 0.0).all() and tracks.visible[:, 1].all()


def test_changing_light_and_noise_do_not_lose_a_marker() -> None:
    rng = np.random.default_rng(3)
    images = [draw(moving(index), rng, 5.0, 1.0 - 0.01 * index) for index in range(40)]
    tracks = tracked(images)
    assert tracks.visible.all()
    assert np.median(np.abs(tracks.centroid[:, 0] - [path(index) for index in range(40)])) < 0.2


def test_a_still_thing_of_the_markers_color_is_clutter_even_while_the_marker_is_hidden() -> None:
    bucket: Ellipse = (RED, (280.0, 205.0), (22.0, 16.0), 0.0)
    tracks = tracked(film(lambda index: [*moving(index)[15 <= index < 25 :], bucket], 40, 4))
    seen = tracks.visible[:, 0]
    np.testing.assert_array_equal(~seen, (np.arange(40) >= 15) & (np.arange(40) < 25))
    truth = np.array([path(index) for index in range(40)])
    assert np.abs(tracks.centroid[seen, 0] - truth[seen]).max() < 0.3


def test_a_marker_that_rests_is_no_clutter() -> None:
    rng = np.random.default_rng(5)
    tracks = tracked([draw(moving(8), rng) for _ in range(30)])
    assert tracks.visible.all()


def test_the_expected_place_tells_the_marker_from_a_moving_thing_of_its_color() -> None:
    balls: list[Ellipse] = [(RED, (300.0 - 3.0 * index, 40.0), (14.0, 14.0), 0.0) for index in range(40)]
    images = film(lambda index: [*moving(index), balls[index]], 40, 6)
    truth = np.array([path(index) for index in range(40)])
    center = np.stack([truth + [9.0, -7.0], np.tile([250.5, 120.5], (40, 1))], axis=1)
    expected = ExpectedRegions(center[:38], np.full((38, 2), 30.0))  # a container may claim too few frames
    tracks = tracked(images, STYLES, expected)
    apart = np.linalg.norm(truth - [ball[1] for ball in balls], axis=1) > 45.0
    assert np.abs(tracks.centroid[apart, 0] - truth[apart]).max() < 0.3


def test_a_region_that_an_arm_splits_stays_one() -> None:
    rng = np.random.default_rng(7)
    images = []
    for index in range(30):
        image = draw([(RED, (150.0, 100.0), (30.0, 20.0), 0.0), moving(index)[1]], rng)
        if index >= 15:
            image[94:106] = rng.normal(45, 2, (12, 320, 3)).astype(np.uint8)
        images.append(image)
    tracks = tracked(images)
    assert np.abs(tracks.centroid[:, 0] - [150.0, 100.0]).max() < 0.5
    assert (tracks.area[15:, 0] < 0.75 * tracks.area[0, 0]).all()
    assert tracks.quality[20, 0] < 0.75 * tracks.quality[5, 0]


def test_a_region_at_the_images_border_is_clipped_and_trusted_less() -> None:
    rng = np.random.default_rng(8)
    images = [
        draw(
            [(RED, (250.0 + 3.0 * index, 100.0), (16.0, 6.0), 0.0), (BLUE, (60.0, 60.0), (9.0, 9.0), 0.0)],
            rng,
        )
        for index in range(25)
    ]
    tracks = tracked(images)
    assert tracks.clipped[20, 0] and not tracks.clipped[:15, 0].any() and not tracks.clipped[:, 1].any()
    assert tracks.quality[20, 0] < 0.5 * tracks.quality[10, 0]


def test_a_color_that_matches_nothing_is_named_with_the_nearest_ones() -> None:
    clip = clip_of(film(moving, 20, 9))
    with pytest.raises(InputError, match=r"marker shin.*\[40, 220, 60\].*nearest.*\[\d+, \d+, \d+\]"):
        finish(track_markers(clip, (*STYLES, MarkerStyle("shin", "shin.L", (40, 220, 60)))))


def test_larger_images_are_searched_on_a_reduced_grid_and_measured_on_the_full_one() -> None:
    rng = np.random.default_rng(11)
    large = [
        cv2.resize(draw(moving(index), rng, 0.0), None, fx=4, fy=4, interpolation=cv2.INTER_CUBIC)
        for index in range(8)
    ]
    noisy = [np.clip(image + rng.normal(0, 2, image.shape), 0, 255).astype(np.uint8) for image in large]
    tracks = finish(track_markers(Clip(Path("large"), Drawn(noisy, size=(1280, 960))), STYLES))
    truth = 4.0 * np.array([path(index) for index in range(8)])
    assert np.abs(tracks.centroid[:, 0] - truth).max() < 0.5
    np.testing.assert_allclose(tracks.area[:, 0], 16 * np.pi * 16 * 6, rtol=0.06)


def test_one_sample_off_in_light_still_teaches_the_markers_color() -> None:
    images = film(moving, 6, 12)
    dark = (RED[0] * 2 // 3, RED[1] * 2 // 3, RED[2] * 2 // 3)
    right, shaded = (learn_colors(images, [sample, BLUE]).found for sample in (RED, dark))
    np.testing.assert_allclose(shaded, right, rtol=0.1)


@pytest.mark.parametrize("gray", [(128, 128, 128), (12, 12, 12), (235, 235, 235)])
def test_a_marker_without_a_hue_is_told_from_a_colored_wall(gray: tuple[int, int, int]) -> None:
    rng = np.random.default_rng(3)
    images = []
    for index in range(20):
        image = np.full((SIZE[1], SIZE[0], 3), (60, 130, 170), dtype=np.uint8)
        cv2.ellipse(image, (80 + 6 * index, 120), (30, 15), 0.0, 0, 360, gray, -1)
        images.append(np.clip(image + rng.normal(0, 2.0, image.shape), 0, 255).astype(np.uint8))
    tracks = tracked(images, (MarkerStyle("gray", "forearm.L", gray),))
    truth = np.array([[80.5 + 6.0 * index, 120.5] for index in range(20)])
    assert tracks.visible.all() and np.abs(tracks.centroid[:, 0] - truth).max() < 1.0


def test_a_gray_marker_before_a_wall_of_a_little_warmth_is_followed() -> None:
    rng = np.random.default_rng(3)
    gray = (128, 128, 128)
    images = [draw([(gray, (80.0 + 6.0 * i, 90.0), (30.0, 15.0), 0.0)], rng) for i in range(20)]
    tracks = tracked(images, (MarkerStyle("gray", "forearm.L", gray),))
    truth = np.array([[80.0 + 6.0 * index, 90.0] for index in range(20)])
    assert tracks.visible.all() and np.median(np.abs(tracks.centroid[:, 0] - truth)) < 0.5


@pytest.mark.parametrize("name", ["walk", "reach", "aerobic"])
def test_rendered_takes_agree_with_the_exactly_visible_pixels(
    name: str, take_folder: Callable[[str], Path]
) -> None:
    folder = take_folder(name)
    markers = json.loads((folder / "take.json").read_text())["markers"]
    truth = json.loads((folder / "visibility.json").read_text())
    styles = [MarkerStyle(key, key, tuple(value["color_srgb"])) for key, value in markers.items()]
    tracks = finish(track_markers(Clip.open(folder / "clip.mp4"), styles))
    for marker, key in enumerate(tracks.names):
        pixels = np.array(truth[key]["pixels"])
        center = np.array([place or [np.nan, np.nan] for place in truth[key]["centroid_px"]], dtype=float)
        seen = tracks.visible[:, marker]
        assert not (seen & (pixels == 0)).any(), f"{key} is found where it is hidden"
        assert np.count_nonzero(~seen & (pixels >= 40)) <= 1, f"{key} is missed"
        both = seen & (pixels > 0)
        error = np.linalg.norm(tracks.centroid[both, marker] - center[both], axis=1)
        assert np.median(error) < 0.8 and np.quantile(error, 0.95) < 2.5
        assert 0.8 < np.median(tracks.area[both, marker] / pixels[both]) < 1.2


STRETCH = 9


@pytest.fixture
def short_stretch(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the colors be learned from the first nine frames of a drawn clip."""
    monkeypatch.setattr(markers, "STRETCH_BYTES", STRETCH * SIZE[0] * SIZE[1] * 3)


def test_what_comes_after_the_stretch_is_measured_like_what_lies_in_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    images = film(moving, 42, 1)
    whole = tracked(images)
    monkeypatch.setattr(markers, "STRETCH_BYTES", STRETCH * SIZE[0] * SIZE[1] * 3)
    drawn = Drawn(images)
    followed = finish(track_markers(Clip(clip_of(images).path, drawn), STYLES))
    assert drawn.passes == 1
    assert np.abs(followed.centroid - whole.centroid).max() < 0.1
    np.testing.assert_allclose(followed.area, whole.area, rtol=0.03)


@pytest.mark.usefixtures("short_stretch")
def test_a_marker_that_enters_late_is_found_from_its_first_frame_on() -> None:
    tracks = tracked(film(lambda index: moving(index)[1 if index < 20 else 0 :], 60, 2))
    np.testing.assert_array_equal(tracks.visible[:, 0], np.arange(60) >= 20)
    truth = np.array([path(index) for index in range(60)])
    assert np.abs(tracks.centroid[20:, 0] - truth[20:]).max() < 0.3


@pytest.mark.usefixtures("short_stretch")
def test_a_lost_marker_is_found_where_it_comes_back() -> None:
    rng = np.random.default_rng(3)
    places = [(60.0 + 2.0 * index, 60.0) if index < 20 else (260.0 - index, 200.0) for index in range(50)]
    images = []
    for index, place in enumerate(places):
        shapes = [(RED, place, (16.0, 6.0), 10.0), moving(index)[1]]
        images.append(draw(shapes[1 if 20 <= index < 30 else 0 :], rng))
    tracks = tracked(images)
    hidden = (np.arange(50) >= 20) & (np.arange(50) < 30)
    np.testing.assert_array_equal(~tracks.visible[:, 0], hidden)
    assert np.abs(tracks.centroid[~hidden, 0] - np.array(places)[~hidden]).max() < 0.3


@pytest.mark.usefixtures("short_stretch")
def test_a_marker_that_leaps_out_of_its_window_is_followed() -> None:
    rng = np.random.default_rng(4)
    places = [(160.0 + 100.0 * np.sin(index * 0.5), 90.0 + 20.0 * np.cos(index * 0.4)) for index in range(48)]
    images = [draw([(RED, place, (17.0, 7.0), 0.0)], rng) for place in places]
    tracks = tracked(images, (STYLES[0],))
    assert np.abs(np.diff(np.array(places)[:, 0])).max() > 45.0
    assert tracks.visible.all()
    assert np.abs(tracks.centroid[:, 0] - places).max() < 0.3


@pytest.mark.usefixtures("short_stretch")
def test_two_pieces_about_an_arm_are_one_marker_after_the_stretch_too() -> None:
    rng = np.random.default_rng(5)
    images = []
    for index in range(30):
        image = draw([(RED, (150.0, 100.0), (30.0, 20.0), 0.0), moving(index)[1]], rng)
        if index >= 18:
            image[94:106] = rng.normal(45, 2, (12, 320, 3)).astype(np.uint8)
        images.append(image)
    tracks = tracked(images)
    assert np.abs(tracks.centroid[:, 0] - [150.0, 100.0]).max() < 0.5
    assert (tracks.area[18:, 0] < 0.75 * tracks.area[0, 0]).all()


def alike(index: int) -> list[tuple[float, float]]:
    """Where two markers of one color are: their paths cross in height, and the second rests at first."""
    return [(60.0 + 4.0 * index, 60.0 + 2.0 * index), (240.0 - max(4.0 * (index - 10), 0.0), 140.0)]


def test_the_expected_places_tell_markers_of_almost_one_color_apart() -> None:
    other = (RED[0] - 6, RED[1] + 4, RED[2] + 3)
    styles = (MarkerStyle("left", "forearm.L", RED), MarkerStyle("right", "forearm.R", other))
    images = film(
        lambda index: [(RED, alike(index)[0], (14.0, 6.0), 0.0), (other, alike(index)[1], (6.0, 14.0), 0.0)],
        40,
        6,
    )
    truth = np.array([alike(index) for index in range(40)])
    apart = np.abs(truth[:, 0, 0] - truth[:, 1, 0]) > 30.0
    expected = ExpectedRegions(truth + [6.0, -5.0], np.full((40, 2), 60.0))
    tracks = tracked(images, styles, expected)
    assert tracks.visible[apart].all()
    assert np.abs(tracks.centroid[apart] - truth[apart]).max() < 0.5
    assert len(tracks.notes) == 1
    assert "left and right have almost the same color; the keyframes tell" in tracks.notes[0]


def test_a_marker_of_the_walls_color_is_refused_with_the_reason() -> None:
    wall = (200, 190, 176)
    rng = np.random.default_rng(8)
    images = [draw([(wall, (80.0 + 6.0 * i, 90.0), (30.0, 15.0), 0.0)], rng) for i in range(20)]
    with pytest.raises(InputError, match=r"marker sleeve has the color .* [67]\d % of the picture .* too"):
        tracked(images, (MarkerStyle("sleeve", "forearm.L", wall),))


def test_one_frame_is_measured_as_in_a_pass_over_the_clip() -> None:
    clip = clip_of(film(moving, 30, 1))
    whole = finish(track_markers(clip, STYLES))
    for index in (0, 13, 29):
        one = regions_of_frame(clip, index / 30.0, STYLES)
        assert one.names == whole.names
        assert one.frame_count == 1
        assert np.abs(one.centroid[0] - whole.centroid[index]).max() < 0.1
        np.testing.assert_allclose(one.area[0], whole.area[index], rtol=0.02)


def test_a_frame_beyond_the_end_is_refused() -> None:
    clip = clip_of(film(moving, 12, 2))
    with pytest.raises(InputError, match="no frame at 0.50 s"):
        regions_of_frame(clip, 0.5, STYLES)
