"""A performer before a fixed camera: regions and keypoints of known motions, and albums drawn of them."""

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType

import cv2
import numpy as np
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera
from keymark.core.detect.keypoints import Keypoints, mirrored_point
from keymark.core.estimate.belief import Belief
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.terms.contours import ContourModel, part_map
from keymark.core.terms.keypoints import KeypointModel, ObservedKeypoints
from keymark.core.terms.region_model import MarkerPlacement, RegionModel
from keymark.core.video.album import Album
from numpy.typing import ArrayLike

SEGMENTS = ("trunk", "forearm.L", "forearm.R", "shin.L", "shin.R")
BODY = Body(Actor.from_stature(1.75))
CAMERA = Camera(
    40.0, 36.0, (320, 240), np.array([[1.0, 0, 0, 0], [0, 0, -1, -4.2], [0, 1, 0, 1.0], [0, 0, 0, 1]])
)
MODEL = RegionModel(BODY, CAMERA, tuple(MarkerPlacement.usual(name) for name in SEGMENTS))


def exercise(frames: int, arm_phase: float = 0.0) -> Posture:
    """F postures: the performer sways, swings both arms in and out of the picture plane and lifts a knee."""
    vector = np.zeros((frames, HUMAN.dof_count))
    time = 2.0 * np.pi * np.arange(frames) / 45.0
    column = {name: i for i, name in enumerate(HUMAN.dof_names)}
    vector[:, column["pelvis.location_x"]] = 0.15 * np.sin(time)
    vector[:, column["pelvis.location_z"]] = 0.95 + 0.02 * np.cos(2.0 * time)
    vector[:, column["pelvis.rotation_z"]] = 0.3 * np.sin(time)
    vector[:, column["waist.rotation_x"]] = 0.1 + 0.1 * np.sin(time)
    for side, out in (("L", 1.0), ("R", -1.0)):
        swing = np.sin(time + arm_phase * out)
        vector[:, column[f"shoulder.{side}.rotation_y"]] = out * (0.6 + 0.4 * swing)
        vector[:, column[f"shoulder.{side}.rotation_z"]] = -out * (0.4 + 0.3 * np.cos(time))
        vector[:, column[f"elbow.{side}.flexion"]] = 0.6 + 0.4 * swing
    lift = 0.5 * (1.0 - np.cos(time))
    vector[:, column["hip.L.rotation_x"]] = -0.9 * lift
    vector[:, column["knee.L.flexion"]] = 1.2 * lift
    return Posture.from_vector(HUMAN, vector)


def film(posture: Posture, noise_px: float = 0.0, seed: int = 0, model: RegionModel = MODEL) -> RegionTracks:
    """Tracks (F, M) of what the region model predicts, hidden markers missing."""
    rng = np.random.default_rng(seed)
    frames = posture.batch[0]
    predicted = model.evaluate(model.body.pose(posture), np.arange(frames))
    hidden = predicted.visible < 0.2
    noise = noise_px * rng.normal(size=predicted.centroid.shape)
    return RegionTracks(
        names=SEGMENTS,
        centroid=np.where(hidden[..., None], np.nan, predicted.centroid + noise),
        second_moment=np.where(hidden[..., None, None], np.nan, predicted.second_moment),
        area=np.where(hidden, np.nan, predicted.area),
        quality=np.where(hidden, 0.0, predicted.visible),
        clipped=np.zeros(hidden.shape, dtype=bool),
        time_s=np.arange(frames) / 30.0,
        size=CAMERA.resolution,
    )


def no_points(frames: int = 1) -> ObservedKeypoints:
    """No keypoint in so many frames."""
    return ObservedKeypoints.of(Keypoints.none(frames))


def belief_in(
    prior: Posture,
    frames: tuple[int, ...],
    doubt: np.ndarray | None = None,
    pictured: np.ndarray | None = None,
    ankle_m: np.ndarray | None = None,
) -> Belief:
    """The belief in keyframes that are all posed in space, but for what is told otherwise."""
    doubt = np.zeros(len(frames)) if doubt is None else doubt
    pictured = np.zeros(len(frames), dtype=bool) if pictured is None else pictured
    return Belief(prior, np.array(frames, dtype=np.intp), doubt, pictured, ankle_m)


def point_error_m(estimate: Posture, truth: Posture) -> np.ndarray:
    """Distance (F, 13) between the principal points of two batches [m]."""
    return np.linalg.norm(BODY.points(BODY.pose(estimate)) - BODY.points(BODY.pose(truth)), axis=-1)


# --- An album of the performer of `_scene`, drawn part by part before a static, cluttered background


FRAMES = 46
FRAME = np.arange(FRAMES)
POSED = np.array([0, 15, 30, 45])
"""The frames of the keyframes."""
TRUTH = exercise(FRAMES)
NOTHING: Mapping[str, ArrayLike] = MappingProxyType({})
NOISE_LEVELS = 3.0
FINER = 3


