"""A detector of keypoints with the errors of real ones, made from the truth: seeded, so always the same.

Its errors are those that networks make on footage, as shares
of the performer's height in the picture, since networks see people in pictures of one size:

* its points lie beside the joints, always at about the same place of the segment;
* a slow error, alike for many frames, and a jitter from frame to frame, both larger at hands and feet;
* points that are hidden by the body are guessed, with a low score, and now and then nobody is found at all;
* left and right limbs are mistaken for each other for some frames;
* its guess of depth is too shallow, off by a length of its own for each point, and wanders by 6 to 18 cm.
"""

from dataclasses import dataclass

import numpy as np
from keymark.core.arrays import Array, BoolArray
from keymark.core.body.body_volume import sole_offsets
from keymark.core.camera.camera import Camera
from keymark.core.detect.keypoints import People, SeenPeople, mirrored_point
from scipy.signal import lfilter

from .performance import Performance, principal_points

NAME = "the studio's detector"
SIDES = ("L", "R")
POINTS = (
    "nose",
    *(
        f"{part}.{side}"
        for part in ("ear", "shoulder", "elbow", "wrist", "index", "hip", "knee", "ankle", "heel", "toe")
        for side in SIDES
    ),
)
FAR_OUT = ("wrist", "index", "ankle", "heel", "toe")
"""Parts that networks find less well."""
FAR_OUT_FACTOR = 1.5
NOSE_M, EAR_M = (0.0, -0.11, -0.01), (0.075, 0.0, 0.0)
"""From the middle of the head, in its frame: the performer faces -Y, and the left is +X."""
KNUCKLE = 0.5
"""Of the way from the wrist to the finger tips."""
PLACE_M = 0.012
"""Standard deviation, along each axis, of a point's place on its segment from the joint."""
UNEVEN = 0.4
"""Of the same, between left and right, which are otherwise alike."""
SLOW, JITTER = 0.008, 0.003
"""Standard deviations of a point's error along each axis of the picture, as shares of the height."""
SLOW_FRAMES = 15.0
LAG_FRAMES = 0.4
"""By how much a point is behind where it moves, since networks smooth."""
HIDDEN_FACTOR = 2.5
SCORE, HIDDEN_SCORE = 0.93, 0.35
SCORE_SPREAD = 0.05
FARTHER_M = 0.05
"""By so much a point must lie behind a limb to be hidden by it."""
LIMBS = {
    **{
        f"{part}.{side}": radius
        for part, radius in (("upper_arm", 0.05), ("forearm", 0.04))
        for side in SIDES
    },
    **{f"{part}.{side}": radius for part, radius in (("thigh", 0.075), ("shin", 0.05)) for side in SIDES},
}
"""Radii of the limbs [m]."""
TRUNK_M = 0.14
SWAPS_A_FRAME, SWAP_FRAMES = 1 / 40, (2, 7)
"""How often a pair of arms or legs that are near each other is exchanged, and for how many frames."""
SWAP_NEAR = 0.2
"""How near each other they are in the picture, as a share of the height."""
SWAPPED = (("elbow", "wrist", "index"), ("hip", "knee", "ankle", "heel", "toe"))
LOSSES_A_FRAME, LOSS_FRAMES = 1 / 80, (1, 3)
"""How often nobody is found, and for how many frames."""
DROPPED = 0.06
"""Share of the hidden points that are not told at all."""
DEPTH_GAIN = 0.85
DEPTH_OFFSET_M, DEPTH_WANDER_M, DEPTH_FRAMES = 0.05, (0.06, 0.18), 25.0
SIDEWAYS_M = 0.02
"""Standard deviation of a guess in space, across the line of sight."""
PIXEL_DIGITS, SCORE_DIGITS, METER_DIGITS = 1, 2, 2


@dataclass(frozen=True, eq=False)
class _Truth:
    """What there is to see."""

    places: Array
    """(F, N, 3) the points in the camera's frame: x right, y down, z away from it [m]."""
    pixel: Array
    """(F, N, 2)."""
    height_px: Array
    """(F,) the performer's height in the picture."""
    hidden: BoolArray
    """(F, N) whether another part of the body is before a point."""


