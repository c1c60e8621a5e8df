"""Single frames and small pictures: the right one at every time, and no more decoding than it takes."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from _drawn_clip import Drawn, write_video
from keymark.core.video.album import Album, Glimpses, WatchedClip
from keymark.core.video.clip import Clip, FrameReader
from keymark.core.video.frame_checks import FrameChecks

FPS = 30.0


def gray(index: int, size: tuple[int, int] = (64, 48)) -> np.ndarray:
    return np.full((size[1], size[0], 3), 20 + 8 * (index % 25), dtype=np.uint8)


def test_stepping_forward_decodes_each_frame_once() -> None:
    source = Drawn([gray(index) for index in range(50)], fps=FPS)
    reader = FrameReader(Clip(Path("drawn"), source))
    for index in range(20):
        assert (reader.image_at(index / FPS) == gray(index)).all()
    assert source.decoded == 21  # one ahead, to know when a frame ends
    for index in (19, 19, 22, 5, 49, 48):
        assert (reader.image_at(index / FPS) == gray(index)).all()
    assert source.decoded <= 21 + 3 + 4 + 3 + 4


def test_outside_the_clip_there_is_no_frame() -> None:
    reader = FrameReader(Clip(Path("drawn"), Drawn([gray(index) for index in range(5)], fps=FPS)))
    assert reader.image_at(-0.5 / FPS) is None
    assert reader.image_at(5.2 / FPS) is None
    assert (reader.image_at(4.8 / FPS) == gray(4)).all()
    assert (reader.image_at(0.0) == gray(0)).all()


def test_times_between_and_rounded_stamps_show_the_frame_that_has_begun() -> None:

    class Rounded(Drawn):
        def onward(self, first: int):  # noqa: ANN202
            return ((round(time, 3), image) for time, image in super().onward(first))

    reader = FrameReader(Clip(Path("drawn"), Rounded([gray(index) for index in range(40)], fps=FPS)))
    for index in (0, 1, 2, 3, 31, 32, 11, 38):
        assert (reader.image_at(index / FPS) == gray(index)).all()
        assert (reader.image_at((index + 0.7) / FPS) == gray(index)).all()


def test_uneven_frames_are_found_by_their_times() -> None:
    kept = [index for index in range(60) if index < 20 or index % 2 == 0]

    class Uneven(Drawn):
        def onward(self, first: int):  # noqa: ANN202
            return ((kept[index] / FPS, gray(kept[index])) for index in range(first, len(kept)))

    reader = FrameReader(Clip(Path("uneven"), Uneven([gray(index) for index in kept], fps=FPS)))
    for index in (3, 19, 20, 21, 35, 50, 9, 57):
        expected = index if index < 20 else index - index % 2
        assert (reader.image_at(index / FPS) == gray(expected)).all()


@pytest.mark.parametrize("order", [(0, 1, 2, 290, 291, 150, 140), (299, 0, 131)])
def test_a_file_is_searched_exactly(tmp_path: Path, order: tuple[int, ...]) -> None:
    path = tmp_path / "long.mp4"
    write_video(path, [20 + 8 * (index % 25) for index in range(300)], FPS)
    reader = FrameReader(Clip.open(path))
    for index in order:
        assert reader.image_at(index / FPS).mean() == pytest.approx(20 + 8 * (index % 25), abs=3.9)


GRADIENTS = [
    np.broadcast_to(np.linspace(0.0, 100.0, 640)[None, :, None] + 30.0 * index, (480, 640, 3)).astype(
        np.uint8
    )
    for index in range(4)
]
"""Pictures whose brightness tells their index."""


def watched(album: Album) -> Clip:
    """A clip of them that fills an album."""
    drawn = Drawn(GRADIENTS, fps=25.0, size=(640, 480))
    return WatchedClip(Path(), drawn, checks=FrameChecks(), album=album, glimpses=Glimpses(1.0, {}))


def test_a_watched_clip_is_the_clip_and_fills_the_album() -> None:
    album = Album()
    clip = watched(album)
    read = list(clip.frames())
    assert [(index, time_s) for index, time_s, _ in read] == [(i, i / 25.0) for i in range(4)]
    assert (clip.size, clip.fps, clip.frame_count) == ((640, 480), 25.0, 4)
    assert album.factor == 2
    for index, _, image in read:
        np.testing.assert_array_equal(image, GRADIENTS[index])
        small = cv2.resize(image, (320, 240), interpolation=cv2.INTER_AREA)
        assert np.abs(album.picture(index).astype(float) - small).max() <= 4.0


def test_what_stands_behind_whatever_moves_is_the_median_of_what_was_kept() -> None:
    glimpses = Glimpses(1.0, {index: np.zeros(0, dtype=np.uint8) for index in range(3)})
    assert glimpses.median() is None  # as of a shot that none of the pictures shows
    for index in range(3):
        picture = np.full((720, 1280, 3), 40, dtype=np.uint8)
        picture[:, 400 * index : 400 * index + 300] = 200
        glimpses.add(index, picture)
    behind = glimpses.median()
    assert behind is not None and behind[1] == 2.0
    assert behind[0].shape == (360, 640, 3) and np.abs(behind[0].astype(int) - 40).max() < 12
