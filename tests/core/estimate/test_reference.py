"""A reference motion: alignment, worth, what posed keyframes tell of it, and its term."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from _recorded import assert_recorded
from _scene import BODY, CAMERA, detect, exercise, lasting, sides_exchanged
from keymark.core.api import reconstruct
from keymark.core.arrays import Array
from keymark.core.body.human import HUMAN
from keymark.core.body.mirror import OPPOSITE
from keymark.core.detect.keypoints import Keypoints, People, SeenPeople
from keymark.core.errors import InputError
from keymark.core.estimate.reconstruct import check_reconstructible
from keymark.core.estimate.reference_alignment import AlignedReference, about_hips, align
from keymark.core.estimate.reference_evidence import (
    STD_M,
    NoReference,
    ReferenceEvidence,
    own_and_usual_cost,
    reference_evidence,
    smoothed,
    with_reference,
)
from keymark.core.estimate.reference_placement import SeenPoints, place
from keymark.core.markers.reading import Reading
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.keyframes import Keyframe, Matched
from keymark.core.progress import run
from keymark.core.take.presence import seen_take
from keymark.core.take.reference import ReferenceMotion
from keymark.core.take.take import Take
from scipy.spatial.transform import Rotation

FRAMES = 70
TRUTH = exercise(2 * FRAMES)[::2]
POINTS = BODY.points(BODY.pose(TRUTH))
TRACKS = RegionTracks.unmarked(np.arange(FRAMES) / 30.0, CAMERA.resolution)
KEYPOINTS = detect(TRUTH, error_m=0.02)
SEEN = SeenPoints.of(CAMERA, KEYPOINTS, TRACKS, ())


def network(seed: int = 0) -> Array:
    """A network's guess of the motion, in axes of its own: errors that last, and jitter."""
    rng = np.random.default_rng(seed)
    error = 0.6 * lasting(rng, POINTS.shape) + 0.3 * rng.normal(size=POINTS.shape)
    guess = about_hips(POINTS + error * STD_M[:, None] * [1.0, 2.2, 1.0])
    return guess @ Rotation.from_euler("zx", [130.0, 15.0], degrees=True).as_matrix().T


def aligned(points: Array, fps: float | None = None, seen: SeenPoints = SEEN) -> AlignedReference:
    return align(ReferenceMotion(points, fps), BODY, seen, TRACKS.time_s, 30.0)


def error_mm(found: AlignedReference) -> float:
    """Mean error of the points about the hips, where the motion is there [mm]."""
    known = found.known
    return 1e3 * float(np.linalg.norm((found.points - about_hips(POINTS))[known], axis=-1).mean())


def gain(found: AlignedReference) -> float:
    cost, usual = own_and_usual_cost(found, SEEN)
    return 1.0 - cost / usual


@cache
def faultless_mm() -> float:
    return error_mm(aligned(network()))


def test_a_motion_is_turned_and_placed_as_the_picture_shows() -> None:
    found = aligned(network())
    assert faultless_mm() < 60.0
    assert gain(found) > 0.6
    middle = POINTS - about_hips(POINTS)
    across = np.linalg.norm((found.hips - middle[:, 0])[:, [0, 2]], axis=-1)
    assert np.median(across) < 0.03
    assert not found.exchanged.any()
    assert found.lag == 0


@pytest.mark.parametrize("size", [1.15, 100.0])
def test_its_own_size_does_not_matter(size: float) -> None:
    assert error_mm(aligned(size * network())) == pytest.approx(faultless_mm(), rel=1e-3)


def test_a_lag_is_taken_back() -> None:
    late = np.concatenate([network()[:1]] * 3 + [network()[:-3]])
    found = aligned(late)
    assert found.lag == 3
    assert error_mm(found) < 1.03 * faultless_mm()
    assert not found.known[-3:].any()


def test_exchanged_sides_are_told_by_their_jump_whatever_the_detector_says() -> None:
    points, frames = network(), np.zeros(FRAMES, dtype=bool)
    frames[30:50] = True
    points[frames] = points[frames][:, OPPOSITE]
    found = aligned(points)
    np.testing.assert_array_equal(found.exchanged, frames)
    assert error_mm(found) < 1.03 * faultless_mm()
    wrong = SeenPoints.of(CAMERA, sides_exchanged(KEYPOINTS, frames), TRACKS, ())
    assert not aligned(network(), seen=wrong).exchanged.any()


