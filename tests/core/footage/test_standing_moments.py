"""Moments in which the performer is upright, found in keypoints."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import standing_posture
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.footage.camera import Camera, default_camera_pose
from keymark.core.footage.camera_evidence import CameraEvidence
from keymark.core.footage.camera_fields import CameraPlacement
from keymark.core.footage.camera_fit import LENS, fit_camera
from keymark.core.footage.keypoints.keypoints import Keypoints
from keymark.core.footage.standing_moments import standing_keypoints

BODY = Body(Actor.from_stature(1.8))
SIZE = (640, 480)
FPS = 30.0
TRUE = Camera(35.0, 36.0, SIZE, CameraPlacement(1.6, float(np.radians(-8.0)), 0.0).matrix())


def walk(count: int = 120) -> Array:
    """Principal points (F, 13, 3) of someone upright who glides to and fro and comes nearer."""
    phase = np.linspace(0.0, 2.0 * np.pi, count)
    places = np.column_stack([1.2 * np.sin(2.0 * phase), 5.5 + 1.5 * np.cos(phase), 0.0 * phase])
    return BODY.points(BODY.pose(Posture.stack([standing_posture(BODY, place) for place in places])))


def keypoints(points: Array, noise_px: float = 0.0) -> Keypoints:
    pixel = TRUE.project(points)[0]
    pixel = pixel + np.random.default_rng(1).normal(0.0, noise_px, pixel.shape)
    count = len(HUMAN.point_names)
    unknown = np.full((len(points), count, 3), np.nan)
    return Keypoints(HUMAN.point_names, ("x",) * count, pixel, np.ones(pixel.shape[:2]), unknown)


def before() -> Camera:
    return Camera(35.0, 36.0, SIZE, default_camera_pose(35.0, 36.0, SIZE))


def test_a_walk_finds_height_and_tilt() -> None:
    seen = standing_keypoints(keypoints(walk(), 2.0), BODY, FPS)
    assert 10 <= len(seen) <= 14 and seen.doubtful  # one in nine frames
    fit = fit_camera(before(), CameraEvidence(uprights=seen), lens_is_known=True)
    assert fit.kept == (LENS,)
    assert abs(fit.placement.height_m - 1.6) < min(2.0 * fit.std["height"], 0.15)
    assert abs(fit.placement.tilt_rad + np.radians(8.0)) < min(2.0 * fit.std["tilt"], np.radians(2.0))


def test_who_bends_kneels_or_is_cut_off_is_no_measure() -> None:
    """Trunk out of line, short legs, feet unseen, points of which the detector is not sure."""
    points = walk()
    names = list(HUMAN.point_names)
    upper = [
        i for i, name in enumerate(names) if name.split(".")[0] in ("head", "shoulder", "elbow", "wrist")
    ]
    bent = points.copy()
    hip = bent[:, names.index("hip.L")]
    bent[:, upper] = hip[:, None] + (bent[:, upper] - hip[:, None])[..., [2, 1, 0]]
    assert len(standing_keypoints(keypoints(bent), BODY, FPS)) == 0
    crouched = points.copy()
    crouched[:60, [names.index("ankle.L"), names.index("ankle.R")], 2] += 0.35
    assert len(standing_keypoints(keypoints(crouched), BODY, FPS)) <= 7
    seen = keypoints(points)
    feet = [names.index("ankle.L"), names.index("ankle.R")]
    score = np.array(seen.score)
    score[:, feet] = 0.1
    unsure = Keypoints(seen.names, seen.sources, seen.pixel, score, seen.hint_m)
    assert len(standing_keypoints(unsure, BODY, FPS)) == 0
    assert len(standing_keypoints(Keypoints.none(20), BODY, FPS)) == 0


def test_who_is_in_the_air_is_no_measure() -> None:
    points = walk(480)
    time_s = np.arange(len(points)) / FPS
    points[..., 2] += (4.9 * np.maximum(0.1 - (time_s % 2.0 - 1.0) ** 2, 0.0))[:, None]
    seen = standing_keypoints(keypoints(points), BODY, FPS)
    assert 16 <= len(seen) <= 40
    fit = fit_camera(before(), CameraEvidence(uprights=seen), lens_is_known=True)
    assert abs(fit.placement.tilt_rad + np.radians(8.0)) < min(2.5 * fit.std["tilt"], np.radians(4.0))


def test_single_moments_far_off_change_little() -> None:
    points = walk()
    seen = standing_keypoints(keypoints(points, 1.0), BODY, FPS)
    lower = np.array(seen.lower_px)
    lower[::5] += 0.1 * (seen.upper_px - lower)[::5]
    wrong = type(seen)(
        lower, seen.upper_px, seen.lower_m, seen.length_m, seen.pixel_std, seen.length_std, seen.lean_std_rad,
        common_std=seen.common_std, common_lean_rad=seen.common_lean_rad, doubtful=True,
    )  # fmt: skip
    fit = fit_camera(before(), CameraEvidence(uprights=wrong), lens_is_known=True)
    assert abs(fit.placement.tilt_rad + np.radians(8.0)) < np.radians(2.5)
