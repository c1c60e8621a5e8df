"""Placements, lens and posing errors, all found from what is seen at the keyframes."""

from dataclasses import replace

import numpy as np
import pytest
from _scene import BODY, CAMERA, MODEL, exercise, film, no_points
from keymark.core.body.posture import Posture
from keymark.core.estimate.belief import posing_covariance
from keymark.core.estimate.clip_problem import KeyframeEvidence, uncalibrated
from keymark.core.estimate.keyframe_evidence import SeenAtKeyframes, read_keyframes
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.progress import run
from keymark.core.terms.region_model import MarkerPlacement, RegionModel
from keymark.core.terms.regions import ObservedRegions, limb_widths

FRAMES = 90
MOTION = exercise(FRAMES)
POSED = np.linspace(2, FRAMES - 3, 12).round().astype(np.intp)
TRUE = tuple(
    MarkerPlacement(name, first, last, lateral, 0.0, girth)
    for name, first, last, lateral, girth in (
        ("trunk", 0.15, 1.05, 0.005, 1.15),
        ("forearm.L", 0.15, 0.85, 0.0, 1.2),
        ("forearm.R", 0.0, 0.9, 0.0, 0.9),
        ("shin.L", 0.2, 1.0, 0.004, 1.1),
        ("shin.R", 0.1, 0.8, -0.004, 1.0),
    )
)


def read(posed: Posture, tracks: RegionTracks, model: RegionModel = MODEL) -> KeyframeEvidence:
    observed = ObservedRegions.from_tracks(tracks)[POSED]
    width = limb_widths(model, posed.translation, POSED)
    usual = uncalibrated(model).keypoints
    at = SeenAtKeyframes(POSED, posed, observed, width, usual, no_points(len(POSED)))
    return run(read_keyframes(model, at))


def posed_by_hand(seed: int) -> Posture:
    """The true keyframes with a person's usual error."""
    rng = np.random.default_rng(seed)
    factor = np.linalg.cholesky(posing_covariance(BODY, BODY.pose(MOTION[POSED])))
    return MOTION[POSED].plus((factor @ rng.normal(size=(*factor.shape[:-1], 1)))[..., 0])


@pytest.fixture(scope="module")
def worn() -> RegionTracks:
    """The motion filmed with other placements than the average."""
    return film(MOTION, 0.2, model=RegionModel(BODY, CAMERA, TRUE))


def test_known_postures_tell_where_the_color_begins_and_how_thick_the_limb_is(worn: RegionTracks) -> None:
    found = read(MOTION[POSED], worn).model
    for ours, true in zip(found.placements, TRUE, strict=True):
        assert ours.first == pytest.approx(true.first, abs=0.06)
        assert ours.last == pytest.approx(true.last, abs=0.06)
        assert ours.girth == pytest.approx(true.girth, rel=0.15)

    def error(model: RegionModel) -> float:
        predicted = model.evaluate(BODY.pose(MOTION), np.arange(FRAMES))
        return float(np.nanmean(np.linalg.norm(predicted.centroid - worn.centroid, axis=-1)))

    assert error(found) < 0.4 * error(MODEL)


def test_exact_keyframes_are_told_from_careless_ones(worn: RegionTracks) -> None:
    exact = read(MOTION[POSED], worn)
    careless = read(posed_by_hand(3), worn)
    assert exact.posing_scale < 0.3
    assert 0.5 < careless.posing_scale < 1.8
    trust = [np.trace(evidence.information, axis1=-2, axis2=-1).mean() for evidence in (exact, careless)]
    assert trust[0] > 3.0 * trust[1]


@pytest.mark.parametrize("factor", [0.92, 1.08])
def test_a_misstated_lens_is_found(factor: float) -> None:
    stated = replace(CAMERA, lens_mm=CAMERA.lens_mm * factor)
    found = read(MOTION[POSED], film(MOTION, 0.2), RegionModel(BODY, stated, MODEL.placements)).model.camera
    assert found.lens_mm == pytest.approx(CAMERA.lens_mm, rel=0.015)


def test_a_right_lens_is_left_alone_by_careless_keyframes() -> None:
    found = read(posed_by_hand(5), film(MOTION, 0.2)).model.camera
    assert found.lens_mm == pytest.approx(CAMERA.lens_mm, rel=0.02)


def test_a_marker_that_is_never_where_it_should_be_is_distrusted() -> None:
    tracks = film(MOTION, 0.2)
    rng = np.random.default_rng(6)
    centroid = tracks.centroid.copy()
    centroid[:, 2] += rng.uniform(12.0, 25.0, (FRAMES, 2)) * rng.choice([-1.0, 1.0], (FRAMES, 2))
    evidence = read(MOTION[POSED], replace(tracks, centroid=centroid))
    assert evidence.distrust[2] > 4.0
    assert np.delete(evidence.distrust, 2).max() < 1.5
    assert evidence.posing_scale < 0.5
