"""Regions that are never a marker: their pixels on the grid, and clips read with and without them."""

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
import pytest
from _drawn_clip import (
    BLUE,
    RED,
    SIZE,
    STYLES,
    Ellipse,
    clip_of,
    draw,
    film,
    moving,
    path,
    tracked,
    with_panel,
)
from keymark.core.markers.ignored_regions import IGNORED, IgnoredPixels, IgnoredRegion
from keymark.core.markers.marker_check import check_markers
from keymark.core.markers.reading import Reading, read_clip, reading_key
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.markers.regions import color_masks
from keymark.core.progress import run
from keymark.core.video.clip import Clip, sample_clip

OVER = (14.0, 144.0, 96.0, 226.0)
"""Brushed generously over it."""


def images(count: int = 40) -> list[np.ndarray]:
    rng = np.random.default_rng(3)
    return [with_panel(draw(moving(index), rng)) for index in range(count)]


def hidden_red(index: int) -> list[Ellipse]:
    return [*(moving(index)[:1] if not 12 <= index < 28 else []), (BLUE, (250.5, 120.5), (8.0, 18.0), 0.0)]


def track(frames: list[np.ndarray], *ignored: IgnoredRegion) -> RegionTracks:
    return tracked(frames, ignored=ignored)


def away(tracks: RegionTracks) -> np.ndarray:
    """Distance of the red marker in each frame from where it is drawn."""
    true = np.array([path(index) for index in range(len(tracks.centroid))])
    return np.linalg.norm(tracks.centroid[:, 0] - true, axis=1)


def mask(*regions: IgnoredRegion, frame: int = 0, size: tuple[int, int] = SIZE) -> np.ndarray | None:
    return IgnoredPixels(regions, size).mask(frame)


def test_a_box_covers_its_pixels_on_the_measuring_grid() -> None:
    assert mask() is None
    small = mask(IgnoredRegion(box=(10.0, 20.0, 30.0, 25.0)))
    assert small is not None and small.shape == (240, 320)
    assert (small > 0).sum() == 20 * 5 and small[20:25, 10:30].min() == IGNORED
    large = mask(IgnoredRegion(box=(-40.0, 80.0, 120.0, 2000.0)), size=(1280, 960))
    assert large is not None and large.shape == (240, 320)
    assert (large > 0).sum() == 30 * (240 - 20) and large[20:, :30].min() == IGNORED


def test_a_stroke_covers_all_that_its_disc_sweeps() -> None:
    stroke = IgnoredRegion(stroke=((100.0, 60.0), (160.0, 100.0)), radius_px=12.0)
    covered = mask(stroke)
    assert covered is not None
    y, x = np.mgrid[:240, :320] + 0.5
    along = np.clip(((x - 100.0) * 60.0 + (y - 60.0) * 40.0) / (60.0**2 + 40.0**2), 0.0, 1.0)
    distance = np.hypot(x - 100.0 - 60.0 * along, y - 60.0 - 40.0 * along)
    assert np.all(covered[distance < 11.0] == IGNORED) and np.all(covered[distance > 13.0] == 0)
    dot = mask(IgnoredRegion(stroke=((50.0, 50.0),), radius_px=6.0))
    assert dot is not None and np.pi * 6.0**2 <= (dot > 0).sum() <= np.pi * 6.7**2  # drawn with its border


def test_a_region_counts_in_its_frames_alone() -> None:
    region = IgnoredRegion(box=(0.0, 0.0, 10.0, 10.0), frames=(5, 7))
    assert [mask(region, frame=frame) is not None for frame in (4, 5, 7, 8)] == [False, True, True, False]
    sampled = IgnoredPixels((region,), SIZE, sampled=(0, 6, 12))
    assert [sampled.mask(number) is not None for number in range(3)] == [False, True, False]


@pytest.mark.parametrize(
    "over",
    [
        IgnoredRegion(box=OVER),
        IgnoredRegion(
            stroke=tuple((float(x), float(y)) for y in range(150, 230, 16) for x in (20, 90)), radius_px=14.0
        ),
    ],
    ids=["box", "stroke"],
)
def test_a_hidden_marker_is_not_taken_for_an_ignored_panel(over: IgnoredRegion) -> None:
    rng = np.random.default_rng(5)
    frames = [with_panel(draw(hidden_red(index), rng)) for index in range(40)]
    plain, brushed = track(frames), track(frames, over)
    assert plain.visible[12:28, 0].any(), "the panel misleads nobody: the test tests nothing"
    assert not brushed.visible[12:28, 0].any()
    assert brushed.visible[:12, 0].all() and np.nanmax(away(brushed)) < 0.5
    np.testing.assert_allclose(plain.centroid[:, 1], brushed.centroid[:, 1], atol=0.01)  # blue stays


def test_a_panel_beside_a_resting_marker_is_told_from_it() -> None:
    rng = np.random.default_rng(7)
    at_rest = [(RED, (200.3, 60.7), (16.0, 6.0), 30.0), (BLUE, (250.5, 120.5), (8.0, 18.0), 0.0)]
    frames = [with_panel(draw(at_rest, rng)) for _ in range(30)]
    brushed = track(frames, IgnoredRegion(box=OVER))
    assert np.abs(brushed.centroid[:, 0] - (200.3, 60.7)).max() < 0.3
    assert np.nanmedian(brushed.area[:, 0]) == pytest.approx(np.pi * 16 * 6, rel=0.06)
    assert np.linalg.norm(np.nanmedian(track(frames).centroid[:, 0], axis=0) - (200.3, 60.7)) > 50.0


