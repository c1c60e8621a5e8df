"""Hands turn, bend and close as they are seen, but where looks contradict each other or a person posed."""

import numpy as np
import pytest
from _recorded import assert_recorded
from _scene import BODY, CAMERA, exercise
from keymark.core.body.fingers import SURE
from keymark.core.body.posture import Posture
from keymark.core.body.rotations import exponential, hinge, logarithm
from keymark.core.detect.keypoints import FACING, HAND_NUMBERS, Keypoints
from keymark.core.feet.palms import seen_hands
from keymark.core.terms.head import viewer_axes

FRAMES, SIDES = 40, ("L", "R")
TIME_S = np.arange(FRAMES) / 30.0
TRUE_RAD = np.stack([0.9 * np.sin(5.0 * TIME_S), np.full(FRAMES, -1.0)], axis=1)


def columns() -> list[int]:
    skeleton = BODY.skeleton
    return [skeleton.hinge_joints.index(skeleton.joint_index(f"forearm.{side}")) for side in SIDES]


def film(posture: Posture, bent_rad: float = 0.0, curl_rad: float = 1.0) -> Keypoints:
    """Hands seen every other frame, turned by `TRUE_RAD`, closed, and bent a little at the wrist."""
    pose, skeleton = BODY.pose(posture), BODY.skeleton
    hands = np.full((FRAMES, 2, HAND_NUMBERS), np.nan)
    for row, side in enumerate(SIDES):
        joint = skeleton.joint_index(f"forearm.{side}")
        axis = skeleton.hinge_axes[columns()[row]]
        forearm = pose.rotation[:, skeleton.joints[joint].parent]
        turn = forearm @ hinge(axis, TRUE_RAD[:, row]) @ exponential(np.array([0.0, bent_rad, 0.0]))
        pixel = CAMERA.project(pose.place(joint, np.zeros(3)))[0]
        seen = np.swapaxes(viewer_axes(CAMERA, pixel, np.arange(FRAMES)), -1, -2) @ turn @ FACING.T
        look = np.column_stack([logarithm(seen), np.full((FRAMES, 2), 0.98), np.full((FRAMES, 5), curl_rad)])
        hands[::2, row] = np.column_stack([pixel, look, look])[::2]
    none = np.zeros((FRAMES, 0))
    return Keypoints((), (), np.zeros((FRAMES, 0, 2)), none, np.zeros((FRAMES, 0, 3)), (), None, hands)


def off_deg(posture: Posture) -> np.ndarray:
    return np.degrees(np.abs(posture.angles[:, columns()] - TRUE_RAD))


def test_palms_follow_what_is_seen_and_points_stay() -> None:
    posture = exercise(FRAMES)
    found, hands = seen_hands(BODY, posture, TIME_S, film(posture, 0.3), CAMERA)
    assert np.median(off_deg(found)) < 8.0 < 30.0 < np.median(off_deg(posture))
    points = [BODY.points(BODY.pose(each)) for each in (posture, found)]
    np.testing.assert_allclose(points[0], points[1], atol=1e-12)
    assert hands is not None and hands.sure.min() > SURE
    np.testing.assert_allclose(
        hands.bend[1:], np.broadcast_to([0.0, 0.3, 0.0], (FRAMES - 1, 2, 3)), atol=0.02
    )
    np.testing.assert_allclose(hands.curls, 1.0)
    assert seen_hands(BODY, posture, TIME_S, Keypoints.none(FRAMES), CAMERA) == (posture, None)


def test_one_look_that_takes_the_back_for_the_palm_is_passed_over() -> None:
    posture, seen = exercise(FRAMES), film(exercise(FRAMES))
    assert seen.hands is not None
    looks = np.array(seen.hands)
    flipped = (
        exponential(looks[10:15:2, 0, 2:5]) @ FACING @ exponential(np.array([np.pi, 0.0, 0.0])) @ FACING.T
    )
    looks[10:15:2, 0, 2:5] = logarithm(flipped)
    wrong = Keypoints((), (), seen.pixel, seen.score, seen.hint_m, (), None, looks)
    found, hands = seen_hands(BODY, posture, TIME_S, wrong, CAMERA)
    assert off_deg(found)[:, 0].max() < 35.0
    assert hands is not None and hands.sure[12, 0] < 0.9 < hands.sure[12, 1]
    rng = np.random.default_rng(3)
    for first in (2, 12):  # both looks
        looks[..., first : first + 3] += 0.5 * rng.normal(size=(FRAMES, 2, 3))
        looks[..., first + 3] = rng.uniform(0.2, 1.0, (FRAMES, 2))
    shaken = Keypoints((), (), seen.pixel, seen.score, seen.hint_m, (), None, looks)
    found, hands = seen_hands(BODY, posture, TIME_S, shaken, CAMERA)
    assert hands is not None
    assert_recorded("palms", found.angles, hands.bend, hands.sure, share=1e-4)


@pytest.mark.parametrize("frame", [0, 21])
def test_what_is_posed_wins(frame: int) -> None:
    posture = exercise(FRAMES)
    found, _ = seen_hands(BODY, posture, TIME_S, film(posture), CAMERA, [frame])
    np.testing.assert_array_equal(found.angles[frame], posture.angles[frame])
    assert off_deg(found)[35].max() < 10.0
