"""What the tests of keypoints share: a plain take, and keypoints of it as a detector would write them."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from keymark.core.detect.keypoint_file import write_keypoints
from keymark.core.detect.keypoints import People, SeenPeople
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.core.take.take_file import write_take

NOISE_PX = 0.7


def seen_people(take: Take, motion: Motion, noise_px: float = NOISE_PX, others: int = 0) -> People:
    """The principal points of a motion in its take's pictures, and of others, each 40 pixels to the right."""
    rng = np.random.default_rng(7)
    names = take.body.skeleton.point_names
    pixel, _ = take.camera.project(motion.points)
    pixel = pixel + rng.normal(0.0, noise_px, pixel.shape)
    frames = tuple(
        SeenPeople(
            np.stack([places + (40.0 * number, 0.0) for number in range(others + 1)]),
            np.full((others + 1, len(names)), 0.9),
            np.full((others + 1, len(names), 3), np.nan),
        )
        for places in pixel
    )
    return People(names, "truth", take.camera.resolution, frames)


@pytest.fixture
def plain_take(tiny_take: Take, tmp_path: Path) -> Take:
    folder = tmp_path / "plain"
    folder.mkdir()
    (folder / "clip.mp4").write_bytes(tiny_take.clip.read_bytes())
    plain = replace(tiny_take, folder=folder, clip=folder / "clip.mp4", markers=())
    write_take(plain, folder)
    return plain


@pytest.fixture
def keypoint_file(plain_take: Take, wave_motion: Motion) -> Path:
    """A file of what a detector sees in it, beside the clip; under another name than takes give it."""
    path = plain_take.folder / "seen.json"
    write_keypoints(path, seen_people(plain_take, wave_motion), 1, plain_take.fps)
    return path


@pytest.fixture
def plain(registered: None, plain_take: Take) -> bpy.types.Scene:
    assert bpy.ops.keymark.open_take(filepath=str(plain_take.folder)) == {"FINISHED"}
    return bpy.context.scene


@pytest.fixture
def seen_by() -> Callable[..., People]:
    return seen_people
