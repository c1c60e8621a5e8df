"""Where a performer stands: the ankles' height over the floor, and the place of a body before any pose."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, BoolArray, IndexArray
from ..body.body_volume import hip_height_m, sole_heights_m, standing_posture
from ..body.human import ANKLES, HUMAN
from ..body.kinematics import Body
from ..body.posture import Posture, facing_rad
from ..body.skeleton import SIDES
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints
from ..detect.performer import principal_keypoints
from ..errors import InputError
from ..markers.region_tracks import RegionTracks
from ..terms.region_model import MarkerPlacement, RegionModel

TOUCHING_PERCENT = 30.0  # of the lowest soles, the floor: more than half touch it, but for runners
SHOE_M = 0.012  # thickness of a shoe's sole, and of a heel that hardly ever lies wholly on the floor
ANKLE_HEIGHT_STD_M = 0.03
SAME_FLOOR_M = 0.12  # ankles that stand within this of a given floor stand on it


def standing_ankle_m(body: Body) -> float:
    """Height of the ankles of someone who stands in shoes [m]."""
    pose = body.pose(Posture.rest(body.skeleton))
    ankle = body.points(pose)[ANKLES[0], 2]
    return float(ankle - sole_heights_m(body, pose).min()) + SHOE_M


def feet_over_floor_m(body: Body, points: Array, floor_m: float) -> float:
    """How high the lower foot is over a floor at its lowest, of points (F, P, 3) [m]; steps lead up."""
    # 5.0: of the feet's heights, their lowest but for outliers
    lowest = np.nanpercentile(points[:, ANKLES, 2].min(axis=1), 5.0)
    return float(lowest - floor_m - standing_ankle_m(body))


def found_ankle_m(
    body: Body, found: Posture, index: IndexArray, frames: int, floor_m: float | None = None
) -> Array:
    """(F,) height of the lower ankle [m] in postures whose ankles are where the footage has them.

    Their rigid feet may point into the floor, so that their soles tell nothing of it.

    `found`: K postures put together from parts and held against the footage, at `index` (K,), in order;
    `floor_m`: by the ankles themselves where None.
    """
    points = body.points(body.pose(found))
    lower = points[:, ANKLES, 2].min(axis=-1)
    standing = float(np.percentile(lower, TOUCHING_PERCENT))
    if floor_m is not None and abs(standing - floor_m - standing_ankle_m(body)) < SAME_FLOOR_M:
        standing = floor_m + standing_ankle_m(body)
    return np.asarray(standing + np.interp(np.arange(frames), index, np.maximum(lower - standing, 0.0)))


# --- A standing performer, before any keyframe is posed


FILLED_SHARE = 0.7  # share of the picture's height that a body fills where no region is seen
LEAST_HEIGHT_PX = 20.0
TRUNK = ("trunk", "chest", "pelvis")
PAIR_SPANS = {("shoulder", "hip"): 0.12, ("hip", "ankle"): 0.1, ("shoulder", "ankle"): 0.08}
"""Standard deviation of a distance by that of two pairs of keypoints in the picture, as a share: trunks lean,
knees bend, and detectors have hips and shoulders elsewhere."""
LIMB_SPANS = {
    ("hip", "knee"): 0.12,
    ("knee", "ankle"): 0.1,
    ("shoulder", "elbow"): 0.15,
    ("elbow", "wrist"): 0.15,
}  # the same by single limbs, of which one lies across the view even in someone who bends or sits
_TRUNK_POINTS = np.array([name.split(".")[0] in ("hip", "shoulder") for name in HUMAN.point_names])


def place_standing(
    body: Body,
    camera: Camera,
    frame: int = 0,
    regions: RegionTracks | None = None,
    segments: tuple[str, ...] = (),
    keypoints: Keypoints | None = None,
) -> Posture:
    """A body that stands upright where the performer is, facing the camera.

    `regions` and `keypoints` are those of this frame alone; markers are not asked where hips or shoulders are
    seen. Where nothing is seen, the body goes to the picture's middle.
    """
    rotation, _ = camera.pose(frame)
    heading = facing_rad(rotation[:, 2])  # the camera looks along its -Z
    standing = standing_posture(body, heading_rad=heading)
    seen = None if keypoints is None else principal_keypoints(keypoints).pixel[0]
    if seen is not None and np.isfinite(seen[_TRUNK_POINTS]).any():
        known = _TRUNK_POINTS & np.isfinite(seen).all(axis=-1)

        def by_points(there: Posture) -> tuple[Array, float]:
            shown, _ = camera.project(body.points(body.pose(there)), frame)
            return _center(shown, known), _relative_span(shown, seen)

        return _by_size(body, camera, frame, standing, _center(seen, known), by_points)
    if regions is None:
        return _in_the_middle(body, camera, frame, standing)
    usable = regions.visible[0] & ~regions.clipped[0]
    trunk = usable & _bound(segments, *TRUNK)
    usable = trunk if trunk.any() else usable
    if not usable.any():
        return _in_the_middle(body, camera, frame, standing)
    model = RegionModel(body, camera, tuple(MarkerPlacement.usual(segment) for segment in segments))
    centroid, area = regions.centroid[0], regions.area[0]

    def by_regions(there: Posture) -> tuple[Array, float]:
        shown = model.evaluate(body.pose(Posture.stack([there])), np.array([frame]))
        ratio = _relative_size(segments, usable, shown.centroid[0], shown.area[0], centroid, area)
        return _center(shown.centroid[0], usable), ratio

    return _by_size(body, camera, frame, standing, _center(centroid, usable), by_regions)


def _by_size(
    body: Body,
    camera: Camera,
    frame: int,
    standing: Posture,
    center: Array,
    shown_from: Callable[[Posture], tuple[Array, float]],
) -> Posture:
    """The standing body where it is as large in the picture as what was seen.

    `center` (2,) is the middle of what was seen [px]; `shown_from` gives the middle of the same of a body
    that stands somewhere, and the ratio of its size to the one seen.
    """
    _, location = camera.pose(frame)
    _, direction = camera.rays(center, frame)
    distance, offset = _usual_distance(body, camera), np.zeros(3)
    for _ in range(6):
        shown, ratio = shown_from(_at(standing, location + distance * direction))
        if not np.isfinite([*shown, ratio]).all():  # so near that the camera is within the body
            break
        # What is seen has its middle off the hips, by the same offset there as here.
        _, ray = camera.rays(shown, frame)
        offset = (ray - direction) * distance
        distance = max(distance * float(np.clip(ratio, 0.25, 4.0)), 0.3)
    return _at(standing, _on_floor(location + distance * direction - offset, direction, distance, body))


def _relative_span(shown: Array, seen: Array) -> float:
    """Ratio of the predicted size to the observed one, by trunk, legs and limbs; 1 without any."""
    spans = [(_points(first), _points(second), error) for (first, second), error in PAIR_SPANS.items()]
    for (first, second), error in LIMB_SPANS.items():
        sides = zip(_points(first), _points(second), strict=True)
        spans += [([near], [far], error) for near, far in sides]
    logarithms, errors = [], []
    for near, far, error in spans:
        of_shown, of_seen = (
            float(np.linalg.norm(pixel[near].mean(axis=0) - pixel[far].mean(axis=0)))
            for pixel in (shown, seen)
        )
        if np.isfinite([of_shown, of_seen]).all():
            logarithms.append(np.log(max(of_shown, 1.0) / max(of_seen, 1.0)))
            errors.append(error)
    return _largest_size(np.array(logarithms), np.array(errors)) if logarithms else 1.0


def _points(part: str) -> list[int]:
    return [HUMAN.point_names.index(f"{part}.{side}") for side in SIDES]


def _on_floor(hips: Array, direction: Array, distance: float, body: Body) -> Array:
    """Hips where sizes have them, moved along the line of sight toward the floor."""
    above_m, down = float(hips[2]) - hip_height_m(body), float(direction[2])
    # 0.08: standard deviation of a distance by size in the picture, as a share
    variance = (0.08 * distance) ** 2
    # 0.05: standard deviation of the soles' height above the floor [m]
    spread = 0.05**2 + variance * down**2
    # 3.0: standard deviations beyond which the ground is not at z = 0
    if above_m**2 > 3.0**2 * spread:
        return hips
    return hips - above_m * down * variance / spread * direction


def ground_place(
    camera: Camera, frame: int, stature_m: float, crown_px: ArrayLike, ground_px: ArrayLike
) -> Array:
    """The ground, (3,) in the world [m], between the feet of someone who stands there upright.

    `crown_px` and `ground_px` (2,): top of the head, and the ground between the feet [px].

    Raises:
        InputError: The two points in the picture cannot be a person's.
    """
    crown, ground = np.asarray(crown_px, dtype=np.float64), np.asarray(ground_px, dtype=np.float64)
    if np.linalg.norm(crown - ground) < LEAST_HEIGHT_PX:
        raise InputError(
            f"top of the head and ground are {np.linalg.norm(crown - ground):.0f} pixels apart in the "
            f"picture; at least {LEAST_HEIGHT_PX:.0f} are needed to measure by"
        )
    location, up = camera.rays(crown, frame)
    _, down = camera.rays(ground, frame)
    # Both lines of sight meet a vertical of the body's height: a down + (0, 0, height) = b up.
    vertical = np.array([0.0, 0.0, stature_m])
    far, *_ = np.linalg.lstsq(np.stack([-down, up], axis=1), vertical, rcond=None)
    if not (np.isfinite(far).all() and far.min() > 0.0):
        raise InputError(
            "the top of the head lies below the ground in the picture; pick the top of the head first, then "
            "the ground between the feet"
        )
    return np.asarray(location + far[0] * down)


def _bound(segments: tuple[str, ...], *parts: str) -> BoolArray:
    return np.array([segment.split(".")[0] in parts for segment in segments])


def _center(centroid: Array, known: BoolArray) -> Array:
    return np.asarray(centroid[known].mean(axis=0))


def _relative_size(
    segments: tuple[str, ...],
    known: BoolArray,
    shown: Array,
    shown_area: Array,
    seen: Array,
    seen_area: Array,
) -> float:
    """Ratio of the body's predicted size in the picture to its observed size; NaN where none is predicted.

    Each region's area gives a ratio, and a better one, where they are seen, the distance of the shins below
    the trunk: sleeves and clothes do not change that. Occlusion, bending or turning away makes a size
    smaller, never larger, than in someone who stands. So sizes that fall short of the largest by more than
    their errors are left out.
    """
    shins = np.isfinite(seen_area) & _bound(segments, "shin")
    measured = (known | shins) & (shown_area > 0.0)
    if not measured.any():
        return np.nan
    logarithms = 0.5 * np.log(shown_area[measured] / seen_area[measured])
    # 0.12: The same by a region's area (bodies turn, sleeves differ), by the trunk's height over the shins
    # (knees bend).
    errors = np.where(_bound(segments, *TRUNK), 0.12, 0.2)[measured]
    trunk = known & _bound(segments, *TRUNK)
    if trunk.any() and shins.sum() == 2:
        apart = [float(np.linalg.norm(_center(p, trunk) - _center(p, shins))) for p in (shown, seen)]
        logarithms = np.append(logarithms, np.log(max(apart[0], 1.0)) - np.log(max(apart[1], 1.0)))
        # 0.08: by the trunk's height over the shins
        errors = np.append(errors, 0.08)
    return _largest_size(logarithms, errors)


def _largest_size(logarithms: Array, errors: Array) -> float:
    """Ratio by all sizes that agree with the largest, given the logarithms of each one's ratio."""
    nearest = int(np.argmin(logarithms))
    # 1.5: largest difference, in standard deviations, of sizes that agree on a distance
    fits = logarithms - logarithms[nearest] <= 1.5 * np.hypot(errors, errors[nearest])
    return float(np.exp(np.average(logarithms[fits], weights=errors[fits] ** -2)))


def _usual_distance(body: Body, camera: Camera) -> float:
    """Distance at which the body fills the usual share of the picture's height [m]."""
    return body.actor.stature_m * camera.focal_px / (FILLED_SHARE * camera.resolution[1])


def _in_the_middle(body: Body, camera: Camera, frame: int, standing: Posture) -> Posture:
    """Upright in the middle of the picture; on the floor where that leaves the body in the picture."""
    _, direction = camera.rays(np.array(camera.resolution) / 2.0, frame)
    _, location = camera.pose(frame)
    middle = location + _usual_distance(body, camera) * direction
    stature = body.actor.stature_m
    hips = middle + np.array([0.0, 0.0, hip_height_m(body) - 0.5 * stature])
    soles = float(hips[2]) - hip_height_m(body)
    off_the_picture = 0.5 * (1.0 / FILLED_SHARE - 1.0) * stature
    if abs(soles) <= off_the_picture:
        hips[2] -= soles
    return _at(standing, hips)


def _at(posture: Posture, hips: Array) -> Posture:
    return Posture(posture.skeleton, hips, posture.rotations, posture.angles)
