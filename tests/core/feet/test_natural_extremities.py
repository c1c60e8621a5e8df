"""Feet of a motion, flat at rest, rolled over heel and toes, never below the ground; and relaxed hands."""

import numpy as np
import pytest
from _scene import BODY
from keymark.core.body.body_volume import sole_offsets, standing_posture
from keymark.core.body.kinematics import RIGID, Extremities, segment_ends, segment_turn
from keymark.core.body.mirror import mirrored, other_side
from keymark.core.body.posture import Posture
from keymark.core.body.rotations import logarithm
from keymark.core.feet.natural_extremities import (
    CURL_RAD,
    DROOP_RAD,
    HANGING_RAD,
    THICKNESS_M,
    natural_extremities,
)
from keymark.core.feet.soles import TOES_DOWN_RAD, TOES_UP_RAD

FPS = 30.0
NAMES = BODY.skeleton.dof_names
LENGTHS = BODY.actor.segments_m
FLAT_M = 0.36 * LENGTHS["foot.L"]
HIPS_M = FLAT_M + 0.92 * (LENGTHS["thigh.L"] + LENGTHS["shin.L"])
STAND = (0.0, FLAT_M)


def walking(
    left: np.ndarray, right: np.ndarray, hips_y: np.ndarray | float = 0.0, hips_m: np.ndarray | float = HIPS_M
) -> Posture:
    """Postures whose ankles follow paths (F, 2) of y and height [m], upright, facing -Y."""
    vector = np.zeros((len(left), len(NAMES)))
    vector[:, 1], vector[:, 2] = hips_y, hips_m
    for side, path in (("L", left), ("R", right)):
        thigh, shin = LENGTHS[f"thigh.{side}"], LENGTHS[f"shin.{side}"]
        ahead, down = vector[:, 1] - path[:, 0], vector[:, 2] - path[:, 1]
        reach = np.minimum(np.hypot(ahead, down), 0.999 * (thigh + shin))
        knee = np.arccos((reach**2 - thigh**2 - shin**2) / (2.0 * thigh * shin))
        lift = np.arccos((thigh**2 + reach**2 - shin**2) / (2.0 * thigh * reach))
        vector[:, NAMES.index(f"hip.{side}.rotation_x")] = -np.arctan2(ahead, down) - lift
        vector[:, NAMES.index(f"knee.{side}.flexion")] = knee
    return Posture.from_vector(BODY.skeleton, vector)


def path(frames: int, *legs: tuple[int, int, tuple[float, float], float]) -> np.ndarray:
    """A path (F, 2) from `STAND` on: first and last frame of each move, its end, and a height between."""
    found = np.tile(np.array(STAND), (frames, 1))
    for first, last, end, above in legs:
        share = np.clip((np.arange(frames) - first) / (last - first), 0.0, 1.0)[:, None]
        eased = share**2 * (3.0 - 2.0 * share)
        found = found + eased * (np.array(end) - found[first])
        found[:, 1] += above * np.sin(np.pi * share[:, 0]) ** 2
    return found


def still(frames: int) -> np.ndarray:
    return np.tile(np.array(STAND), (frames, 1))


def times(posture: Posture) -> np.ndarray:
    """(F,) times."""
    return np.arange(posture.batch[0]) / FPS


def soles(posture: Posture, extremities: Extremities | None = None) -> np.ndarray:
    """(F, 2, 2, 3) heel and tip of both feet."""
    natural = natural_extremities(BODY, posture, times(posture)) if extremities is None else extremities
    pose, feet = BODY.pose(posture), []
    for name, offsets in zip(("foot.L", "foot.R"), sole_offsets(BODY), strict=True):
        turn = segment_turn(BODY, pose, natural, name)
        ankle = BODY.segment_ends(pose, name)[0]
        feet.append(ankle[:, None] + offsets @ np.swapaxes(turn, -1, -2))
    return np.stack(feet, axis=1)


def flexion(posture: Posture, side: str = "L") -> np.ndarray:
    """(F,) by how much a foot's toes are down against its shin [rad]."""
    return logarithm(natural_extremities(BODY, posture, times(posture)).turns[f"foot.{side}"])[:, 0]


@pytest.fixture
def step() -> Posture:
    """Ninety frames: both feet stand, the left one steps ahead, and the hips follow."""
    left = path(90, (30, 48, (-0.4, FLAT_M), 0.12))
    share = np.clip((np.arange(90) - 25.0) / 40.0, 0.0, 1.0)
    return walking(left, still(90), -0.15 * share)


def test_resting_soles_lie_flat_where_rigid_ones_dip(step: Posture) -> None:
    shown, rigid = soles(step), soles(step, RIGID)
    for frames, foot in ((slice(5, 25), 0), (slice(55, 85), 0), (slice(5, 85), 1)):
        assert np.abs(shown[frames, foot, :, 2]).max() < 1e-3
    assert rigid[..., 2].min() < -0.03 and shown[..., 2].min() > -2e-3  # between rests, too


def test_the_heel_rises_first_and_lands_first(step: Posture) -> None:
    heel, tip = np.moveaxis(soles(step)[:, 0, :, 2], 1, 0)
    rising = slice(31, 35)
    assert (tip[rising] < 0.012).all() and heel[34] > tip[34] + 0.02
    assert heel[46] < 0.01 < tip[46] - 0.01


