"""Fewer keys: the tolerance holds on the body, and costs as few keys as it must."""

import numpy as np
import pytest
from _rig import quaternion_rig, rig_values
from _scene import BODY, exercise
from keymark.core.body.posture import Posture
from keymark.core.keys.hermite import fit_keys
from keymark.core.keys.key_reduction import ReducedKeys, reduce_keys
from keymark.core.keys.rig import NO_TURN, Rig, RigBone, channel_count, rotation_matrices
from keymark.core.progress import run
from scipy.spatial.transform import Rotation

FRAMES = 50
TIMES = np.arange(1.0, FRAMES + 1.0)
KEYFRAMES = np.array([0, 17, 32, FRAMES - 1])


@pytest.fixture(scope="module")
def rig() -> Rig:
    return quaternion_rig()


@pytest.fixture(scope="module")
def values(rig: Rig) -> list[np.ndarray]:
    """A lively motion with a little noise in every frame, as an estimate has."""
    posture = exercise(FRAMES)
    noise = np.random.default_rng(5).normal(0.0, 0.002, (FRAMES, BODY.skeleton.dof_count))
    return rig_values(rig, posture.plus(noise))


def shown(rig: Rig, reduced: ReducedKeys) -> np.ndarray:
    """(F, P, 3) what the keys show."""
    return rig.pose([s.evaluate(TIMES, 0, FRAMES - 1) for s in reduced.splines]).points


def key_count(reduced: ReducedKeys) -> int:
    return sum(len(spline.keys) for spline in reduced.splines)


def test_the_rig_shows_the_body(rig: Rig) -> None:
    posture = exercise(6)
    places = rig.pose(rig_values(rig, posture)).points
    points = BODY.points(BODY.pose(posture))
    apart = np.linalg.norm(places[:, None] - points[:, :, None], axis=-1).min(axis=-1)
    assert apart.max() < 1e-9


@pytest.mark.parametrize("whole_pose", [False, True])
@pytest.mark.parametrize("tolerance_m", [0.004, 0.015])
def test_no_point_is_further_off_than_the_tolerance(
    rig: Rig, values: list[np.ndarray], tolerance_m: float, whole_pose: bool
) -> None:
    reduced = run(reduce_keys(rig, TIMES, values, tolerance_m, KEYFRAMES, whole_pose))
    distance = np.linalg.norm(shown(rig, reduced) - rig.pose(values).points, axis=-1)
    assert 0.4 * tolerance_m < distance.max() <= tolerance_m
    assert distance.max() == pytest.approx(reduced.furthest_m)


def test_keyframes_stay_keys_with_their_values(rig: Rig, values: list[np.ndarray]) -> None:
    for whole_pose in (False, True):
        reduced = run(reduce_keys(rig, TIMES, values, 0.01, KEYFRAMES, whole_pose))
        for spline, data in zip(reduced.splines, values, strict=True):
            assert set(KEYFRAMES) <= set(spline.keys)
            at = np.searchsorted(spline.keys, KEYFRAMES)
            assert spline.values[at] == pytest.approx(data[KEYFRAMES], abs=1e-12)


