"""Contours found in pictures that were drawn from a known motion."""

from dataclasses import replace

import numpy as np
import pytest
from _filmed import FRAME, FRAMES, POSED, TRUTH, album, photograph
from _scene import BODY, CAMERA, SEGMENTS, film, point_error_m
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.estimate.contour_evidence import learn_contours
from keymark.core.estimate.terms.contours import ContourTerm
from keymark.core.estimate.whole_clip import Believed, Seen, estimate_whole_clip
from keymark.core.footage.clips.album import Album
from keymark.core.prior.keyframes import Keyframe, interpolate
from keymark.core.progress import Preview, run


def measure(posture: Posture, keyframes: np.ndarray) -> ContourTerm:
    """What is measured from roughly known postures."""
    contours = run(learn_contours(BODY, CAMERA, album(), posture, keyframes))
    assert contours is not None
    return run(contours.measure(posture, FRAME))


def solve(pictures: Album | None) -> Posture:
    """The estimate from few keyframes, with or without pictures."""
    keyframes = tuple(Keyframe(int(index), TRUTH[index : index + 1][0]) for index in POSED)
    prior = interpolate(keyframes, FRAMES)
    job = estimate_whole_clip(
        BODY,
        CAMERA,
        Seen(film(TRUTH, 0.3), SEGMENTS, album=pictures),
        Believed(prior, tuple(int(i) for i in POSED)),
    )
    fractions = []
    while True:
        try:
            done = next(job)
            if not isinstance(done, Preview):
                fractions.append(done)
        except StopIteration as stop:
            assert fractions == sorted(fractions) and fractions[-1] == pytest.approx(1.0)
            return stop.value.posture


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


def test_contours_bring_the_estimate_nearer_to_the_truth() -> None:
    without = point_error_m(solve(None), TRUTH).mean()
    assert point_error_m(solve(album()), TRUTH).mean() < 0.95 * without


def test_a_shaken_camera_changes_nothing() -> None:
    shaken = photograph(TRUTH, shake_px=4)
    np.testing.assert_array_equal(solve(shaken).to_vector(), solve(None).to_vector())


def test_a_moving_camera_and_missing_pictures_measure_nothing() -> None:
    moving = replace(CAMERA, matrix_world=np.repeat(CAMERA.matrix_world[None], FRAMES, axis=0))
    assert run(learn_contours(BODY, moving, album(), TRUTH, POSED)) is None
    assert run(learn_contours(BODY, CAMERA, Album(), TRUTH, POSED)) is None
