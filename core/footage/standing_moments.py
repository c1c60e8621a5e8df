"""Moments in which the performer stands or walks upright, by keypoints or markers, to find the camera by.

A body of known height that is upright in several places on the floor measures the room. Nobody has looked
here whether it stands. So trunk and legs must lie in line and be as long as those of someone upright, and
single moments are doubted.
"""

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.human import HUMAN
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import SIDES
from ..body.standing_posture import standing_posture
from .camera_evidence import COMMON_LEAN_RAD, STATURE_STD, Uprights
from .keypoints.keypoints import Keypoints
from .keypoints.principal_keypoints import principal_keypoints
from .region_tracks import RegionTracks

APART_S = 0.3
"""Time after which a posture is another one: half a step of someone who walks."""
SURE = 0.3
"""Least confidence of a keypoint."""
PIXEL_SHARE = 0.025
"""Standard deviation of a detector's point, and of a rising heel, as a share from ankles to head."""
LEVEL_SHARE = 0.06
"""Largest difference of both ankles' heights in the picture, as such a share: a decimeter."""
LENGTH_STD, LEAN_STD_RAD = 0.025, float(np.radians(3.0))
"""Of someone who walks: knees bend, heels rise, and the trunk leans."""
DETECTOR_STD = 0.02
"""Share by which detectors put ankles and head too high or too low throughout."""
IN_LINE = float(np.cos(np.radians(15.0)))
"""Cosine of the largest angle between trunk and legs."""
PLUMB = float(np.cos(np.radians(30.0)))
"""The same between the body and the picture's vertical: whoever lies is in line as well."""
FLIGHT_S, FLIGHT_SHARE = 0.25, 0.12
"""Whoever leaves the floor falls by 0.3 m in a quarter second, a fifth of the length from ankles to head; who
walks toward the camera comes down in the picture by less than these shares in that time."""
MOST_UNLIKE = 0.2
"""Largest logarithm of the ratio of legs to trunk, relative to that of someone upright in the same clip."""
REGION_STD_PX = 1.0
REGION_COMMON_STD = 0.06
"""Share by which sleeves and shirts put the middles of trunk and shins too high or too low."""


def standing_keypoints(keypoints: Keypoints, body: Body, fps: float) -> Uprights:
    """Moments in which the performer is upright, from the middle of the ankles to that of the head.

    Args:
        keypoints: The performer's.
        body: The performer's body, or an average one of their height.
        fps: Frames per second.
    """
    principal = principal_keypoints(keypoints)
    pixel = np.where((principal.score >= SURE)[..., None], principal.pixel, np.nan)
    ankle, hip, shoulder = (_middle(pixel, part) for part in ("ankle", "hip", "shoulder"))
    head = pixel[:, HUMAN.point_names.index("head")]
    height = _heights(body)
    legs, trunk = hip - ankle, shoulder - hip
    usual = (height["hip"] - height["ankle"]) / (height["shoulder"] - height["hip"])
    straight = _along(legs, trunk, IN_LINE) & _along(trunk, head - shoulder, IN_LINE)
    upright = straight & _along(head - ankle, np.array([0.0, -1.0]), PLUMB)
    feet = pixel[:, [HUMAN.point_names.index(f"ankle.{side}") for side in SIDES], 1]
    with np.errstate(invalid="ignore"):
        upright &= np.abs(feet[:, 0] - feet[:, 1]) < LEVEL_SHARE * np.linalg.norm(head - ankle, axis=-1)
    upright &= _on_floor(ankle[:, 1], np.linalg.norm(head - ankle, axis=-1), fps)
    chosen = _apart(upright & _as_long(legs, trunk, usual), fps)
    size = np.linalg.norm(head - ankle, axis=-1)[chosen]
    heights_m, common_std = (height["ankle"], height["head"]), float(np.hypot(STATURE_STD, DETECTOR_STD))
    return _uprights(ankle[chosen], head[chosen], heights_m, PIXEL_SHARE * size, common_std)