def test_fewer_keys_than_at_even_steps(rig: Rig, values: list[np.ndarray]) -> None:
    reduced = run(reduce_keys(rig, TIMES, values, 0.005, np.zeros(0, dtype=np.intp)))
    count = -(-key_count(reduced) // len(rig.bones))
    even = np.unique(np.round(np.linspace(0, FRAMES - 1, count)).astype(np.intp))
    none = np.zeros(0, dtype=np.intp)
    evenly = rig.pose([fit_keys(TIMES, d, even, none).evaluate(TIMES, 0, FRAMES - 1) for d in values])
    assert np.linalg.norm(evenly.points - rig.pose(values).points, axis=-1).max() > 0.0075
    assert key_count(reduced) < 0.5 * FRAMES * len(rig.bones)


def test_more_tolerance_needs_fewer_keys_and_poses_share_their_frames(
    rig: Rig, values: list[np.ndarray]
) -> None:
    counts = [key_count(run(reduce_keys(rig, TIMES, values, mm / 1e3, KEYFRAMES))) for mm in (5, 10, 20)]
    assert counts[0] > counts[1] > counts[2]
    poses = run(reduce_keys(rig, TIMES, values, 0.01, KEYFRAMES, True))
    assert len({tuple(spline.keys) for spline in poses.splines}) == 1


def test_a_point_can_be_held_more_tightly(rig: Rig, values: list[np.ndarray]) -> None:
    names = [bone.name for bone in rig.bones]
    ankle = rig.point_slices[names.index("shin.R")].start + 1
    tolerance = np.full((FRAMES, rig.point_slices[-1].stop), 0.02)
    tolerance[15:35, ankle] = 0.001
    reduced = run(reduce_keys(rig, TIMES, values, tolerance, KEYFRAMES))
    distance = np.linalg.norm(shown(rig, reduced) - rig.pose(values).points, axis=-1)
    assert distance[15:35, ankle].max() <= 0.001
    assert distance.max() > 0.01


def test_a_still_body_needs_its_first_and_last_key(rig: Rig) -> None:
    still = rig_values(rig, Posture.rest(BODY.skeleton, (FRAMES,)))
    reduced = run(reduce_keys(rig, TIMES, still, 0.005, np.zeros(0, dtype=np.intp)))
    assert {tuple(spline.keys) for spline in reduced.splines} == {(0, FRAMES - 1)}


@pytest.mark.parametrize("mode", ["XYZ", "YZX", "ZXY"])
def test_euler_channels_are_read_in_their_order(mode: str) -> None:
    angles = np.random.default_rng(1).uniform(-1.0, 1.0, (5, 3))
    turn = np.broadcast_to(np.eye(3), (5, 3, 3))
    for letter in mode:
        axis = "XYZ".index(letter)
        turn = Rotation.from_rotvec(angles[:, axis, None] * np.eye(3)[axis]).as_matrix() @ turn
    assert rotation_matrices(angles, mode) == pytest.approx(turn, abs=1e-12)


@pytest.fixture(scope="module")
def control_rig() -> Rig:
    """Two roots; a bone that moves on the first, one on it that the second turns, one that only moves."""
    turn = rotation_matrices(np.array([[0.3, -0.2, 0.5]]), "XYZ")[0]
    none, one = np.zeros((0, 3)), np.array([[0.0, 0.3, 0.1]])
    return Rig(
        (
            RigBone("torso", -1, "QUATERNION", np.eye(3), np.eye(3), np.zeros(3), one, np.eye(3)),
            RigBone("goal", -1, "XYZ", turn, turn.T, np.array([0.5, 0.0, 0.0]), one, turn),
            RigBone("foot", 0, "ZXY", turn, np.eye(3), np.array([0.0, 0.2, 0.0]), one, 0.01 * turn),
            RigBone("toe", 2, "XYZ", np.eye(3), turn, np.array([0.0, 0.1, 0.0]), one, turned_by=1),
            RigBone("pole", 1, NO_TURN, np.eye(3), np.eye(3), np.array([0.0, 0.0, 1.0]), none, np.eye(3)),
        )
    )


@pytest.fixture(scope="module")
def control_values(control_rig: Rig) -> list[np.ndarray]:
    rng = np.random.default_rng(8)
    time = np.linspace(0.0, 1.0, FRAMES)[:, None]
    values = []
    for bone in control_rig.bones:
        count = channel_count(bone.mode) + (0 if bone.location_axes is None else 3)
        wave = 0.3 * np.sin(2.0 * np.pi * (rng.uniform(0.5, 2.0, count) * time + rng.uniform(0, 1, count)))
        values.append(wave + np.eye(count)[0] * (bone.mode == "QUATERNION"))
    return values


def test_bones_of_a_control_rig_move_on_what_carries_them(
    control_rig: Rig, control_values: list[np.ndarray]
) -> None:
    pose = control_rig.pose(control_values)
    joints = [pose.points[:, where.start] for where in control_rig.point_slices]
    foot, above = control_values[2], pose.rotation[0]
    local = control_rig.bones[2].origin + 0.01 * foot[:, 3:] @ control_rig.bones[2].left.T
    assert joints[2] == pytest.approx(joints[0] + (above @ local[..., None])[..., 0], abs=1e-12)
    toe = rotation_matrices(control_values[3], "XYZ") @ control_rig.bones[3].right
    assert pose.rotation[3] == pytest.approx(pose.rotation[1] @ toe, abs=1e-12)
    assert pose.rotation[4] == pytest.approx(pose.rotation[1], abs=1e-12)
    assert control_rig.subtrees == ((0, 2, 3), (1, 3, 4), (2, 3), (3,), (4,))


@pytest.mark.parametrize(
    "names", [("rig", "values"), ("control_rig", "control_values")], ids=["body", "controls"]
)
def test_changing_one_bone_shows_what_showing_all_does(
    request: pytest.FixtureRequest, names: tuple[str, str]
) -> None:
    rig, values = (request.getfixturevalue(name) for name in names)
    frames, shown = slice(5, 25), rig.pose(values)
    for bone in range(len(rig.bones)):
        changed = {bone: values[bone] + 0.07, 0: values[0] + 0.01}
        part = rig.pose_changed(shown, frames, {index: own[frames] for index, own in changed.items()})
        whole = rig.pose([changed.get(index, own) for index, own in enumerate(values)])
        assert part.points == pytest.approx(whole.points[frames], abs=1e-12)


def test_keys_of_controls_stay_within_the_tolerance(
    control_rig: Rig, control_values: list[np.ndarray]
) -> None:
    reduced = run(reduce_keys(control_rig, TIMES, control_values, 0.005, np.zeros(0, dtype=np.intp)))
    distance = np.linalg.norm(shown(control_rig, reduced) - control_rig.pose(control_values).points, axis=-1)
    assert 0.001 < distance.max() <= 0.005
    assert key_count(reduced) < 0.5 * FRAMES * len(control_rig.bones)
