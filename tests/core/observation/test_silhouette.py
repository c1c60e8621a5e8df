"""The markers' closed outlines."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from _scene import BODY, CAMERA, MODEL, exercise
from keymark.core.footage.segmentation.ellipse import ellipse_outline
from keymark.core.observation.outline import outline, view_pieces
from keymark.core.observation.silhouette import silhouettes

FRAMES = 12


def area(polygon: np.ndarray) -> float:
    """Of a closed polygon (K, 2) [px²]."""
    return float(abs(cv2.contourArea(polygon.astype(np.float32))))


def test_outlines_hold_the_samples_that_the_estimate_compares() -> None:
    """Every sample of a silhouette lies inside the marker's outline, but for its corners' coarseness."""
    pose, frame = BODY.pose(exercise(FRAMES)), np.arange(FRAMES)
    outlines = silhouettes(MODEL, pose, frame)
    samples = outline(MODEL._pieces, view_pieces(MODEL._pieces, pose, CAMERA, frame))
    pixels, _ = CAMERA.project(samples.world, frame[:, None, None])
    for piece, marker in enumerate(MODEL._marker_of):
        for at in frame:
            hull = outlines[at, marker].astype(np.float32)
            inside = [cv2.pointPolygonTest(hull, tuple(map(float, p)), True) for p in pixels[at, piece]]
            assert min(inside) > -1.0


def test_a_limb_across_the_view_covers_about_its_predicted_area() -> None:
    """The forearms' and shins' outlines are neither loose nor cut."""
    pose, frame = BODY.pose(exercise(FRAMES)), np.arange(FRAMES)
    outlines, predicted = silhouettes(MODEL, pose, frame), MODEL.evaluate(pose, frame)
    whole = predicted.area / predicted.visible
    for marker in range(1, 5):
        areas = np.array([area(outlines[at, marker]) for at in frame])
        assert areas == pytest.approx(whole[:, marker], rel=0.2)


def test_an_ellipse_has_the_moments_it_was_drawn_for() -> None:
    """Its own moments, measured from a fine drawing, are the given ones; unknown ones give no outline."""
    moment = np.array([[90.0, 40.0], [40.0, 60.0]])
    polygon = ellipse_outline([50.0, 40.0], moment, 256)
    found = cv2.moments(polygon.astype(np.float32))
    centre = np.array([found["m10"], found["m01"]]) / found["m00"]
    second = np.array([[found["mu20"], found["mu11"]], [found["mu11"], found["mu02"]]]) / found["m00"]
    assert centre == pytest.approx([50.0, 40.0], abs=0.05)
    assert second == pytest.approx(moment, rel=0.01)
    assert np.isnan(ellipse_outline([np.nan, np.nan], moment)).all()


def test_a_marker_behind_the_camera_has_no_outline() -> None:
    """Instead of one turned inside out."""
    inside = CAMERA.matrix_world.copy()
    inside[1, 3] = 0.0
    model = replace(MODEL, camera=replace(CAMERA, matrix_world=inside))
    outlines = silhouettes(model, BODY.pose(exercise(3)), np.arange(3))
    assert np.isnan(outlines[:, 0]).all()
