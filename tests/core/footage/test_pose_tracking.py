"""People are found in a clip and followed: who comes, goes, passes by, and is nobody."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from _fake_network import SHAPE, FakeNetwork, draw_people
from keymark.core.arrays import Image
from keymark.core.errors import InputError
from keymark.core.footage.clips.clip import Clip
from keymark.core.footage.keypoints.keypoints import People
from keymark.core.footage.pose_tracking import STRETCH, find_people
from keymark.core.progress import Progress, run

SIZE = (320, 240)
People3 = list[tuple[float, float, float]]


@dataclass
class Drawn:
    people: Sequence[People3]
    size: tuple[int, int] = SIZE
    fps: float = 30.0

    @property
    def frame_count(self) -> int:
        return len(self.people)

    def frames(self) -> Iterator[tuple[int, float, Image]]:
        for index, people in enumerate(self.people):
            yield index, index / self.fps, draw_people(self.size, people)


def seen(people: Sequence[People3], size: tuple[int, int] = SIZE) -> People:
    clip = Clip(Path("drawn.mp4"), cast(Any, Drawn(people, size)))
    return run(find_people(clip, cast(Any, FakeNetwork()), 10_000))


def counts(people: People) -> list[int]:
    return [len(frame.pixel) for frame in people.frames]


def test_one_person_is_followed_over_the_ends_of_stretches() -> None:
    frames = STRETCH * 2 + 5
    clip = Clip(Path("x"), cast(Any, Drawn([[(90.0 + index, 120.0, 50.0)] for index in range(frames)])))
    progress: list[Progress] = []
    found = run(find_people(clip, cast(Any, FakeNetwork()), 10_000), progress.append)
    assert counts(found) == [1] * frames and found.size == SIZE
    truth = np.array([90.0 + frames - 1, 120.0]) + 50.0 * SHAPE
    np.testing.assert_allclose(found.frames[-1].pixel[0], truth, atol=2.0)
    assert [one.fraction for one in progress] == sorted(one.fraction for one in progress)


@pytest.mark.parametrize("frames", [1, 3])
def test_a_clip_of_few_frames(frames: int) -> None:
    assert counts(seen([[(160.0, 120.0, 50.0)]] * frames)) == [1] * frames


def test_somebody_who_comes_and_goes_is_seen_meanwhile_alone() -> None:
    """Frames before and after are empty, and the moment of coming is met backward from where it is looked."""
    there = range(30, 130)
    people: list[People3] = [[(160.0, 120.0, 50.0)] if index in there else [] for index in range(160)]
    assert counts(seen(people)) == [int(index in there) for index in range(160)]


def test_two_people_are_told_apart_and_a_tiny_one_is_left_out() -> None:
    people: list[People3] = [
        [(100.0 + 0.3 * index, 120.0, 45.0), (220.0, 120.0, 40.0), (300.0, 30.0, 6.0)] for index in range(60)
    ]
    assert set(counts(seen(people))) == {2}


def test_a_passer_by_of_another_size_who_meets_nobody_is_left_out() -> None:
    people: list[People3] = [[(160.0, 120.0, 40.0)]] * 60 + [[]] * 10
    people += [[(120.0 + 4 * index, 120.0, 80.0)] for index in range(26)]
    assert counts(seen(people)) == [1] * 60 + [0] * 36


def test_points_beyond_the_picture_are_not_seen() -> None:
    found = seen([[(20.0, 120.0, 50.0)]] * 5).frames[2]
    outside = np.isnan(found.pixel[0]).any(axis=1)
    assert outside.any() and not outside.all() and (found.score[0][outside] == 0.0).all()


def test_a_large_picture_is_found_in_its_own_pixels() -> None:
    found = seen([[(1300.0, 900.0, 350.0)]] * 2, (2600, 1800)).frames[0]
    np.testing.assert_allclose(np.nanmean(found.pixel[0] - 350.0 * SHAPE, axis=0), (1300.0, 900.0), atol=6.0)


def test_a_clip_without_anybody_is_one_sentence() -> None:
    with pytest.raises(InputError, match=r"drawn.mp4: nobody is seen in any of its 60 frames"):
        seen([[]] * 60)
    with pytest.raises(InputError, match="holds no frame"):
        seen([])
    clip = Clip(Path("long.mp4"), cast(Any, Drawn([[(160.0, 120.0, 50.0)]] * 60)))
    with pytest.raises(InputError, match=r"long.mp4: has more than 50 frames"):
        run(find_people(clip, cast(Any, FakeNetwork()), 50))
