"""Means of the likely parts around a path."""

from dataclasses import replace

import numpy as np
import pytest
from _performed import BODY, camera, filmed, performed
from keymark.core.body.human import HUMAN, LIMBS
from keymark.core.body.posture import Posture
from keymark.core.poses.clip_input import posing_input
from keymark.core.poses.compose_clip import mean_postures
from keymark.core.poses.composed_path import ComposedPath
from keymark.core.poses.composed_states import FrameStates
from keymark.core.poses.part_features import HEADINGS, StanceFeatures, stance_features
from keymark.core.poses.part_pools import part_pools
from keymark.core.prior.library import Library
from keymark.core.session.stages import seen_in

ARM = "arm.L"
STANCE, HIPS = 3, np.array([0.2, 0.1, 0.9])


@pytest.fixture(scope="module")
def known(walking: Library) -> StanceFeatures:
    pools = part_pools([walking], BODY)
    take, reading = filmed(performed(walking, 0.0), camera())
    return stance_features(pools, posing_input(seen_in(take, reading)).evidence)


def path_of(known: StanceFeatures, arms: dict[int, float]) -> tuple[list[FrameStates], ComposedPath]:
    """One frame whose left arm has some probabilities, by part; the likeliest of them is on the path."""
    limbs = np.zeros((1, len(LIMBS)), dtype=np.intp)
    limbs[0, LIMBS.index(ARM)] = max(arms, key=lambda part: arms[part])
    chance = {limb: np.eye(1, len(known.limbs[limb].points)) for limb in LIMBS}
    chance[ARM] = np.zeros_like(chance[ARM])
    chance[ARM][0, list(arms)] = list(arms.values())
    one = np.array([STANCE])
    states = FrameStates(one, HIPS[None].astype(np.float32), np.zeros(1, np.float32), limbs, one > HEADINGS)
    return [states], ComposedPath(one, HIPS[None], limbs, [np.ones(1, np.float32)], chance)


def mean_of(known: StanceFeatures, arms: dict[int, float]) -> Posture:
    states, path = path_of(known, arms)
    return mean_postures(known, states, path)


def points_of(posture: Posture) -> np.ndarray:
    """(P, 3) the principal points."""
    return BODY.points(BODY.pose(posture))[0]


def apart_by(known: StanceFeatures, least: float, most: float) -> tuple[int, int]:
    """Two left arms that are so far apart on average [m]."""
    points = known.limbs[ARM].points
    apart = np.linalg.norm(points[:, None] - points, axis=-1).mean(axis=-1)
    first, second = np.argwhere((apart > least) & (apart < most))[0]
    return int(first), int(second)


def test_what_is_certain_stays(known: StanceFeatures) -> None:
    _, path = path_of(known, {4: 1.0})
    exact = known.composed(path.stance, path.limbs, path.hips)
    assert points_of(mean_of(known, {4: 1.0})) == pytest.approx(points_of(exact), abs=1e-5)


def test_near_parts_are_averaged(known: StanceFeatures) -> None:
    one, other = apart_by(known, 0.08, 0.12)
    wrist = HUMAN.point_names.index("wrist.L")
    first, second = (points_of(mean_of(known, {part: 1.0})) for part in (one, other))
    both = points_of(mean_of(known, {one: 0.51, other: 0.49}))
    whole = np.linalg.norm(first[wrist] - second[wrist])
    assert np.linalg.norm(both[wrist] - first[wrist]) == pytest.approx(0.45 * whole, abs=0.2 * whole)
    others = [HUMAN.point_names.index(name) for name in ("head", "wrist.R", "ankle.L")]
    assert both[others] == pytest.approx(first[others], abs=1e-6)


def test_parts_of_another_kind_do_not_enter(known: StanceFeatures) -> None:
    one, other = apart_by(known, 0.45, 0.6)
    wrist = HUMAN.point_names.index("wrist.L")
    alone, both = points_of(mean_of(known, {one: 1.0})), points_of(mean_of(known, {one: 0.51, other: 0.49}))
    assert np.linalg.norm(both[wrist] - alone[wrist]) < 0.03


def test_turns_are_averaged_on_the_manifold(known: StanceFeatures) -> None:
    states, path = path_of(known, {0: 1.0})
    both = np.array([STANCE, STANCE + 1])
    twice = states[0].chosen(np.array([0, 0]))
    states = [replace(twice, stance=both)]
    chance = np.array([0.5, 0.5], np.float32)
    posture = mean_postures(known, states, replace(path, posterior=[chance]))
    shoulders = [HUMAN.point_names.index(f"shoulder.{side}") for side in "LR"]
    mean, alone = (points_of(each)[shoulders] for each in (posture, mean_of(known, {0: 1.0})))
    way, before = mean[0] - mean[1], alone[0] - alone[1]
    assert np.linalg.norm(way) == pytest.approx(np.linalg.norm(before), abs=1e-6)
    turned = np.degrees(np.arctan2(way[1], way[0]) - np.arctan2(before[1], before[0]))
    assert abs(turned) == pytest.approx(7.5, abs=1.5)
    assert path.stance[0] == STANCE
