"""A performer before a camera, and tracks made from postures without any picture."""

from collections.abc import Callable

import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera
from keymark.core.estimate.line_ends import LineEnds
from keymark.core.markers.region_tracks import RegionTracks


@pytest.fixture(scope="session")
def line_ends() -> LineEnds:
    """Five markers, seen from 4 m before the performer."""
    matrix = np.array([[1.0, 0, 0, 0], [0, 0, -1, -4], [0, 1, 0, 0.2], [0, 0, 0, 1]])
    camera = Camera(40.0, 36.0, (320, 240), matrix)
    return LineEnds(
        Body(Actor.from_stature(1.75)), camera, ("trunk", "forearm.L", "forearm.R", "shin.L", "shin.R")
    )


def tracks_from(characteristics: np.ndarray, visible: np.ndarray | None = None) -> RegionTracks:
    """Tracks (F, M) whose regions have exactly the given characteristics (F, M, 4)."""
    frames, markers = characteristics.shape[:2]
    seen = np.ones((frames, markers), dtype=bool) if visible is None else visible
    angle, ratio = characteristics[..., 2], np.exp(characteristics[..., 3])
    turn = np.stack([np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)], -1).reshape(
        frames, markers, 2, 2
    )
    axes = np.zeros((frames, markers, 2, 2))
    axes[..., 0, 0], axes[..., 1, 1] = 10.0 * ratio, 10.0
    moment = turn @ axes @ np.swapaxes(turn, -1, -2)
    return RegionTracks(
        names=tuple(f"marker {i}" for i in range(markers)),
        centroid=np.where(seen[..., None], characteristics[..., :2], np.nan),
        second_moment=np.where(seen[..., None, None], moment, np.nan),
        area=np.where(seen, 100.0, np.nan),
        quality=seen.astype(float),
        clipped=np.zeros((frames, markers), dtype=bool),
        time_s=np.arange(frames) / 30.0,
        size=(320, 240),
    )


@pytest.fixture(scope="session")
def see(line_ends: LineEnds) -> Callable[..., RegionTracks]:
    """A function from a batch of postures, and optionally what is visible of them, to noise-free tracks."""

    def look(posture: Posture, visible: np.ndarray | None = None) -> RegionTracks:
        return tracks_from(line_ends.evaluate(line_ends.body.pose(posture)), visible)

    return look
