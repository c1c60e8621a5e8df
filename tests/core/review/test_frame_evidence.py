"""What markers and keypoints together leave hidden, and what of them contradicts the motion."""

from dataclasses import replace

import numpy as np
import pytest
from _performances import made_up_keypoints
from keymark.core.detect.keypoints import BODY_POINTS
from keymark.core.review.compared_keypoints import ComparedKeypoints, part_of
from keymark.core.review.frame_evidence import ContourSight, Sight, believed_misfits, frame_evidence
from keymark.core.review.weak_frames import FrameEvidence

FRAMES = 6


def of_names(names: tuple[str, ...]) -> ComparedKeypoints:
    """Keypoints of a source, all seen where the motion puts them."""
    places, numbers = np.zeros((FRAMES, len(names), 2)), np.zeros((FRAMES, len(names)))
    no = numbers > 0.0
    return ComparedKeypoints(
        names, ("a",) * len(names), places, places, numbers + 0.9, numbers, numbers + 1.0, no, no
    )


def evidence_of(
    segments: tuple[str, ...], quality: np.ndarray, misfit: np.ndarray, keypoints: ComparedKeypoints
) -> FrameEvidence:
    alike, markers = np.ones(FRAMES), Sight(segments, quality, misfit)
    return frame_evidence(alike, alike, alike, markers, ContourSight.none(FRAMES), keypoints)


@pytest.mark.parametrize("name", BODY_POINTS)
def test_every_body_point_is_a_part_that_stays_on_its_side(name: str) -> None:
    part = part_of(name)
    assert part in BODY_POINTS and part == part_of(part)
    assert part == "head" or part.partition(".")[2] == name.partition(".")[2]


def test_points_of_the_face_are_one_witness() -> None:
    keypoints = of_names(("nose", "ear.L", "ear.R", "wrist.L"))
    keypoints.distance_px[:] = [1.0, 2.0, 30.0, 3.0]
    keypoints.distance_px[1, 0], keypoints.distance_px[2, :3] = np.nan, np.nan
    keypoints.confidence[:, 1] = 1.0
    assert keypoints.parts() == ("head", "wrist.L")
    assert keypoints.by_part(keypoints.distance_px)[:3] == pytest.approx(
        np.array([[2.0, 3.0], [16.0, 3.0], [np.nan, 3.0]]), nan_ok=True
    )
    assert keypoints.quality()[0].tolist() == [1.0, 0.9]


def test_points_that_are_left_out_all_along_are_missed_by_nobody() -> None:
    keypoints = of_names(("wrist.L", "knee.R"))
    keypoints.expected_px[:, 0], keypoints.confidence[:, 0] = np.inf, 0.0
    assert keypoints.parts() == ("knee.R",) and keypoints.quality().shape == (FRAMES, 1)
    assert np.isnan(keypoints.misfit[:, 0]).all() and np.isfinite(keypoints.misfit[:, 1]).all()


def test_points_that_are_seen_in_few_frames_are_not_missed_in_the_others() -> None:
    keypoints = of_names(("wrist.L", "knee.R", "head"))
    keypoints.confidence[1:, 0] = keypoints.confidence[4:, 1] = 0.0
    keypoints.confidence[:, 2] = 0.0
    assert keypoints.parts() == ("wrist.L", "knee.R")
    assert keypoints.quality()[:, 0].tolist() == [0.9, *[1.0] * 5]
    assert keypoints.quality()[:, 1].tolist() == [*[0.9] * 4, 0.0, 0.0]


def test_what_is_thrown_out_has_no_say_in_the_confidence() -> None:
    keypoints = made_up_keypoints(FRAMES)
    keypoints.distance_px[1, [0, 2]], keypoints.thrown_out[1, [0, 2]] = 40.0, True
    markers = np.full((FRAMES, 1), 0.5)
    believed = believed_misfits(markers, ContourSight.none(FRAMES), keypoints)
    assert believed.shape == (FRAMES, 3)
    assert np.isnan(believed[1, 1]) and believed[0, 1] == pytest.approx(0.125)
    told = evidence_of(("trunk",), np.ones((FRAMES, 1)), markers, keypoints)
    assert told.points == ("wrist.L", "knee.R")
    assert told.misfit[1, 1] == pytest.approx(200.0)


def test_what_a_marker_or_a_keypoint_sees_is_not_hidden() -> None:
    names = ("elbow.L", "wrist.L", "knee.R")
    keypoints = of_names(names)
    keypoints.confidence[1, 1] = keypoints.confidence[1:3, 2] = 0.0
    quality = np.ones((FRAMES, 2))
    quality[:2, 0] = 0.0
    nothing = np.full((FRAMES, 2), np.nan)
    told = evidence_of(("forearm.L", "shin.L"), quality, nothing, keypoints)
    assert told.quality[:3].tolist() == [
        [0.9, 1.0, 0.9, 0.9, 0.9],
        [0.0, 1.0, 0.9, 0.0, 0.0],
        [1.0, 1.0, 1.0, 1.0, 0.0],
    ]
    alone = evidence_of(("forearm.L", "shin.L"), quality, nothing, of_names(()))
    assert np.array_equal(alone.quality, quality) and alone.points == ()


def test_contours_are_evidence_as_markers_are() -> None:
    far, nothing = np.full((FRAMES, 2), 7.0), ContourSight.none(FRAMES)
    contours = ContourSight(("forearm.L", "shin.L"), np.zeros((FRAMES, 2)), far, nothing.lines)
    keypoints = of_names(("elbow.L", "wrist.L"))
    none = Sight((), np.zeros((FRAMES, 0)), np.zeros((FRAMES, 0)))
    alike = np.ones(FRAMES)
    told = frame_evidence(alike, alike, alike, none, contours, keypoints)
    assert told.points == ("forearm.L", "shin.L", "elbow.L", "wrist.L")
    assert told.quality[0].tolist() == [0.9, 0.0, 0.9, 0.9]
    assert told.misfit[0].tolist() == [7.0, 7.0, 0.0, 0.0]
    assert believed_misfits(none.misfit, contours, keypoints)[0].tolist() == [7.0, 7.0, 0.0, 0.0]


def test_swapped_flags_and_places_keep_their_kind_in_a_cache() -> None:
    keypoints = replace(made_up_keypoints(FRAMES))
    arrays = keypoints.to_arrays()
    assert {array.dtype.kind for array in arrays.values()} == {"U", "f", "b"}
    again = ComparedKeypoints.from_arrays(arrays, FRAMES)
    assert again.names == keypoints.names and again.sources == keypoints.sources
    assert np.array_equal(again.swapped, keypoints.swapped) and again.swapped[4, 0]
