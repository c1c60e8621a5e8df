"""Contours found in pictures of a known motion, with markers and without any."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from _scene import (
    BODY,
    CAMERA,
    FRAME,
    FRAMES,
    POSED,
    SEGMENTS,
    TRUTH,
    album,
    belief_in,
    film,
    photograph,
    point_error_m,
)
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.detect.keypoints import Keypoints
from keymark.core.estimate.clip_problem import Seen
from keymark.core.estimate.contour_evidence import ROWS, ContourEvidence, contour_rows, learn_contours
from keymark.core.estimate.contour_search import BY_MARKERS, NARROW, all_located, contour_schedule
from keymark.core.estimate.whole_clip import WholeClipResult, estimate_whole_clip
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.keyframes import Keyframe, interpolate
from keymark.core.progress import run
from keymark.core.terms.contours import ContourTerm
from keymark.core.video.album import Album


def measure(posture: Posture, keyframes: np.ndarray) -> ContourTerm:
    """What is measured from roughly known postures."""
    contours = run(learn_contours(BODY, CAMERA, album(), posture, keyframes))
    assert contours is not None
    return run(contours.measure(posture, FRAME))[0]


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


def solve(pictures: Album | None, posed: Posture = TRUTH) -> WholeClipResult:
    """The estimate without markers, from four keyframes."""
    keyframes = tuple(Keyframe(int(index), posed[index : index + 1][0]) for index in POSED)
    tracks = RegionTracks.unmarked(FRAME / 30.0, CAMERA.resolution)
    prior = interpolate(keyframes, FRAMES)
    index = tuple(int(i) for i in POSED)
    return run(estimate_whole_clip(BODY, CAMERA, Seen(tracks, (), album=pictures), belief_in(prior, index)))


@cache
def interpolated() -> WholeClipResult:
    """The estimate without markers and without pictures."""
    return solve(None)


@cache
def learned() -> ContourEvidence:
    """Contours learned with wide looks."""
    schedule = contour_schedule(BODY, CAMERA, 1, (), TRUTH)
    found = run(learn_contours(BODY, CAMERA, album(), TRUTH, POSED, schedule))
    assert found is not None
    return found


def sloppy(size_m: float) -> Posture:
    """Postures whose joints are turned by what moves points a limb's length away by `size_m`."""
    rng = np.random.default_rng(5)
    step = np.zeros((FRAMES, HUMAN.dof_count))
    step[:, :3] = size_m * rng.normal(size=(FRAMES, 3))
    step[:, 3:] = size_m / 0.4 * rng.normal(size=(FRAMES, HUMAN.dof_count - 3))
    return TRUTH.plus(step)


def test_five_markers_are_looked_around_narrowly_and_fewer_are_not() -> None:
    assert contour_schedule(BODY, CAMERA, 1, SEGMENTS, TRUTH) is BY_MARKERS
    assert all_located(BODY, ("chest", "upper_arm.L", "hand.R", "thigh.L", "foot.R"))
    assert not all_located(BODY, ("trunk", "forearm.L", "upper_arm.L", "shin.L", "shin.R"))
    assert not all_located(BODY, ())


def test_looks_narrow_down_to_the_markers_own() -> None:
    looks = contour_schedule(BODY, CAMERA, 1, (), TRUTH).looks
    assert looks[-1] == NARROW
    assert [look.reach for look in looks] == sorted((look.reach for look in looks), reverse=True)
    assert looks[0].reach > 2 * NARROW.reach
    halved = contour_schedule(BODY, CAMERA, 2, (), TRUTH).looks
    assert halved[0].reach < looks[0].reach


def test_keypoints_of_all_limbs_spare_the_widest_looks() -> None:
    names = ("wrist.L", "wrist.R", "ankle.L", "ankle.R", "hip.L")

    def seen(count: int) -> Keypoints:
        pixel = np.ones((FRAMES, count, 2))
        score, hint = np.ones((FRAMES, count)), np.full((FRAMES, count, 3), np.nan)
        return Keypoints(names[-count:], ("one",) * count, pixel, score, hint)

    wide = contour_schedule(BODY, CAMERA, 1, (), TRUTH).looks[0]
    assert contour_schedule(BODY, CAMERA, 1, (), TRUTH, seen(5)).looks[0].reach < wide.reach
    assert contour_schedule(BODY, CAMERA, 1, (), TRUTH, seen(4)).looks[0] == wide