def test_absent_and_repeated_frames_are_unknown() -> None:
    points = network()
    points[10:14] = points[9]
    points[20:23] = np.nan
    found = aligned(points)
    assert np.flatnonzero(~found.known).tolist() == [10, 11, 12, 13, 20, 21, 22]
    assert error_mm(found) < 1.03 * faultless_mm()
    filled = smoothed(found.points, TRACKS.time_s, 0.09)
    assert np.isfinite(filled).all()


def test_a_stated_rate_counts_unless_the_motion_lies_about_it() -> None:
    half = network()[::2]
    assert error_mm(aligned(half, 15.0)) < 1.2 * faultless_mm()
    assert error_mm(aligned(network(), 24.0)) == pytest.approx(faultless_mm(), rel=1e-6)


def test_motions_of_something_else_gain_nothing() -> None:
    order = np.random.default_rng(2).permutation(FRAMES)
    assert gain(aligned(network()[order])) < 0.25
    wandering = network().mean(axis=0) + 0.25 * lasting(np.random.default_rng(3), POINTS.shape)
    assert gain(aligned(wandering)) < 0.25


def test_smoothing_takes_jitter_and_leaves_motion() -> None:
    rng, slow = np.random.default_rng(4), BODY.points(BODY.pose(exercise(FRAMES)))
    noisy = slow + 0.01 * rng.normal(size=slow.shape)
    noisy[40, 5] += 0.5
    calm = smoothed(noisy, TRACKS.time_s, 0.09)
    off = [np.diff(one - slow, n=2, axis=0) for one in (noisy, calm)]
    before, after = (np.linalg.norm(one, axis=-1).mean() for one in off)
    assert after < 0.2 * before
    assert np.linalg.norm(calm - slow, axis=-1).mean() < 0.6 * np.linalg.norm(noisy - slow, axis=-1).mean()
    assert np.linalg.norm(calm[40, 5] - slow[40, 5]) < 0.05


def test_a_place_is_that_of_what_is_seen() -> None:
    inside = np.einsum("fji,fpj->fpi", SEEN.rotation, about_hips(POINTS))
    exact = SeenPoints.of(CAMERA, detect(TRUTH, 0.0, place_error_m=0.0), TRACKS, ())
    kept = exact.mean[:, POINTS.shape[1] - 12 :].sum(axis=1) > 0.0  # the nose is no head
    placed = place(inside, replace(exact, confidence=exact.confidence * kept))
    middle = CAMERA.world_to_camera((POINTS - about_hips(POINTS))[:, 0])
    np.testing.assert_allclose(placed.place, middle, atol=2e-3)


# --- In a take


def take_of(
    points: Array, posed: tuple[int, ...] = (), keypoints: Keypoints = KEYPOINTS, hints: Array | None = None
) -> Take:
    hint = np.full((FRAMES, len(keypoints.names), 3), np.nan) if hints is None else hints
    frames = tuple(
        SeenPeople(keypoints.pixel[i : i + 1], keypoints.score[i : i + 1], hint[i : i + 1])
        for i in range(FRAMES)
    )
    return Take(
        folder=Path(),
        clip=Path("clip.mp4"),
        fps=30.0,
        frame_start=1,
        frame_count=FRAMES,
        camera=CAMERA,
        body=BODY,
        markers=(),
        keyframes=tuple(Keyframe(index, TRUTH[index]) for index in posed),
        keypoints=(People(keypoints.names, "detector", CAMERA.resolution, frames),),
        contours=False,
        reference=ReferenceMotion(points, None, "folder/network.csv"),
    )


def said_of(take: Take) -> ReferenceEvidence:
    said = reference_evidence(seen_take(take, Reading(TRACKS)))
    assert isinstance(said, ReferenceEvidence)
    return said


def off_mm(said: ReferenceEvidence, frame: int) -> float:
    return 1e3 * float(
        np.linalg.norm(said.expected.points[frame] - about_hips(POINTS)[frame], axis=-1).mean()
    )


def test_posed_keyframes_correct_it_nearby_and_take_the_place_of_found_ones() -> None:
    plain, posed = said_of(take_of(network())), said_of(take_of(network(), (40,)))
    assert off_mm(posed, 40) < 0.2 * off_mm(plain, 40)
    assert off_mm(posed, 43) < 0.9 * off_mm(plain, 43)
    for name, said in (("plain", plain), ("posed", posed)):
        assert_recorded(f"reference {name}", said.expected.points, share=1e-4)
        assert_recorded(f"reference {name}, worth", [said.error_m, said.gain, said.confidence], share=1e-3)
        assert_recorded(f"reference {name}, error", said.expected.whitening, share=1e-3)
    index = [key.index for key in posed.keyframes]
    assert min(abs(one - 40) for one in index) > 9
    assert len(plain.keyframes) == 7
    both = with_reference(take_of(network(), (40,)), posed).keyframes
    assert [key.index for key in both] == sorted([*index, 40])


