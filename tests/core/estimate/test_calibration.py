"""Markers' places found from frames of known posture."""

import numpy as np
import pytest
from _scene import BODY, CAMERA, MODEL, SEGMENTS, exercise, film
from keymark.core.estimate.calibration import KnownFrames, calibrate
from keymark.core.estimate.terms.regions import FEATURES, ObservedRegions
from keymark.core.observation.regions import MarkerPlacement, RegionModel

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
FRAMES = 12


def known_frames(std_px: float) -> KnownFrames:
    """Frames of an exercise whose postures are known, seen with the true placements."""
    posture = exercise(45)[np.linspace(0, 44, FRAMES).astype(np.intp)]
    tracks = film(posture, model=RegionModel(BODY, CAMERA, TRUE))
    std = np.full((FRAMES, len(SEGMENTS), FEATURES), std_px)
    return KnownFrames(BODY.pose(posture), np.arange(FRAMES), ObservedRegions.from_tracks(tracks), std)


def test_known_postures_tell_where_the_colour_begins_and_how_thick_the_limb_is() -> None:
    """With pixels that can be trusted the placements come back."""
    found = calibrate(BODY, CAMERA, MODEL.placements, known_frames(0.1))
    for ours, true in zip(found, TRUE, strict=True):
        assert ours.first == pytest.approx(true.first, abs=0.04)
        assert ours.last == pytest.approx(true.last, abs=0.04)
        assert ours.girth == pytest.approx(true.girth, rel=0.12)


def test_pixels_that_cannot_be_trusted_change_little() -> None:
    """With noise far above the difference the average body stays."""
    found = calibrate(BODY, CAMERA, MODEL.placements, known_frames(100.0))
    for ours, start in zip(found, MODEL.placements, strict=True):
        assert ours.first == pytest.approx(start.first, abs=0.02)
        assert ours.girth == pytest.approx(start.girth, rel=0.05)


def test_calibrated_placements_predict_better_than_average_ones() -> None:
    """The centroids' error falls to a fraction."""
    known = known_frames(0.3)
    found = calibrate(BODY, CAMERA, MODEL.placements, known)

    def error(placements: tuple[MarkerPlacement, ...]) -> float:
        predicted = RegionModel(BODY, CAMERA, placements).evaluate(known.pose, known.frame)
        return float(np.nanmean(np.linalg.norm(predicted.centroid - known.observed.centroid, axis=-1)))

    assert error(found) < 0.25 * error(MODEL.placements)
