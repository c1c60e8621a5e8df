"""Following markers through a clip longer than what their colors are learned from, and in one frame."""

import numpy as np
import pytest
from _drawn_clip import (
    RED,
    SIZE,
    STYLES,
    Drawn,
    clip_of,
    draw,
    film,
    finish,
    moving,
    path,
    track_markers,
    tracked,
)
from keymark.core.errors import InputError
from keymark.core.markers import markers
from keymark.core.markers.markers import regions_of_frame
from keymark.core.markers.region_tracks import ExpectedRegions, MarkerStyle
from keymark.core.video.clip import Clip

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
