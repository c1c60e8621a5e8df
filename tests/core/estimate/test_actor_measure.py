"""An actor's lengths from a frame in which the performer stands."""

import numpy as np
import pytest
from _scene import CAMERA, SEGMENTS, film
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import standing_height_m, standing_posture
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.detect.keypoints import Keypoints
from keymark.core.estimate.actor_measure import MEASURED, MeasuredActor, measure_standing
from keymark.core.terms.keypoints import KeypointModel
from keymark.core.terms.region_model import MarkerPlacement, RegionModel

PLACE = np.array([0.2, 0.3, 0.0])


def someone(rng: np.random.Generator) -> Body:
    """A body whose proportions differ from the average as people's do."""
    lengths = dict(Actor.from_stature(1.75).segments_m)
    for name in MEASURED:
        factor = float(np.exp(0.045 * rng.normal()))
        lengths |= {key: factor * length for key, length in lengths.items() if key.split(".")[0] == name}
    return Body(Actor(lengths))


def measured(body: Body, step: np.ndarray, stretched: bool = False) -> tuple[MeasuredActor, Posture]:
    """Measure a body that stands a tangent step from the standing posture."""
    lowered = 0.0 if stretched else 1.3
    posture = standing_posture(body, PLACE, 0.0, lowered).plus(step)
    model = RegionModel(body, CAMERA, tuple(MarkerPlacement.usual(name) for name in SEGMENTS))
    regions = film(Posture.stack([posture]), noise_px=0.2, seed=1, model=model)
    height = standing_height_m(body)
    pixels, _ = CAMERA.project(np.stack([PLACE + [0.0, 0.0, height], PLACE]))
    return measure_standing(CAMERA, 0, height, *pixels, regions, SEGMENTS, stretched), posture


def log_errors(found: Body, body: Body) -> np.ndarray:
    """How far each measured length is off, as a share."""
    names = [f"{n}.L" if f"{n}.L" in body.actor.segments_m else n for n in MEASURED]
    return np.array([np.log(found.actor.segments_m[n] / body.actor.segments_m[n]) for n in names])


def test_height_is_kept_and_lengths_are_no_worse_than_average_proportions() -> None:
    rng = np.random.default_rng(2)
    before, after = [], []
    for _ in range(3):
        body = someone(rng)
        step = np.where(np.arange(34) < 6, 0.0, 0.03) * rng.normal(size=34)
        found, posture = measured(body, step, stretched=True)
        assert found.stands
        assert standing_height_m(found.body) == pytest.approx(standing_height_m(body), rel=1e-9)
        assert np.linalg.norm(found.posture.translation - posture.translation) < 0.08
        average = Body(Actor.from_stature(standing_height_m(body)))
        before.append(log_errors(average, body))
        after.append(log_errors(found.body, body))
    assert np.sqrt(np.mean(np.square(after))) < 0.92 * np.sqrt(np.mean(np.square(before)))


def test_what_cannot_be_told_is_said_to_be_uncertain() -> None:
    found, _ = measured(someone(np.random.default_rng(3)), np.zeros(34))
    assert found.stands
    assert found.spread["shin"] < found.spread["shoulder_width"] <= 0.0451
    assert all(0.0 < share < 0.0451 for share in found.spread.values())


def test_someone_who_kneels_does_not_stand() -> None:
    body = Body(Actor.from_stature(1.75))
    names = body.skeleton.dof_names
    step = np.zeros(34)
    step[names.index("pelvis.location_z")] = -0.45
    for side in "LR":
        step[names.index(f"knee.{side}.flexion")] = 1.6
    found, _ = measured(body, step)
    assert not found.stands


JOINTS = tuple(
    f"{joint}.{side}" for joint in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle") for side in "LR"
)


def measured_by_keypoints(body: Body, posture: Posture, noise_px: float) -> MeasuredActor:
    """Measure a body by a detector's points alone."""
    rng = np.random.default_rng(1)
    pixel = KeypointModel.usual(body, CAMERA, JOINTS).pixels(
        body.pose(Posture.stack([posture])), np.zeros(1, dtype=np.intp)
    )
    pixel = pixel + rng.normal(0.0, noise_px, pixel.shape)
    seen = Keypoints(
        JOINTS, ("test",) * 12, pixel, np.full(pixel.shape[:2], 0.9), np.full((1, 12, 3), np.nan)
    )
    height = standing_height_m(body)
    pixels, _ = CAMERA.project(np.stack([PLACE + [0.0, 0.0, height], PLACE]))
    return measure_standing(CAMERA, 0, height, *pixels, arms_stretched=True, keypoints=seen)


def test_keypoints_measure_lengths_without_any_marker() -> None:
    rng = np.random.default_rng(2)
    before, after = [], []
    for _ in range(3):
        body = someone(rng)
        step = np.where(np.arange(34) < 6, 0.0, 0.03) * rng.normal(size=34)
        found = measured_by_keypoints(body, standing_posture(body, PLACE, 0.0, 0.0).plus(step), 0.5)
        assert found.stands
        assert standing_height_m(found.body) == pytest.approx(standing_height_m(body), rel=1e-9)
        before.append(log_errors(Body(Actor.from_stature(standing_height_m(body))), body))
        after.append(log_errors(found.body, body))
    assert np.sqrt(np.mean(np.square(after))) < 0.9 * np.sqrt(np.mean(np.square(before)))


def test_keypoints_tell_who_does_not_stand() -> None:
    body = Body(Actor.from_stature(1.75))
    posture = standing_posture(body, PLACE, 0.0, 0.0)
    angles = np.array(posture.angles)
    names = [body.skeleton.joints[joint].name for joint in body.skeleton.hinge_joints]
    angles[[names.index("knee.L"), names.index("knee.R")]] = np.radians(100.0)
    down = posture.translation - np.array([0.0, 0.0, 0.4])
    kneeling = Posture(posture.skeleton, down, posture.rotations, angles)
    assert not measured_by_keypoints(body, kneeling, 0.5).stands
