"""A synthetic detector: keypoints of a known motion with errors that last, and what may go wrong with it."""

import numpy as np
from _scene import BODY, CAMERA
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera
from keymark.core.detect.keypoints import Keypoints, mirrored_point
from keymark.core.terms.keypoints import KeypointModel

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
