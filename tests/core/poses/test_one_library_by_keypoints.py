"""One library alone, with keypoints beside markers or instead of them."""

from dataclasses import replace

import numpy as np
import pytest
from _performed import FRAMES, NAMES, camera, detected, errors_m, exchanged, filmed, performed, unmarked
from keymark.core.detect.keypoints import SeenPeople
from keymark.core.errors import InputError
from keymark.core.markers.reading import Reading
from keymark.core.poses.clip import pose_clip
from keymark.core.prior.library import Library
from keymark.core.progress import run
from keymark.core.session.stages import seen_in

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("heading_deg", [-100.0, 35.0])
@pytest.mark.parametrize("hinted", [False, True])
def test_walking_is_found_without_a_marker(walking: Library, heading_deg: float, hinted: bool) -> None:
    truth = performed(walking, np.radians(heading_deg))
    people = detected(truth, camera())
    people = people if hinted else people.without_hints()
    found = run(pose_clip(seen_in(*unmarked(truth, camera(), people)), [walking], floor_m=0.0))
    rooted, absolute = errors_m(found, truth)
    assert rooted < 0.075
    assert absolute < 0.2
    assert found.fit > 0.8


def test_wrong_points_and_exchanged_sides_do_no_harm(walking: Library) -> None:
    truth = performed(walking, np.radians(35.0))
    people = exchanged(detected(truth, camera(), wrong=0.2), range(10, 35))
    found = run(pose_clip(seen_in(*unmarked(truth, camera(), people)), [walking], floor_m=0.0))
    assert errors_m(found, truth)[0] < 0.075


def test_a_detector_whose_left_is_right_throughout_does_no_harm_beside_markers(walking: Library) -> None:
    truth = performed(walking, np.radians(35.0))
    take, reading = filmed(truth, camera())
    wrong = replace(take, keypoints=(exchanged(detected(truth, camera()), range(FRAMES)),))
    assert errors_m(run(pose_clip(seen_in(wrong, reading), [walking], floor_m=0.0)), truth)[0] < 0.075


def test_keypoints_find_the_arms_that_few_markers_leave_open(walking: Library) -> None:
    truth = performed(walking, np.radians(60.0))
    take, reading = filmed(truth, camera())
    names = ("centroid", "second_moment", "area", "quality", "clipped")
    trunk = {name: getattr(reading.tracks, name)[:, :1] for name in names}
    bare = replace(take, markers=take.markers[:1])
    seen = Reading(replace(reading.tracks, names=reading.tracks.names[:1], **trunk))
    alone = errors_m(run(pose_clip(seen_in(bare, seen), [walking], floor_m=0.0)), truth)[0]
    both = replace(bare, keypoints=(detected(truth, camera()),))
    assert errors_m(run(pose_clip(seen_in(both, seen), [walking], floor_m=0.0)), truth)[0] < 0.7 * alone


def test_keypoints_that_are_never_seen_change_nothing(walking: Library) -> None:
    truth = performed(walking, 0.6)
    take, reading = filmed(truth, camera())
    blind = detected(truth, camera())
    nobody = SeenPeople(np.zeros((0, len(NAMES), 2)), np.zeros((0, len(NAMES))), np.zeros((0, len(NAMES), 3)))
    blind = replace(blind, frames=(nobody,) * FRAMES)
    first, second = (
        run(pose_clip(seen_in(each, reading), [walking]))
        for each in (take, replace(take, keypoints=(blind,)))
    )
    np.testing.assert_array_equal(first.postures.to_vector(), second.postures.to_vector())


def test_a_take_with_neither_markers_nor_keypoints_is_refused(walking: Library) -> None:
    truth = performed(walking, 0.6)
    take, reading = unmarked(truth, camera(), detected(truth, camera()))
    with pytest.raises(InputError, match="neither markers nor keypoints"):
        run(pose_clip(seen_in(replace(take, keypoints=()), reading), [walking]))
    nobody = SeenPeople(np.zeros((0, len(NAMES), 2)), np.zeros((0, len(NAMES))), np.zeros((0, len(NAMES), 3)))
    blind = replace(take.keypoints[0], frames=(nobody,) * FRAMES)
    with pytest.raises(InputError, match="no keypoint is seen"):
        run(pose_clip(seen_in(replace(take, keypoints=(blind,)), reading), [walking]))
