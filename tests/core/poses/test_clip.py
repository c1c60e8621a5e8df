"""Poses of a clip that nobody posed, put together from the parts of several libraries."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from _performed import BODY, FRAMES, camera, detected, filmed, performed, unmarked
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.poses.clip import pose_clip
from keymark.core.poses.found_poses import FoundPoses, with_found
from keymark.core.prior.keyframes import Keyframe
from keymark.core.prior.library import Library, read_library
from keymark.core.progress import run
from keymark.core.session.stages import seen_in

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[3]


@cache
def libraries() -> tuple[Library, ...]:
    """Three shipped libraries, of which none has the motion below."""
    return tuple(
        read_library(ROOT / "presets" / "keyframes" / f"{name}.json")
        for name in ("walking", "waving", "squatting_lifting")
    )


@cache
def truth() -> Posture:
    """Somebody who walks and waves: legs and trunk of one library, an arm of another."""
    walking, waving, _ = libraries()
    legs, arms = performed(walking, np.radians(35.0)), performed(waving, np.radians(35.0))
    skeleton = legs.skeleton
    rotations, angles = np.array(legs.rotations), np.array(legs.angles)
    ball = [skeleton.joints[joint].name for joint in skeleton.ball_joints].index("shoulder.R")
    hinges = [skeleton.joints[joint].name for joint in skeleton.hinge_joints]
    rotations[:, ball] = arms.rotations[:, ball]
    for name in ("girdle.R", "elbow.R", "forearm.R"):
        angles[:, hinges.index(name)] = arms.angles[:, hinges.index(name)]
    return Posture(skeleton, legs.translation, rotations, angles)


@cache
def found_by_markers() -> FoundPoses:
    return run(pose_clip(seen_in(*filmed(truth(), camera())), libraries()))


def errors_m(postures: Posture) -> tuple[np.ndarray, np.ndarray]:
    """(F,) mean distance of the points from the truth, hips aligned and absolutely."""
    found, true = (BODY.points(BODY.pose(each)) for each in (postures, truth()))
    off = found - true
    hips = (postures.translation - truth().translation)[:, None]
    return np.linalg.norm(off - hips, axis=-1).mean(axis=-1), np.linalg.norm(off, axis=-1).mean(axis=-1)


def test_a_motion_of_no_library_is_found_by_five_markers() -> None:
    rooted, absolute = errors_m(found_by_markers().postures)
    assert rooted.mean() < 0.09
    assert absolute.mean() < 0.2


def test_and_by_keypoints() -> None:
    rooted, absolute = errors_m(
        run(
            pose_clip(
                seen_in(*unmarked(truth(), camera(), detected(truth(), camera()).without_hints())),
                libraries(),
            )
        ).postures
    )
    assert rooted.mean() < 0.08
    assert absolute.mean() < 0.25


def test_the_floor_is_the_ruler_where_the_performer_is_smaller_than_said() -> None:
    take, reading = unmarked(truth(), camera(), detected(truth(), camera()).without_hints())
    larger = replace(take, body=Body(Actor.from_stature(1.07 * 1.62)))
    found = run(pose_clip(seen_in(larger, reading), libraries(), floor_m=0.0))
    farther = (found.postures.translation - truth().translation)[:, 1]
    assert abs(farther.mean()) < 0.15  # by size alone 0.3


def test_candidates_are_distinct_and_the_chosen_one_is_the_clips() -> None:
    found = found_by_markers()
    assert found.frames[0].index == 0
    assert found.frames[-1].index == FRAMES - 1
    assert any(len(frame.candidates) > 1 for frame in found.frames)
    for frame in found.frames:
        assert np.array_equal(frame.candidates[0].posture.rotations, found.postures[frame.index].rotations)
        batch = Posture.stack([each.posture for each in frame.candidates])
        shape = BODY.points(BODY.pose(batch)) - batch.translation[:, None]
        apart = np.linalg.norm(shape[:, None] - shape, axis=-1).mean(axis=-1)
        assert (apart[~np.eye(len(shape), dtype=bool)] > 0.08).all()
        assert all(0.0 <= each.confidence <= 1.0 for each in frame.candidates)


def test_between_two_posed_frames_only_those_change() -> None:
    take, reading = filmed(truth(), camera())
    found = with_found(take, found_by_markers())
    posed = tuple(Keyframe(index, truth()[index]) for index in (12, 37))
    others = tuple(key for key in found.keyframes if abs(key.index - 12) > 2 and abs(key.index - 37) > 2)
    corrected = replace(take, keyframes=tuple(sorted((*posed, *others), key=lambda key: key.index)))
    again = run(pose_clip(seen_in(corrected, reading), libraries(), between=(12, 37), frames=(20, 29)))
    assert [frame.index for frame in again.frames] == [20, 29]
    rooted, _ = errors_m(again.postures)
    assert rooted[[12, 37]].max() < 0.02
    assert rooted[12:38].mean() < errors_m(found_by_markers().postures)[0][12:38].mean()
    changed = {key.index: key for key in with_found(corrected, again).keyframes}
    outside = [key for key in corrected.keyframes if not 12 <= key.index <= 37]
    assert all(changed[key.index] is key for key in outside)
    assert changed[12].matched is None and changed[20].matched is not None