def part_colors(count: int) -> np.ndarray:
    """(count + 1, 3) distinct colors; limbs look alike in pairs, the last is not used."""
    rng = np.random.default_rng(7)
    return rng.uniform(20.0, 235.0, size=(count + 1, 3))


def background(rng: np.random.Generator) -> np.ndarray:
    """(240, 320, 3) blocks of dull colors."""
    blocks = rng.uniform(90.0, 200.0, size=(12, 16, 1)) + rng.uniform(-15.0, 15.0, size=(12, 16, 3))
    return np.kron(blocks, np.ones((20, 20, 1)))


def photograph(
    posture: Posture, shake_px: int = 0, seed: int = 3, painted: Mapping[str, ArrayLike] = NOTHING
) -> Album:
    """An album of F postures.

    `shake_px` moves the background about as a hand-held camera does; `painted` segments have own colors.
    """
    rng = np.random.default_rng(seed)
    frames = posture.batch[0]
    place = background(rng)
    model = ContourModel.average(BODY, CAMERA)
    parts = model.part_outlines(BODY.pose(posture), np.arange(frames))
    colors = part_colors(len(model.parts.segments))
    for segment, color in painted.items():
        colors[model.parts.segments.index(segment)] = color
    place, colors = place.astype(np.float32), colors.astype(np.float32)
    album = Album()
    for frame in range(frames):
        shift = tuple(rng.integers(-shake_px, shake_px + 1, size=2))
        label = part_map(parts, frame, (320 * FINER, 240 * FINER), 1.0 / FINER)
        drawn = np.roll(place, shift, axis=(0, 1)).repeat(FINER, axis=0).repeat(FINER, axis=1)
        drawn[label >= 0] = colors[label[label >= 0]]
        image = cv2.resize(drawn, (320, 240), interpolation=cv2.INTER_AREA)
        image = image + rng.normal(0.0, NOISE_LEVELS, size=image.shape)
        album.add(frame, np.clip(np.round(image), 0, 255).astype(np.uint8))
    return album


@cache
def album() -> Album:
    """Pictures of the true motion."""
    return photograph(TRUTH)


# --- A synthetic detector: keypoints of a known motion with errors that last, and what may go wrong with it


LAYOUT = (
    "nose",
    *(
        f"{part}.{side}"
        for part in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
        for side in ("L", "R")
    ),
)
SOURCE = "detector"


def detect(
    posture: Posture,
    error_m: float = 0.012,
    seed: int = 0,
    names: tuple[str, ...] = LAYOUT,
    place_error_m: float = 0.015,
    hint_error_m: float | None = None,
    camera: Camera = CAMERA,
    body: Body = BODY,
) -> Keypoints:
    """What a detector sees of F postures: points at places of its own, with errors that last 0.2 s."""
    rng = np.random.default_rng(seed)
    frames = np.arange(posture.batch[0])
    usual = KeypointModel.usual(body, camera, names)
    model = usual.changed(place_error_m * rng.normal(size=usual.place.shape), camera)
    pose = body.pose(posture)
    pixel, depth = camera.project(model.world(pose), frames[:, None])
    scale = camera.focal_px / depth
    pixel = pixel + error_m * lasting(rng, (*depth.shape, 2)) * scale[..., None]
    hint = np.full((*depth.shape, 3), np.nan)
    if hint_error_m is not None:
        own = depth - camera.depth(pose.origin[:, 0], frames)[:, None]
        hint[..., :2], hint[..., 2] = 0.0, own + hint_error_m * lasting(rng, depth.shape)
    return Keypoints(names, (SOURCE,) * len(names), pixel, np.ones(depth.shape), hint)


def lasting(rng: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    """First-order processes of unit variance over the first axis, of six frames' memory."""
    kept = np.exp(-1.0 / 6.0)
    noise = rng.normal(size=shape)
    for frame in range(1, len(noise)):
        noise[frame] = kept * noise[frame - 1] + np.sqrt(1.0 - kept**2) * noise[frame]
    return noise


def changed(keypoints: Keypoints, pixel: np.ndarray) -> Keypoints:
    """The same keypoints elsewhere."""
    return Keypoints(keypoints.names, keypoints.sources, pixel, keypoints.score, keypoints.hint_m)


def in_order(keypoints: Keypoints, order: np.ndarray) -> Keypoints:
    """The keypoints of other frames."""
    return Keypoints(
        keypoints.names,
        keypoints.sources,
        keypoints.pixel[order],
        keypoints.score[order],
        keypoints.hint_m[order],
    )


def sides_exchanged(keypoints: Keypoints, frames: np.ndarray) -> Keypoints:
    """Left for right in some frames (F,)."""
    partner = [keypoints.names.index(mirrored_point(name)) for name in keypoints.names]
    return changed(keypoints, np.where(frames[:, None, None], keypoints.pixel[:, partner], keypoints.pixel))