def detect(performance: Performance, camera: Camera, random: np.random.Generator) -> People:
    """What the detector says of a performance.

    Args:
        performance: The truth.
        camera: The clip's camera, which stands still.
        random: Source of the errors.
    """
    truth = _truth(performance, camera, random)
    far_out = np.array([FAR_OUT_FACTOR if name.split(".")[0] in FAR_OUT else 1.0 for name in POINTS])
    factor = far_out * np.where(truth.hidden, HIDDEN_FACTOR, 1.0) * truth.height_px[:, None]
    frames, count = truth.hidden.shape
    slow = SLOW * _wander(frames, (count, 2), SLOW_FRAMES, random)
    jitter = JITTER * random.standard_normal((frames, count, 2))
    moved = np.gradient(truth.pixel, axis=0)
    pixel = truth.pixel - LAG_FRAMES * moved + factor[..., None] * (slow + jitter)
    score = np.where(truth.hidden, HIDDEN_SCORE, SCORE) + SCORE_SPREAD * random.standard_normal(
        (frames, count)
    )
    score = np.clip(score, 0.05, 0.99)
    hint = _hints(truth, random)
    lost = truth.hidden & (random.random((frames, count)) < DROPPED)
    pixel[lost], score[lost], hint[lost] = np.nan, 0.0, np.nan
    for limbs in SWAPPED:
        near = _near_each_other(truth, limbs)
        for rows in _stretches(frames, SWAPS_A_FRAME, SWAP_FRAMES, random):
            if near[rows.start]:
                _swap(rows, limbs, pixel, score, hint)
    outside = ((pixel < 0.0) | (pixel > np.array(camera.resolution))).any(axis=-1)
    pixel[outside], score[outside], hint[outside] = np.nan, 0.0, np.nan
    pixel, score = np.round(pixel, PIXEL_DIGITS), np.round(score, SCORE_DIGITS)
    hint = np.round(hint, METER_DIGITS)
    seen = [SeenPeople(pixel[[row]], score[[row]], hint[[row]]) for row in range(frames)]
    nobody = SeenPeople(pixel[:0], score[:0], hint[:0])
    for rows in _stretches(frames, LOSSES_A_FRAME, LOSS_FRAMES, random):
        seen[rows] = [nobody] * len(seen[rows])
    return People(POINTS, NAME, camera.resolution, tuple(seen))


def _truth(performance: Performance, camera: Camera, random: np.random.Generator) -> _Truth:
    """The detector's own points of the body, which lie beside the joints."""
    body, rows = performance.body, performance.middles
    pose = body.pose(performance.postures[rows])
    points = principal_points(performance, rows)
    joints = dict(zip(body.skeleton.point_names, np.swapaxes(points, 0, 1), strict=True))
    turns = {joint.name: pose.rotation[:, index] for index, joint in enumerate(body.skeleton.joints)}
    joints["nose"] = joints["head"] + turns["neck"] @ np.array(NOSE_M)
    soles = sole_offsets(body)
    for side, out, (heel, toe) in zip(SIDES, (1.0, -1.0), soles, strict=True):
        foot = performance.feet[side][rows]
        joints[f"ear.{side}"] = joints["head"] + turns["neck"] @ (out * np.array(EAR_M))
        wrist, tip = body.segment_ends(pose, f"hand.{side}")
        joints[f"index.{side}"] = wrist + KNUCKLE * (tip - wrist)
        joints[f"heel.{side}"] = joints[f"ankle.{side}"] + foot @ heel
        joints[f"toe.{side}"] = joints[f"ankle.{side}"] + foot @ toe
    beside = _places_beside(random)
    world = np.stack([joints[name] + turns[_carrier(name)] @ beside[name] for name in POINTS], axis=1)
    to_camera = np.linalg.inv(camera.matrix_world)
    seen = (world @ to_camera[:3, :3].T + to_camera[:3, 3]) * [1.0, -1.0, -1.0]
    pixel, _ = camera.project(world)
    stature = sum(body.actor.segments_m[name] for name in ("neck_head", "trunk", "thigh.L", "shin.L"))
    height = stature * camera.focal_px / seen[..., 2].mean(axis=-1)
    limbs = [
        (*_camera_ends(body.segment_ends(pose, name), to_camera), radius) for name, radius in LIMBS.items()
    ]
    middle = [0.5 * (joints[f"{part}.L"] + joints[f"{part}.R"]) for part in ("hip", "shoulder")]
    limbs.append((*_camera_ends((middle[0], middle[1]), to_camera), TRUNK_M))
    hidden = np.any([_behind(seen, *limb) for limb in limbs], axis=0)
    return _Truth(seen, np.asarray(pixel), height, hidden)