def test_a_wall_that_hides_its_color_teaches_nothing_once_it_is_ignored() -> None:
    rng = np.random.default_rng(9)
    wall = IgnoredRegion(box=(0.0, 0.0, 130.0, 240.0))

    def frame(index: int) -> np.ndarray:
        image = draw([(RED, (190.0 + 2.0 * index, 90.0), (9.0, 5.0), 9.0 * index)], rng)
        image[:, :128] = np.clip(rng.normal(RED[::-1], 3.0, (240, 128, 3)), 0, 255)
        return image

    frames = [frame(index) for index in range(36)]
    red = STYLES[:1]
    seen = tracked(frames, red, ignored=(wall,))
    true = np.array([(190.0 + 2.0 * index, 90.0) for index in range(36)])
    assert np.linalg.norm(seen.centroid[:, 0] - true, axis=1).max() < 0.5
    assert np.nanmedian(seen.quality[:, 0]) > 0.8


def test_a_region_that_an_ignored_one_cuts_is_seen_in_part() -> None:
    rng = np.random.default_rng(11)
    frames = [draw([(RED, (150.0, 90.0), (30.0, 12.0), 0.0)], rng) for _ in range(20)]
    half = tracked(frames, STYLES[:1], ignored=(IgnoredRegion(box=(0, 0, 150, 240)),))
    whole = tracked(frames, STYLES[:1])
    assert half.clipped[:, 0].all() and not whole.clipped.any()
    assert np.nanmedian(half.area) == pytest.approx(0.5 * np.nanmedian(whole.area), rel=0.05)
    beside = IgnoredRegion(box=(0, 0, 110, 240))
    assert not tracked(frames, STYLES[:1], ignored=(beside,)).clipped.any()


def test_a_region_ignored_in_some_frames_is_searched_in_the_others() -> None:
    frames = film(moving, 60, 13)
    tracks = track(frames, IgnoredRegion(box=(0.0, 0.0, 320.0, 240.0), frames=(20, 29)))
    assert np.flatnonzero(~tracks.visible[:, 0]).tolist() == list(range(20, 30))
    assert not tracks.visible[20:30, 1].any() and tracks.visible[30:, 1].all()


def test_the_key_of_a_reading_changes_with_what_is_ignored(tmp_path: Path) -> None:
    folder = tmp_path / "clip"
    folder.mkdir()
    for index in range(3):
        cv2.imwrite(str(folder / f"{index:03d}.png"), images(1)[0])
    kinds: Sequence[tuple[IgnoredRegion, ...]] = (
        (),
        (IgnoredRegion(box=OVER),),
        (IgnoredRegion(box=OVER, frames=(0, 1)),),
        (IgnoredRegion(stroke=((1.0, 2.0),), radius_px=3.0),),
        (IgnoredRegion(stroke=((1.0, 2.0),), radius_px=4.0),),
    )
    keys = [reading_key(folder, 30.0, STYLES, None, ignored) for ignored in kinds]
    assert len(set(keys)) == len(keys) and keys[0] == reading_key(folder, 30.0, STYLES, None)
    assert len({reading_key(folder, 30.0, (), None, ignored) for ignored in kinds}) == 1


def test_a_kept_reading_is_not_used_for_other_ignored_regions(tmp_path: Path) -> None:
    folder = tmp_path / "clip"
    folder.mkdir()
    rng = np.random.default_rng(5)
    for index in range(40):
        cv2.imwrite(str(folder / f"{index:03d}.png"), with_panel(draw(hidden_red(index), rng)))
    clip, over = Clip.open(folder, fps=30.0), (IgnoredRegion(box=OVER),)
    first = _read(clip)
    again = _read(clip, first, over)
    assert first.tracks.visible[20, 0] and not again.tracks.visible[20, 0]
    assert _read(clip, again, over).tracks is again.tracks


def _read(clip: Clip, kept: Reading | None = None, ignored: Sequence[IgnoredRegion] = ()) -> Reading:
    return run(read_clip(clip, STYLES, None, False, kept, ignored))


def test_a_mask_that_is_shown_has_nothing_of_an_ignored_panel() -> None:
    frames = images()
    samples = run(sample_clip(clip_of(frames)))
    over = (IgnoredRegion(box=OVER),)
    model = run(check_markers(samples, STYLES, None, over)).model
    shown, brushed = (
        color_masks(frames[5], model, mask) for mask in (None, IgnoredPixels(over, SIZE).mask(5))
    )
    assert shown[0, 150:220, 20:90].mean() > 0.9 and not brushed[:, 144:226, 14:96].any()
    x, y = (round(value) for value in path(5))
    around = slice(y - 8, y + 8), slice(x - 8, x + 8)
    assert shown[0][around].max() > 0.9
    np.testing.assert_allclose(brushed[0][around], shown[0][around])
