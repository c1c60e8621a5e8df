"""Hands of a motion: relaxed, and above the ground that they reach."""

import numpy as np
import pytest
from _scene import BODY
from keymark.core.body.body_volume import standing_posture
from keymark.core.body.kinematics import segment_ends
from keymark.core.body.posture import Posture
from keymark.core.body.rotations import logarithm
from keymark.core.finish.natural_extremities import CURL_RAD, DROOP_RAD, THICKNESS_M, natural_extremities

NAMES = BODY.skeleton.dof_names
FRAMES = 12
TIME_S = np.arange(FRAMES) / 30.0


def posed(**angles: float) -> Posture:
    """A held posture: T pose but for some degrees of freedom, named with `_` for `.`."""
    vector = np.zeros((FRAMES, len(NAMES)))
    vector[:, 2] = 0.95
    for name, value in angles.items():
        vector[:, NAMES.index(name.replace("__", "."))] = value
    return Posture.from_vector(BODY.skeleton, vector)


def bend(posture: Posture, side: str) -> float:
    """How far the hand is bent toward its palm [rad]."""
    turn = natural_extremities(BODY, posture, TIME_S).turns[f"hand.{side}"]
    return float(logarithm(turn)[FRAMES // 2, 1]) * (1.0 if side == "L" else -1.0)


@pytest.mark.parametrize(
    ("pronation", "expected"),
    [(0.0, CURL_RAD + DROOP_RAD), (np.pi, CURL_RAD - DROOP_RAD)],
    ids=["palm down", "palm up"],
)
def test_a_level_hand_droops(pronation: float, expected: float) -> None:
    for side in ("L", "R"):
        shown = posed(**{f"forearm__{side}__pronation": pronation})
        assert bend(shown, side) == pytest.approx(expected, abs=1e-6)


def test_a_hanging_hand_is_bent_toward_its_palm_only() -> None:
    arms_down = Posture.stack([standing_posture(BODY, arms_lowered_rad=np.pi / 2)] * FRAMES)
    turns = natural_extremities(BODY, arms_down, TIME_S).turns
    for side in ("L", "R"):
        assert np.abs(logarithm(turns[f"hand.{side}"])[:, 2]).max() < DROOP_RAD
        assert bend(arms_down, side) == pytest.approx(CURL_RAD, abs=0.2 * DROOP_RAD)


def test_fingers_do_not_pass_the_ground() -> None:
    vector = np.tile(standing_posture(BODY, arms_lowered_rad=np.pi / 2).to_vector(), (60, 1))
    vector[:, NAMES.index("pelvis.rotation_x")] = np.linspace(0.0, 1.9, 60)
    for side in ("L", "R"):
        vector[:, NAMES.index(f"hip.{side}.rotation_x")] = -np.linspace(0.0, 1.9, 60)
        vector[:, NAMES.index(f"shoulder.{side}.rotation_z")] = 0.0
    posture = Posture.from_vector(BODY.skeleton, vector)
    pose, time_s = BODY.pose(posture), np.arange(60) / 30.0
    natural = natural_extremities(BODY, posture, time_s)
    wrist, tip = segment_ends(BODY, pose, natural, "hand.L")
    _, rigid = segment_ends(BODY, pose, natural.without(["hand.L"]), "hand.L")
    assert wrist[-1, 2] < 0.5 * BODY.actor.segments_m["hand.L"] or rigid[-1, 2] > 0.0
    assert tip[:, 2].min() > min(rigid[:, 2].min(), 0.0)
    assert tip[:, 2].min() > -THICKNESS_M
