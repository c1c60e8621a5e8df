"""Small pictures kept while a clip is read."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import cv2
import numpy as np
import pytest
from keymark.core.footage.clips.album import Album, watch_clip
from keymark.core.footage.clips.clip import Clip
from keymark.core.footage.clips.frame_checks import FrameChecks

FRAMES = 4


class Drawn:
    """Frames of smooth gradients whose brightness tells their index."""

    size = (640, 480)
    fps = 25.0
    frame_count = FRAMES

    def image(self, index: int) -> np.ndarray:
        across = np.linspace(0.0, 100.0, self.size[0])[None, :, None]
        return np.broadcast_to(across + 30.0 * index, (480, 640, 3)).astype(np.uint8)

    def frames(self) -> Iterator[tuple[int, float, np.ndarray]]:
        for index in range(FRAMES):
            yield index, index / self.fps, self.image(index)

    def time_stamps(self) -> Iterator[float]:
        return (index / self.fps for index in range(FRAMES))

    def at(self, indices: Sequence[int]) -> Iterator[tuple[int, np.ndarray]]:
        return ((index, self.image(index)) for index in indices)


def test_a_watched_clip_is_the_clip_and_fills_the_album() -> None:
    """Frames, times and size pass unchanged; each frame's picture is that frame on half the grid."""
    album = Album()
    clip = watch_clip(Clip(Path("drawn"), Drawn()), FrameChecks(), album)
    read = list(clip.frames())
    assert [(index, time_s) for index, time_s, _ in read] == [(i, i / 25.0) for i in range(FRAMES)]
    assert (clip.size, clip.fps, clip.frame_count) == ((640, 480), 25.0, FRAMES)
    assert album.factor == 2
    for index, _, image in read:
        np.testing.assert_array_equal(image, Drawn().image(index))
        small = cv2.resize(image, (320, 240), interpolation=cv2.INTER_AREA)
        assert np.abs(album.picture(index).astype(float) - small).max() <= 4.0


def test_sampling_puts_nothing_into_the_album() -> None:
    album = Album()
    clip = watch_clip(Clip(Path("drawn"), Drawn()), FrameChecks(), album)
    assert len(list(clip.sample(2))) == 2
    assert 0 not in album
    with pytest.raises(KeyError):
        album.picture(0)
    next(clip.frames())
    assert 0 in album and 1 not in album