def test_what_is_of_something_else_is_left_out_and_said() -> None:
    shuffled = network()[np.random.default_rng(2).permutation(FRAMES)]
    said = reference_evidence(seen_take(take_of(shuffled), Reading(TRACKS)))
    assert isinstance(said, NoReference)
    assert "network.csv: is set aside" in said.notes[0]
    half = network()
    half[40:] = shuffled[40:]
    part = said_of(take_of(half))
    assert part.left_out[45:].mean() > 0.8
    assert not part.left_out[:33].any()
    assert np.isnan(part.expected.points[60]).all()
    assert "left out" in " ".join(part.notes)


def test_the_detectors_own_guess_is_no_other_evidence() -> None:
    names = [KEYPOINTS.names.index(name) if name != "head" else 0 for name in HUMAN.point_names]
    hints = np.full((FRAMES, len(KEYPOINTS.names), 3), np.nan)
    hints[:, names] = network()
    said = reference_evidence(seen_take(take_of(network(), hints=hints), Reading(TRACKS)))
    assert isinstance(said, NoReference)
    assert "came with the keypoints" in said.notes[0]


@pytest.mark.parametrize(
    ("depth", "error_m", "sure"), [(1.0, 0.067, True), (4.0, 0.156, False), (-1.0, 0.0, False)]
)
def test_how_far_it_errs_in_depth_is_told_by_the_guess_of_the_keypoints(
    depth: float, error_m: float, sure: bool
) -> None:
    rng = np.random.default_rng(8)
    rotation, _ = CAMERA.pose()
    away = -rotation[:, 2]
    names = [KEYPOINTS.names.index(name) if name != "head" else 0 for name in HUMAN.point_names]
    hints = np.full((FRAMES, len(KEYPOINTS.names), 3), np.nan)
    true = about_hips(POINTS)
    hints[:, names] = true @ rotation * [1.0, -1.0, -1.0] + rng.normal(size=true.shape) * [0.03, 0.03, 0.1]
    wrong = 0.6 * lasting(rng, POINTS.shape) * STD_M[:, None]
    wrong += (abs(depth) - 1.0) * 2.2 * (wrong @ away)[..., None] * away
    if depth < 0.0:
        wrong -= 2.0 * (true @ away)[..., None] * away
    said = reference_evidence(seen_take(take_of(about_hips(true + wrong), hints=hints), Reading(TRACKS)))
    if depth < 0.0:
        assert isinstance(said, NoReference) and "near for far" in said.notes[0]
        hints[10:] = np.nan  # a third of a second, in which all errs alike, is one case
        one = reference_evidence(seen_take(take_of(about_hips(true + wrong), hints=hints), Reading(TRACKS)))
        assert isinstance(one, ReferenceEvidence)
        return
    assert isinstance(said, ReferenceEvidence)
    assert said.error_m == pytest.approx(error_m, rel=0.1) and said.is_sure == sure
    take = take_of(network(), (0, 69))
    found = replace(
        take,
        keyframes=(
            *take.keyframes[:1],
            replace(said.keyframes[0], index=30, matched=Matched("composed", "", False, 0.6)),
        ),
    )
    kept = [key.index for key in with_reference(found, said).keyframes]
    assert (kept == [0, 30]) != sure


def test_a_take_with_nothing_posed_follows_it_and_one_set_aside_changes_nothing() -> None:
    reading = Reading(TRACKS)
    result = run(reconstruct(take_of(network()), "map", reading))
    error = about_hips(result.motion.points) - about_hips(POINTS)
    assert 1e3 * np.linalg.norm(error, axis=-1).mean() < 0.78 * faultless_mm()
    assert any("motion from elsewhere is followed" in note for note in result.notes)
    shuffled = network()[np.random.default_rng(2).permutation(FRAMES)]
    posed = (0, 23, 46, 69)
    aside = run(reconstruct(take_of(shuffled, posed), "map", reading))
    without = run(reconstruct(replace(take_of(shuffled, posed), reference=None), "map", reading))
    np.testing.assert_array_equal(aside.motion.points, without.motion.points)
    with pytest.raises(InputError, match="at least 2 keyframes"):
        run(reconstruct(take_of(shuffled), "map", reading))
    with pytest.raises(InputError, match="has 0 keyframes"):
        check_reconstructible(take_of(network()), "interpolation")
