"""Whether a clip's picture is on its side or upside down: people are followed a moment in each of four turns.

In single pictures the network sees somebody upright whichever way they are turned; followed for a second,
only people who are there stay, as upright as they are.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from ..arrays import Array, Image
from ..errors import InputError
from ..progress import run
from ..video.clip import Clip
from ..video.turned import TURNS
from .keypoints import People
from .pose_network import PoseNetwork
from .pose_tracking import find_people

MOMENT_S = 0.8  # for which people are followed
MOMENTS = (0.3, 0.7)  # in shares of the clip
SURER = 1.3  # how many times surer another turn must be
PROPPED = 0.5
"""How far before the trunk both wrists are, in lengths of it, of somebody who is propped on the hands."""


class _Moment:
    """Some frames of a clip, turned: a `FrameSource`."""

    def __init__(self, clip: Clip, turn_deg: int, first: int, frame_count: int) -> None:
        self._clip, self._turn_deg, self._first = clip, turn_deg, first
        self.size = clip.size[::-1] if turn_deg % 180 else clip.size
        self.fps, self.frame_count = clip.fps, frame_count

    def frames(self) -> Iterator[tuple[int, float, Image]]:
        indices = range(self._first, self._first + self.frame_count)
        for number, (_, image) in enumerate(self._clip.source.at(indices)):
            yield number, number / self.fps, np.ascontiguousarray(np.rot90(image, -(self._turn_deg // 90)))

    def time_stamps(self) -> Iterator[float]:
        yield from (number / self.fps for number in range(self.frame_count))

    def at(self, indices: Sequence[int]) -> Iterator[tuple[int, Image]]:
        yield from ((index, image) for index, _, image in self.frames() if index in indices)

    def onward(self, first: int) -> Iterator[tuple[float, Image]]:
        yield from ((stamp, image) for index, stamp, image in self.frames() if index >= first)


def picture_turn(clip: Clip, network: PoseNetwork) -> int:
    """By how many degrees clockwise a clip must be turned so that people are upright; 0 where none is surer.

    Somebody who props on the hands is taken to lie, and the picture to be upright.
    """
    length = max(2, min(round(MOMENT_S * clip.fps), clip.frame_count // 2))
    sure = dict.fromkeys(TURNS, 0.0)
    for turn_deg in TURNS:
        for share in MOMENTS:
            first = round(share * (clip.frame_count - length))
            moment = Clip(clip.path, _Moment(clip, turn_deg, first, length))
            try:
                people = run(find_people(moment, network))
            except InputError:  # nobody is seen
                continue
            sure[turn_deg] += _upright(people, turn_deg % 180 > 0)
    best = max(TURNS, key=lambda turn: sure[turn])
    return best if sure[best] > SURER * sure[0] else 0


def _upright(people: People, on_side: bool) -> float:
    """How surely the surest of the people of each frame are upright, in frames."""
    number = people.names.index
    ends = [number(name) for name in ("shoulder.L", "shoulder.R", "hip.L", "hip.R", "wrist.L", "wrist.R")]
    total = 0.0
    for frame in people.frames:
        values = [0.0]
        for pixel, score in zip(frame.pixel, frame.score, strict=True):
            trunk, aside = _trunk(pixel[ends])
            propped = on_side and (min(aside) > PROPPED or max(aside) < -PROPPED)
            values.append(0.0 if propped else float(score.mean()) * max(float(np.nan_to_num(trunk)), 0.0))
        total += max(values)
    return total


def _trunk(pixel: Array) -> tuple[float, list[float]]:
    """How upright a trunk is, as a cosine, and how far both wrists are beside its line, in lengths of it."""
    top, down = pixel[:2].mean(axis=0), pixel[2:4].mean(axis=0)
    trunk = down - top
    length = max(float(np.hypot(*trunk)), 1e-9)
    across = np.array([-trunk[1], trunk[0]]) / length**2
    return float(trunk[1]) / length, [float((wrist - top) @ across) for wrist in pixel[4:]]
