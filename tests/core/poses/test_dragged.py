"""Dragged joints: under the mouse where they can be, lengths exact, joint limits held, the rest in place."""

import numpy as np
import pytest
from _performances import (
    BODY,
    POINT,
    beyond_limits_rad,
    camera_around,
    natural_posture,
    pixels,
    points,
    segment_lengths,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from keymark.core.body.body_volume import standing_posture
from keymark.core.body.human import HUMAN, TRUNK, limb_of
from keymark.core.body.posture import Posture
from keymark.core.body.rotations import hinge
from keymark.core.estimate.performer_placement import SHOE_M, standing_ankle_m
from keymark.core.poses.dragged import dragged, paths_through
from keymark.core.prior.keyframes import Keyframe

SEEDS = st.integers(0, 2**32 - 1)
ACROSS = np.array([0.0, 1.0, 0.0])
"""Direction of sight of a view from the front."""


@settings(max_examples=40)
@given(SEEDS, st.sampled_from([name for name in HUMAN.point_names if name.partition(".")[0] != "hip"]))
def test_a_joint_goes_where_another_posture_has_it(seed: int, point: str) -> None:
    posture, camera = natural_posture(seed, 0.6), camera_around(seed)
    rng = np.random.default_rng(seed)
    part = limb_of(point)
    step = np.array(
        [
            0.12 * rng.normal() if limb_of(name.rpartition(".")[0]) == part or _roots(name, part) else 0.0
            for name in HUMAN.dof_names
        ]
    )
    step[:6] = 0.0
    place = points(posture.plus(step))[POINT[point]]
    result = dragged(BODY, posture, point, place, camera.sight(place))
    np.testing.assert_allclose(segment_lengths(result), segment_lengths(posture), atol=1e-9)
    off = pixels(result, camera)[POINT[point]] - camera.project(place)[0]
    assert np.linalg.norm(off) < (1.0 if part != TRUNK else 4.0)


def _roots(dof: str, part: str) -> bool:
    """Whether a degree of freedom is of the ball that a limb hangs on."""
    kind, _, side = part.partition(".")
    return dof.startswith({"arm": "shoulder", "leg": "hip"}.get(kind, "neck") + (f".{side}" if side else "."))


@pytest.mark.parametrize("point", ["ankle.L", "hip.R"])
def test_no_ankle_is_dragged_through_the_floor(point: str) -> None:
    standing = standing_posture(BODY)
    lowered = standing.translation - [0.0, 0.0, 0.2]
    posture = Posture(standing.skeleton, lowered, standing.rotations, standing.angles)
    for side in "LR":  # with bent knees
        ankle = points(posture)[POINT[f"ankle.{side}"]] + [0.0, 0.0, 0.2]
        posture = dragged(BODY, posture, f"ankle.{side}", ankle, ACROSS)
    down = np.array([0.0, 0.94, -0.34]) / np.hypot(0.94, 0.34)
    place = points(posture)[POINT[point]] + [0.0, 0.0, -0.25]
    free = points(dragged(BODY, posture, point, place, down))[:, 2]
    held = dragged(BODY, posture, point, place, down, floor_m=0.0)
    ankles = [POINT["ankle.L"], POINT["ankle.R"]]
    least = standing_ankle_m(BODY) - SHOE_M
    assert free[ankles].min() < least - 0.05
    assert points(held)[ankles, 2].min() > least - 0.002
    if point == "hip.R":  # seen where it was dragged to: it only comes nearer
        assert np.linalg.norm(np.cross(points(held)[POINT[point]] - place, down)) < 0.02


def test_dragging_above_the_floor_asks_for_none() -> None:
    posture = standing_posture(BODY)
    place = points(posture)[POINT["ankle.L"]] + [0.1, 0.0, 0.2]
    without, with_floor = (dragged(BODY, posture, "ankle.L", place, ACROSS, floor_m=f) for f in (None, 0.0))
    np.testing.assert_array_equal(without.angles, with_floor.angles)


@pytest.mark.parametrize("point", ["wrist.L", "ankle.R", "elbow.R", "knee.L"])
def test_only_the_limb_moves(point: str) -> None:
    posture = standing_posture(BODY)
    place = points(posture)[POINT[point]] + [0.08, 0.0, 0.12]
    result = dragged(BODY, posture, point, place, ACROSS)
    moved = np.linalg.norm(points(result) - points(posture), axis=-1)
    others = [
        POINT[name]
        for name in HUMAN.point_names
        if limb_of(name) != limb_of(point) and not name.startswith("shoulder")
    ]
    assert moved[others].max() < 1e-9
    assert moved[POINT[point]] > 0.05


def test_a_wrist_out_of_reach_stretches_the_arm_towards_it() -> None:
    posture = standing_posture(BODY)
    before = points(posture)
    place = before[POINT["shoulder.L"]] + [1.5, 0.0, 0.3]
    after = points(dragged(BODY, posture, "wrist.L", place, ACROSS))
    arm = after[POINT["wrist.L"]] - after[POINT["shoulder.L"]]
    toward = place - after[POINT["shoulder.L"]]
    assert arm @ toward / np.linalg.norm(arm) / np.linalg.norm(toward) > 0.99
    np.testing.assert_allclose(
        segment_lengths(dragged(BODY, posture, "wrist.L", place, ACROSS)), segment_lengths(posture), atol=1e-9
    )


def test_an_elbow_swings_about_a_wrist_that_stays() -> None:
    vector = standing_posture(BODY).to_vector()
    vector[HUMAN.dof_names.index("elbow.L.flexion")] = 1.2
    posture = Posture.from_vector(HUMAN, vector)
    before = points(posture)
    root, elbow, wrist = (before[POINT[name]] for name in ("shoulder.L", "elbow.L", "wrist.L"))
    axis = (wrist - root) / np.linalg.norm(wrist - root)
    swung = root + hinge(axis, 0.5) @ (elbow - root)
    place = np.array([swung[0], elbow[1], swung[2]])
    after = points(dragged(BODY, posture, "elbow.L", place, ACROSS))
    assert np.linalg.norm((after - before)[POINT["wrist.L"]]) < 0.04
    assert np.linalg.norm((after[POINT["elbow.L"]] - place)[[0, 2]]) < 0.003


def test_joint_limits_hold_a_limb_back() -> None:
    posture = standing_posture(BODY)
    before = points(posture)
    place = before[POINT["ankle.L"]] + [0.0, -0.9, 0.6]
    result = dragged(BODY, posture, "ankle.L", place, np.array([1.0, 0.0, 0.0]))
    assert beyond_limits_rad(result).max() < np.radians(5.0)


def test_what_is_set_beyond_joint_limits_is_not_taken_back() -> None:
    vector = standing_posture(BODY).to_vector()
    vector[HUMAN.dof_names.index("hip.L.rotation_x")] = 1.2
    posture = Posture.from_vector(HUMAN, vector)
    assert beyond_limits_rad(posture).max() > 0.3
    result = dragged(BODY, posture, "ankle.L", points(posture)[POINT["ankle.L"]], ACROSS)
    np.testing.assert_allclose(result.minus(posture), 0.0, atol=1e-6)


def test_hips_take_the_whole_body_along() -> None:
    posture = natural_posture(3)
    shift = np.array([0.3, -0.2, 0.1])
    place = points(posture)[POINT["hip.R"]] + shift
    moved = points(dragged(BODY, posture, "hip.R", place, ACROSS)) - points(posture)
    np.testing.assert_allclose(moved, np.tile(shift, (13, 1)), atol=1e-12)


def test_a_shoulder_leans_the_trunk_over_standing_feet() -> None:
    posture = standing_posture(BODY)
    before = points(posture)
    place = before[POINT["shoulder.L"]] + [0.15, 0.0, -0.05]
    after = points(dragged(BODY, posture, "shoulder.L", place, ACROSS))
    feet = [POINT["ankle.L"], POINT["ankle.R"]]
    assert np.linalg.norm((after - before)[feet], axis=-1).max() < 0.02
    assert np.linalg.norm((after[POINT["shoulder.L"]] - place)[[0, 2]]) < 0.01


def test_pushing_moves_a_wrist_in_depth_and_keeps_its_image() -> None:
    vector = standing_posture(BODY).to_vector()
    vector[HUMAN.dof_names.index("elbow.L.flexion")] = 1.2
    posture = Posture.from_vector(HUMAN, vector)
    before = points(posture)[POINT["wrist.L"]]
    after = points(dragged(BODY, posture, "wrist.L", before - 0.1 * ACROSS, ACROSS, pushed=True))
    moved = after[POINT["wrist.L"]] - before
    assert moved[1] == pytest.approx(-0.1, abs=0.01)
    assert np.linalg.norm(moved[[0, 2]]) < 0.01


def test_pushing_an_elbow_goes_as_far_as_the_upper_arm_is_long() -> None:
    posture = standing_posture(BODY, arms_lowered_rad=0.0)
    before = points(posture)[POINT["elbow.L"]]
    after = points(dragged(BODY, posture, "elbow.L", before - 0.2 * ACROSS, ACROSS, pushed=True))
    assert (after[POINT["elbow.L"]] - before)[1] < -0.1


def test_an_unknown_point_is_refused() -> None:
    with pytest.raises(KeyError):
        dragged(BODY, standing_posture(BODY), "nose", np.zeros(3), ACROSS)


@pytest.mark.parametrize("index", [10, 14])
def test_a_path_meets_the_dragged_posture_and_rests_at_other_keyframes(index: int) -> None:
    standing = standing_posture(BODY)
    keyframes = [Keyframe(at, standing) for at in (0, 10, 20)]
    place = points(standing)[POINT["wrist.L"]] + [0.1, 0.0, 0.2]
    moved = dragged(BODY, standing, "wrist.L", place, ACROSS)
    before, after = paths_through(BODY, keyframes, index, moved, "wrist.L", np.arange(21))
    apart = np.linalg.norm(after - before, axis=-1)
    np.testing.assert_allclose(after[index], points(moved)[POINT["wrist.L"]], atol=1e-9)
    kept = [0, 20] if index == 10 else [0, 10, 20]
    np.testing.assert_allclose(apart[kept], 0.0, atol=1e-9)
    assert apart[index - 2] > 0.02 and apart[index + 2] > 0.02
