"""An album of the performer of `_scene`, drawn part by part before a static, cluttered background."""

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType

import cv2
import numpy as np
from _scene import BODY, CAMERA, exercise
from keymark.core.body.posture import Posture
from keymark.core.terms.contours import ContourModel, part_map
from keymark.core.video.album import Album
from numpy.typing import ArrayLike

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