def test_a_step_has_a_height_of_its_own() -> None:
    height = 0.17
    left = path(90, (30, 55, (-0.4, FLAT_M + height), 0.1))
    shown = soles(walking(left, still(90), np.linspace(0.0, -0.15, 90)))
    assert np.abs(shown[62:86, 0, :, 2] - height).max() < 2e-3
    assert np.abs(shown[5:25, 0, :, 2]).max() < 1e-3
    assert shown[55:, 0, :, 2].min() > height - 3e-3


def test_who_rises_on_the_toes_keeps_them_on_the_ground() -> None:
    left = path(220, (40, 55, (0.0, FLAT_M + 0.07), 0.0), (170, 185, STAND, 0.0))
    heel, tip = np.moveaxis(soles(walking(left, still(220)))[:, 0, :, 2], 1, 0)
    held = slice(95, 130)
    assert np.abs(tip[held]).max() < 5e-3
    assert (heel[held] > 0.05).all()


def test_a_foot_high_above_the_ground_hangs() -> None:
    left = path(90, (20, 40, (-0.25, 0.65), 0.0))
    np.testing.assert_allclose(flexion(walking(left, still(90)))[60:85], HANGING_RAD, atol=1e-4)


def test_a_resting_foot_keeps_its_heading_while_the_shin_turns() -> None:
    posture = walking(still(60), still(60))
    step = np.zeros((60, len(NAMES)))
    step[:, NAMES.index("shin.L.axial")] = np.radians(12.0) * np.sin(np.linspace(0.0, 6.0, 60))
    twisted = posture.plus(step)
    shown, rigid = soles(twisted), soles(twisted, RIGID)
    wander = [np.ptp(places[5:55, 0, 1, :2], axis=0).max() for places in (shown, rigid)]
    assert wander[0] < 0.1 * wander[1]


@pytest.mark.parametrize("seed", range(3))
def test_noise_does_not_make_feet_tremble(step: Posture, seed: int) -> None:
    noise = np.random.default_rng(seed).normal(0.0, 0.003, (90, len(NAMES)))
    noisy = step.plus(noise)
    for side in ("L", "R"):
        turn = natural_extremities(BODY, noisy, times(noisy)).turns[f"foot.{side}"]
        joint = next(s.joint for s in BODY.skeleton.segments if s.name == f"foot.{side}")
        shin = BODY.pose(noisy).rotation[:, joint]
        speed = [
            np.linalg.norm(logarithm(np.swapaxes(r[:-1], -1, -2) @ r[1:]), axis=-1)
            for r in (shin @ turn, shin)
        ]
        assert speed[0].mean() < 1.3 * speed[1].mean()
        assert speed[0].max() < speed[1].max() + np.radians(12.0)


def test_the_mirror_image_has_mirrored_feet(step: Posture) -> None:
    lean = np.zeros((90, len(NAMES)))
    lean[:, NAMES.index("hip.L.rotation_y")], lean[:, NAMES.index("hip.R.rotation_z")] = 0.15, 0.2
    leaning = step.plus(lean)
    lengths = {other_side(name): length for name, length in BODY.actor.segments_m.items()}
    opposite = type(BODY)(type(BODY.actor)(lengths))
    given = natural_extremities(BODY, leaning, times(step)).turns
    flipped = natural_extremities(opposite, mirrored(leaning), times(step)).turns
    signs = np.outer([-1.0, 1.0, 1.0], [-1.0, 1.0, 1.0])
    for one, other in (("foot.L", "foot.R"), ("foot.R", "foot.L"), ("hand.L", "hand.R")):
        np.testing.assert_allclose(flipped[other], given[one] * signs, atol=1e-7)


@pytest.mark.parametrize("seed", range(4))
def test_any_motion_keeps_the_ankles_range(seed: int) -> None:
    rng = np.random.default_rng(seed)
    low, high = BODY.skeleton.limits.T
    ends = [rng.uniform(np.maximum(low, -1.5), np.minimum(high, 1.5)) for _ in range(2)]
    share = np.linspace(0.0, 1.0, 60)[:, None]
    posture = Posture.from_vector(BODY.skeleton, (1.0 - share) * ends[0] + share * ends[1])
    for side in ("L", "R"):
        turn = natural_extremities(BODY, posture, times(posture)).turns[f"foot.{side}"]
        np.testing.assert_allclose(
            turn @ np.swapaxes(turn, -1, -2), np.broadcast_to(np.eye(3), turn.shape), atol=1e-9
        )
        angle = np.linalg.norm(logarithm(turn), axis=-1)
        assert angle.max() < max(TOES_DOWN_RAD, TOES_UP_RAD) + np.radians(30.0)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_few_frames_are_enough(count: int) -> None:
    posture = walking(still(count), still(count))
    assert np.isfinite(soles(posture)).all()


def test_every_stair_is_a_floor_of_its_own() -> None:
    rise, run = 0.17, 0.28
    left = path(110, (10, 26, (-run, FLAT_M + rise), 0.08), (46, 62, (-3 * run, FLAT_M + 3 * rise), 0.08))
    right = path(
        110, (28, 44, (-2 * run, FLAT_M + 2 * rise), 0.08), (64, 80, (-3 * run, FLAT_M + 3 * rise), 0.05)
    )
    climbed = np.clip((np.arange(110) - 10.0) / 62.0, 0.0, 1.0)
    hips = HIPS_M - 0.05 + 2.7 * rise * climbed
    shown = soles(walking(left, right, -2.8 * run * climbed, hips))
    for frames, foot, steps in ((slice(29, 43), 0, 1), (slice(47, 61), 1, 2), (slice(66, 105), 0, 3)):
        assert np.abs(shown[frames, foot, :, 2] - steps * rise).max() < 3e-3


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