def test_shifts_along_a_limb_are_found_where_its_colors_end() -> None:
    step = np.zeros((FRAMES, HUMAN.dof_count))
    step[:, 2] = 0.06
    contours = learned()
    wrong = TRUTH.plus(step)
    steps = np.full(FRAMES - 1, 1.0 / 30.0)
    _, term = run(contours.measure(wrong, FRAME, contours.schedule.looks[0], steps))
    assert term is not None
    pose, true = BODY.pose(wrong), BODY.pose(TRUTH)
    part = contours.model.parts.segments.index("thigh.R")
    predicted, actual = (
        np.sum(term.direction * term.axes.points(at, FRAME, term.share)[1], axis=-1) for at in (pose, true)
    )
    found = np.isfinite(term.place[:, part])
    assert found.mean() > 0.5
    off = (term.place - actual)[found, part]
    before = (predicted - actual)[found, part]
    assert np.median(np.abs(off)) < 0.4 * np.median(np.abs(before))


def test_contours_alone_bring_the_estimate_nearer_to_the_truth() -> None:
    found = solve(album())
    between = np.setdiff1d(FRAME, POSED)
    alone, before = (point_error_m(one.posture, TRUTH)[between].mean() for one in (found, interpolated()))
    assert alone < 0.6 * before
    assert found.outlined is not None and found.outlined.mean() > 0.5
    deviation = np.sqrt(np.trace(found.covariance[:, :3, :3], axis1=1, axis2=2))
    assert (deviation > 1e-3).all()


def test_a_shaken_camera_leaves_the_interpolation() -> None:
    shaken = solve(photograph(TRUTH, shake_px=12))
    assert shaken.contours is None and shaken.outlined is None
    np.testing.assert_allclose(shaken.posture.to_vector(), interpolated().posture.to_vector(), atol=1e-9)


def test_a_thing_that_moves_behind_costs_its_own_pixels_only() -> None:
    contours = flickering()
    assert contours is not None
    assert not contours.appearance.known[20:60, 20:300].any()
    assert contours.appearance.known[100:, 20:100].mean() > 0.9


def flickering() -> ContourEvidence | None:
    """Contours learned before a background of which the upper part flickers."""
    rng = np.random.default_rng(9)
    pictures = Album()
    for frame in range(FRAMES):
        image = album().picture(frame).copy()
        image[15:65, 10:310] = rng.integers(0, 255)
        pictures.add(frame, image)
    schedule = contour_schedule(BODY, CAMERA, 1, (), TRUTH)
    return run(learn_contours(BODY, CAMERA, pictures, TRUTH, POSED, schedule))


def test_the_rows_at_keyframes_follow_posture_and_lens() -> None:
    contours = learned()
    rows = contour_rows(contours, TRUTH[POSED], POSED)
    count = len(contours.model.parts.segments) * ROWS
    assert rows.residual.shape == (len(POSED), count)
    assert rows.by_parameters.shape == (len(POSED), count, contours.model.shape.size)
    used = rows.variance < 1e5
    assert used.mean() > 0.3
    step = np.zeros((len(POSED), HUMAN.dof_count))
    step[:, 0] = 0.02  # sideways
    moved = contour_rows(contours, TRUTH[POSED].plus(step), POSED)
    both = used & (moved.variance < 1e5)
    change = (moved.residual - rows.residual)[both]
    expected = 0.02 * rows.by_posture[..., 0][both]
    large = np.abs(expected) > 1.0
    assert np.median(np.abs(change - expected)[large]) < 0.5 * np.median(np.abs(expected)[large])
    # A longer lens moves what is left of the middle to the left.
    pixel = contours.model.evaluate(BODY.pose(TRUTH[POSED]), POSED).pixel
    assert np.abs(rows.by_lens).max() < np.abs(pixel - [160.0, 120.0]).max() * 1.5


@pytest.mark.parametrize(("size_m", "low", "high"), [(0.0, 0.0, 0.4), (0.03, 0.5, 2.7)])
def test_contours_tell_careless_keyframes_from_careful_ones(size_m: float, low: float, high: float) -> None:
    assert low < solve(album(), sloppy(size_m)).evidence.posing_scale < high


def test_where_markers_locate_every_limb_nothing_but_they_judge() -> None:
    keyframes = tuple(Keyframe(int(index), TRUTH[index : index + 1][0]) for index in POSED)
    prior = interpolate(keyframes, FRAMES)
    job = estimate_whole_clip(
        BODY,
        CAMERA,
        Seen(film(TRUTH, 0.3), SEGMENTS, album=album()),
        belief_in(prior, tuple(int(i) for i in POSED)),
    )
    found = run(job)
    assert found.contours is not None and found.contours.along is None and found.outlined is None