def _carrier(name: str) -> str:
    """The joint whose frame a point lies in."""
    part, _, side = name.partition(".")
    if part in ("nose", "ear"):
        return "neck"
    if part in ("shoulder", "hip"):
        return "waist" if part == "shoulder" else "pelvis"
    stem = {"elbow": "shoulder", "wrist": "forearm", "index": "forearm"}.get(part, "knee")
    return f"{'hip' if part == 'knee' else stem}.{side}"


def _places_beside(random: np.random.Generator) -> dict[str, Array]:
    """Where the detector sees each point, from the point itself, in the frame of its segment [m]."""
    places: dict[str, Array] = {}
    for name in POINTS:
        twin = mirrored_point(name)
        if twin in places and twin != name:
            own = UNEVEN * PLACE_M * random.standard_normal(3)
            places[name] = places[twin] * [-1.0, 1.0, 1.0] + own
        else:
            places[name] = PLACE_M * random.standard_normal(3)
    return places


def _camera_ends(ends: tuple[Array, Array], to_camera: Array) -> tuple[Array, Array]:
    first, last = ((end @ to_camera[:3, :3].T + to_camera[:3, 3]) * [1.0, -1.0, -1.0] for end in ends)
    return first, last


def _behind(points: Array, first: Array, last: Array, radius: float) -> BoolArray:
    """(F, N) whether each point lies behind a limb between two ends, as seen from the camera."""
    point, start, end = (place[..., :2] / place[..., 2:] for place in (points, first, last))
    along = (end - start)[:, None]
    share = np.sum((point - start[:, None]) * along, axis=-1) / np.maximum(np.sum(along**2, axis=-1), 1e-9)
    share = np.clip(share, 0.0, 1.0)[..., None]
    depth = first[:, None, 2:] + share * (last - first)[:, None, 2:]
    away = np.linalg.norm(point - start[:, None] - share * along, axis=-1)
    return np.asarray((away < radius / depth[..., 0]) & (points[..., 2] > depth[..., 0] + radius + FARTHER_M))


def _hints(truth: _Truth, random: np.random.Generator) -> Array:
    """(F, N, 3) the guess of the points in space, from between the hips [m]."""
    frames, count, _ = truth.places.shape
    hips = [POINTS.index(f"hip.{side}") for side in SIDES]
    hint = truth.places - truth.places[:, hips].mean(axis=1, keepdims=True)
    wander = random.uniform(*DEPTH_WANDER_M, count)
    offset = DEPTH_OFFSET_M * random.standard_normal(count)
    slow = _wander(frames, (count,), DEPTH_FRAMES, random)
    hint[..., 2] = DEPTH_GAIN * hint[..., 2] + offset + wander * slow
    hint[..., :2] += SIDEWAYS_M * _wander(frames, (count, 2), DEPTH_FRAMES, random)
    return np.asarray(hint - hint[:, hips].mean(axis=1, keepdims=True))


def _wander(frames: int, shape: tuple[int, ...], over: float, random: np.random.Generator) -> Array:
    """(F, ...) a first-order process of unit variance that forgets over so many frames."""
    kept = np.exp(-1.0 / over)
    steps = random.standard_normal((frames, *shape))
    steps[1:] *= np.sqrt(1.0 - kept**2)
    return np.asarray(lfilter([1.0], [1.0, -kept], steps, axis=0))


def _stretches(
    frames: int, a_frame: float, lengths: tuple[int, int], random: np.random.Generator
) -> list[slice]:
    """Stretches of frames at random, within the clip."""
    firsts = random.integers(0, frames, random.poisson(a_frame * frames))
    return [slice(int(first), int(first + random.integers(*lengths, endpoint=True))) for first in firsts]


def _near_each_other(truth: _Truth, parts: tuple[str, ...]) -> BoolArray:
    """(F,) whether left and right of some parts are close together in the picture, in the mean."""
    left = truth.pixel[:, [POINTS.index(f"{part}.L") for part in parts]]
    right = truth.pixel[:, [POINTS.index(f"{part}.R") for part in parts]]
    return np.asarray(np.linalg.norm(left - right, axis=-1).mean(axis=-1) < SWAP_NEAR * truth.height_px)


def _swap(rows: slice, parts: tuple[str, ...], *arrays: Array) -> None:
    """Exchange left and right of some parts in some frames, in place."""
    left = [POINTS.index(f"{part}.L") for part in parts]
    right = [POINTS.index(f"{part}.R") for part in parts]
    for array in arrays:
        part = array[rows]
        part[:, left + right] = part[:, right + left]
