"""Moments in which the performer stands or walks upright, by keypoints, to find the camera by.

A body of known height that is upright in several places on the floor measures the room. Nobody has looked
here whether it stands. So trunk and legs must lie in line and be as long as those of someone upright, and
single moments are doubted.
"""

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.body_volume import standing_posture
from ..body.human import HUMAN
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import SIDES
from ..camera.camera_evidence import COMMON_LEAN_RAD, STATURE_STD, Uprights
from .keypoints import Keypoints
from .performer import principal_keypoints

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
