"""A performer of average size before a fixed camera, and regions predicted without any picture."""

import numpy as np
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.terms.region_model import MarkerPlacement, RegionModel

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


def point_error_m(estimate: Posture, truth: Posture) -> np.ndarray:
    """Distance (F, 13) between the principal points of two batches [m]."""
    return np.linalg.norm(BODY.points(BODY.pose(estimate)) - BODY.points(BODY.pose(truth)), axis=-1)
