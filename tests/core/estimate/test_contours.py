"""Contours found in pictures that were drawn from a known motion."""

from dataclasses import replace

import numpy as np
from _filmed import FRAME, FRAMES, POSED, TRUTH, album
from _scene import BODY, CAMERA
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.estimate.contour_evidence import learn_contours
from keymark.core.estimate.terms.contours import ContourTerm
from keymark.core.footage.clips.album import Album
from keymark.core.progress import run


def measure(posture: Posture, keyframes: np.ndarray) -> ContourTerm:
    """What is measured from roughly known postures."""
    contours = run(learn_contours(BODY, CAMERA, album(), posture, keyframes))
    assert contours is not None
    return run(contours.measure(posture, FRAME))


def test_edges_follow_the_true_contours_and_not_the_predicted_ones() -> None:
    step = np.zeros((FRAMES, HUMAN.dof_count))
    step[:, HUMAN.dof_names.index("hip.R.rotation_y")] = 0.1 * np.sin(0.9 * FRAME)
    step[POSED] = 0.0
    term = measure(TRUTH.plus(step), POSED)
    thigh = term.model.part_of == term.model.parts.segments.index("thigh.R")
    true = replace(term.model, shape=np.zeros_like(term.model.shape)).evaluate(BODY.pose(TRUTH), FRAME)
    wrong = term.model.evaluate(BODY.pose(TRUTH.plus(step)), FRAME)
    found = np.isfinite(term.edge[..., 0]) & thigh
    assert found[:, thigh].mean() > 0.3
    off = np.sum(term.normal * (term.edge - true.pixel), axis=-1)[found]
    before = np.sum(term.normal * (wrong.pixel - true.pixel), axis=-1)[found]
    # Blurred edges look thicker by the same amount everywhere, which is the shape's to explain.
    assert abs(np.median(off)) < 2.0
    assert np.std(off) < 0.6 * np.std(before)


def test_a_moving_camera_and_missing_pictures_measure_nothing() -> None:
    moving = replace(CAMERA, matrix_world=np.repeat(CAMERA.matrix_world[None], FRAMES, axis=0))
    assert run(learn_contours(BODY, moving, album(), TRUTH, POSED)) is None
    assert run(learn_contours(BODY, CAMERA, Album(), TRUTH, POSED)) is None