def standing_regions(tracks: RegionTracks, segments: tuple[str, ...], body: Body, fps: float) -> Uprights:
    """The same by the regions of markers on trunk and both shins; none where these are not worn.

    Args:
        tracks: The markers' regions.
        segments: The segment each marker is bound to.
        body: As above.
        fps: Frames per second.
    """
    wanted = ("trunk", *(f"shin.{side}" for side in SIDES))
    if not set(wanted) <= set(segments):
        return Uprights.none()
    columns = [segments.index(segment) for segment in wanted]
    whole = (tracks.visible & ~tracks.clipped)[:, columns].all(axis=1)
    centroid = tracks.centroid[:, columns]
    shins, trunk = centroid[:, 1:].mean(axis=1), centroid[:, 0]
    size = np.linalg.norm(trunk - shins, axis=-1)
    # Shins lie in line where both are plumb; of someone who bends or sits the trunk comes nearer to them.
    level = np.abs(centroid[:, 1, 1] - centroid[:, 2, 1]) < MOST_UNLIKE * size
    level &= _along(trunk - shins, np.array([0.0, -1.0]), PLUMB)
    tall = size > np.exp(-MOST_UNLIKE) * np.nanmax(np.where(whole, size, np.nan)) if whole.any() else whole
    on_floor = _on_floor(shins[:, 1], size, fps)
    chosen = _apart(whole & level & np.asarray(tall) & on_floor, fps)
    height = _heights(body)
    middle_m = 0.5 * (height["knee"] + height["ankle"]), 0.5 * (height["hip"] + height["shoulder"])
    pixel_std = np.maximum(REGION_STD_PX, PIXEL_SHARE * size[chosen])
    common_std = float(np.hypot(STATURE_STD, REGION_COMMON_STD))
    return _uprights(shins[chosen], trunk[chosen], middle_m, pixel_std, common_std)


def _uprights(
    lower_px: Array, upper_px: Array, heights_m: tuple[float, float], pixel_std: Array, common_std: float
) -> Uprights:
    """One body at N moments, by two of its points.

    Args:
        lower_px: (N, 2) the lower one [px].
        upper_px: (N, 2) the one above it [px].
        heights_m: Height of each above the floor [m].
        pixel_std: (N,) standard deviation of a point [px].
        common_std: Share by which all lengths may be off together.
    """
    ones, (lower_m, upper_m) = np.ones(len(pixel_std)), heights_m
    return Uprights(
        lower_px,
        upper_px,
        lower_m * ones,
        (upper_m - lower_m) * ones,
        pixel_std,
        LENGTH_STD * ones,
        LEAN_STD_RAD * ones,
        common_std=common_std,
        common_lean_rad=COMMON_LEAN_RAD,
        doubtful=True,
    )


def _heights(body: Body) -> dict[str, float]:
    """Height of each kind of principal point above the floor of someone upright [m]."""
    points = body.points(body.pose(Posture.stack([standing_posture(body)])))[0]
    named = zip(HUMAN.point_names, points[:, 2], strict=True)
    return {name.split(".")[0]: float(height) for name, height in named}


def _middle(pixel: Array, part: str) -> Array:
    left, right = (HUMAN.point_names.index(f"{part}.{side}") for side in SIDES)
    return np.asarray(0.5 * (pixel[:, left] + pixel[:, right]))


def _along(first: Array, second: Array, least: float) -> BoolArray:
    """(F,) whether the cosine between directions (F, 2) is at least so large; not where one is unknown."""
    with np.errstate(invalid="ignore", divide="ignore"):
        cosine = (first * second).sum(-1) / (np.linalg.norm(first, axis=-1) * np.linalg.norm(second, axis=-1))
        return np.asarray(cosine > least)


def _on_floor(row: Array, size: Array, fps: float) -> BoolArray:
    """(F,) whether the feet's row (F,) in the picture hardly changes about each frame.

    Args:
        row: Their rows [px].
        size: (F,) length of the body in the picture [px].
        fps: Frames per second.
    """
    reach = max(1, round(FLIGHT_S * fps))
    padded = np.pad(row, reach, constant_values=np.nan)
    near = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1)
    with np.errstate(invalid="ignore"):
        apart = np.nanmax(np.where(np.isfinite(near), np.abs(near - row[:, None]), 0.0), axis=1)
        return np.asarray(apart < FLIGHT_SHARE * size)


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
    """Indices of usable frames, as many as differ from each other."""
    step = max(1, round(APART_S * fps))
    chosen: list[int] = []
    for index in np.flatnonzero(usable):
        if not chosen or index - chosen[-1] >= step:
            chosen.append(int(index))
    return np.array(chosen, dtype=np.intp)
