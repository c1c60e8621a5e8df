"""Moments in which the performer is upright, to find the camera by, and whether the picture itself is.

A body of known height that is upright in several places on the floor measures the room. Nobody has looked
here whether it stands. So trunk and legs must lie in line and be as long as those of someone upright, and
single moments are doubted.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from ..arrays import Array, BoolArray, Image, IndexArray
from ..body.body_volume import standing_posture
from ..body.human import HUMAN
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import SIDES
from ..camera.camera_evidence import COMMON_LEAN_RAD, STATURE_STD, Uprights
from ..errors import InputError
from ..progress import run
from ..video.clip import Clip
from ..video.header import TURNS
from .keypoints import Keypoints, People
from .performer import principal_keypoints
from .pose_network import PoseNetwork
from .pose_tracking import find_people

IN_LINE = float(np.cos(np.radians(15.0)))  # cosine of the largest angle between trunk and legs
MOST_UNLIKE = 0.2  # logarithm of the ratio of legs to trunk, relative to that of someone upright


ON_ITS_SIDE = {
    (-1.0, 0.0): ("left of", "on its side, turn it by 90 degrees, as with ffmpeg -i CLIP -vf transpose=1"),
    (1.0, 0.0): ("right of", "on its side, turn it by 90 degrees, as with ffmpeg -i CLIP -vf transpose=2"),
    (0.0, 1.0): ("below", "upside down, turn it, as with ffmpeg -i CLIP -vf hflip,vflip"),
}
"""Ways from the feet to the head in a picture that was turned: where the head is, and what mends it."""
MOSTLY, FEWEST_LOOKS = 0.8, 10  # share and number of the frames in which it is so


def turned_note(keypoints: Keypoints) -> str | None:
    """A sentence where the picture may be on its side or upside down: the performer is, nearly always."""
    principal = principal_keypoints(keypoints)
    pixel = np.where((principal.score >= 0.3)[..., None], principal.pixel, np.nan)
    names = HUMAN.point_names
    feet = np.mean([pixel[:, names.index(f"ankle.{side}")] for side in SIDES], axis=0)
    up = pixel[:, names.index("head")] - feet
    seen = int(np.isfinite(up).all(axis=1).sum())
    for way, (where, remedy) in ON_ITS_SIDE.items():
        so = int(_along(up, np.array(way), float(np.cos(np.radians(30.0)))).sum())
        if seen >= FEWEST_LOOKS and so >= MOSTLY * seen:
            return (
                f"the performer's head is {where} the feet in {so} of {seen} frames: where the picture is "
                f"{remedy} turned.mp4"
            )
    return None


def standing_keypoints(keypoints: Keypoints, body: Body, fps: float) -> Uprights:
    """Moments in which the performer is upright, from the middle of the ankles to that of the head.

    The body is the performer's, or an average one of their height.
    """
    principal = principal_keypoints(keypoints)
    pixel = np.where((principal.score >= 0.3)[..., None], principal.pixel, np.nan)
    ankle, hip, shoulder = (
        np.mean([pixel[:, HUMAN.point_names.index(f"{part}.{side}")] for side in SIDES], axis=0)
        for part in ("ankle", "hip", "shoulder")
    )
    head = pixel[:, HUMAN.point_names.index("head")]
    points = body.points(body.pose(Posture.stack([standing_posture(body)])))[0]
    # Of each kind of point above the floor of someone upright [m].
    height = {name.split(".")[0]: float(z) for name, z in zip(HUMAN.point_names, points[:, 2], strict=True)}
    legs, trunk = hip - ankle, shoulder - hip
    usual = (height["hip"] - height["ankle"]) / (height["shoulder"] - height["hip"])
    straight = _along(legs, trunk, IN_LINE) & _along(trunk, head - shoulder, IN_LINE)
    # Whoever lies is in line as well.
    upright = straight & _along(head - ankle, np.array([0.0, -1.0]), float(np.cos(np.radians(30.0))))
    feet = pixel[:, [HUMAN.point_names.index(f"ankle.{side}") for side in SIDES], 1]
    with np.errstate(invalid="ignore"):
        # Ankles are level to a decimeter.
        upright &= np.abs(feet[:, 0] - feet[:, 1]) < 0.06 * np.linalg.norm(head - ankle, axis=-1)
    upright &= _on_floor(ankle[:, 1], np.linalg.norm(head - ankle, axis=-1), fps)
    chosen = _apart(upright & _as_long(legs, trunk, usual), fps)
    size = np.linalg.norm(head - ankle, axis=-1)[chosen]
    ones = np.ones(len(chosen))
    return Uprights(
        lower_px=ankle[chosen],
        upper_px=head[chosen],
        lower_m=height["ankle"] * ones,
        length_m=(height["head"] - height["ankle"]) * ones,
        pixel_std=0.025 * size,  # a detector's point, a rising heel
        length_std=0.025 * ones,  # knees bend, and the trunk leans
        lean_std_rad=float(np.radians(3.0)) * ones,
        common_std=float(np.hypot(STATURE_STD, 0.02)),  # detectors put ankles or heads too high throughout
        common_lean_rad=COMMON_LEAN_RAD,
        doubtful=True,
    )


def _along(first: Array, second: Array, least: float) -> BoolArray:
    """(F,) whether the cosine between directions (F, 2) is at least so large; not where one is unknown."""
    with np.errstate(invalid="ignore", divide="ignore"):
        cosine = (first * second).sum(-1) / (np.linalg.norm(first, axis=-1) * np.linalg.norm(second, axis=-1))
        return np.asarray(cosine > least)


def _on_floor(row: Array, size: Array, fps: float) -> BoolArray:
    """(F,) whether the feet's row (F,) hardly changes about each frame, beside the body's size (F,) [px]."""
    # Who leaves the floor falls by 0.3 m in a quarter second, a fifth of the length from ankles to head; who
    # walks toward the camera comes down in the picture by less than an eighth of it.
    reach = max(1, round(0.25 * fps))
    padded = np.pad(row, reach, constant_values=np.nan)
    near = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1)
    with np.errstate(invalid="ignore"):
        apart = np.nanmax(np.where(np.isfinite(near), np.abs(near - row[:, None]), 0.0), axis=1)
        return np.asarray(apart < 0.12 * size)


def _as_long(legs: Array, trunk: Array, usual: float) -> BoolArray:
    """(F,) whether legs are as long relative to the trunk as when they are straight.

    A camera that looks down on the performer and a detector with hips of its own change that ratio in the
    whole clip; a median that differs more than they can is one of bent legs.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = np.log(np.linalg.norm(legs, axis=-1) / np.linalg.norm(trunk, axis=-1) / usual)
    known = np.isfinite(ratio)
    if not known.any():
        return known
    middle = float(np.clip(np.median(ratio[known]), -MOST_UNLIKE, MOST_UNLIKE))
    return np.asarray(known & (np.abs(np.where(known, ratio, np.inf) - middle) < 0.5 * MOST_UNLIKE))


def _apart(usable: BoolArray, fps: float) -> IndexArray:
    step = max(1, round(0.3 * fps))  # seconds, half a step
    chosen: list[int] = []
    for index in np.flatnonzero(usable):
        if not chosen or index - chosen[-1] >= step:
            chosen.append(int(index))
    return np.array(chosen, dtype=np.intp)


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
