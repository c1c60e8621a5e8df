"""A mended motion on its armature: lengths and toes as before, limbs at the mended joints, feet still."""

from functools import cache

import numpy as np
from _characters import plain_character, plain_map
from _performances import RATE, jitter_mm, solved, steps
from _recorded import assert_recorded
from keymark.core.arrays import Array
from keymark.core.body.human import HUMAN
from keymark.core.mend.mend_motion import Mended, MendOptions, mend_motion
from keymark.core.progress import run
from keymark.core.retarget.mended_armature import ArmaturePoints, mended_poses
from keymark.core.retarget.solve.rest_body import RestBody

FRAMES = 60
POSED = (30,)


@cache
def shaken() -> tuple[ArmaturePoints, dict[str, Array]]:
    """An armature that performs the steps, every bone shaken by degrees and the hips by centimeters."""
    character = plain_character()
    character_map = plain_map(character)
    poses = solved(character, character_map, steps()).poses
    rng = np.random.default_rng(0)
    body = RestBody.of(character, character_map)
    found: dict[str, Array] = {}
    for bone in body.bones:
        pose = np.array(poses[bone.name][:FRAMES])
        if bone.carrier >= 0:
            carrier = body.bones[bone.carrier].name
            pose = found[carrier] @ np.linalg.inv(poses[carrier][:FRAMES]) @ pose
        else:
            pose[:, :3, 3] += rng.normal(0.0, 0.02, (FRAMES, 3))
        small = rng.normal(0.0, 0.03, (FRAMES, 3))
        turn = np.tile(np.eye(3), (FRAMES, 1, 1))
        turn[:, [2, 0, 1], [1, 2, 0]] = small
        turn[:, [1, 2, 0], [2, 0, 1]] = -small
        left, _, right = np.linalg.svd(turn @ pose[:, :3, :3])
        pose[:, :3, :3] = left @ right
        found[bone.name] = pose
    return ArmaturePoints.of(body), found


@cache
def result() -> tuple[Mended, dict[str, Array]]:
    points, poses = shaken()
    mended = run(mend_motion(points.of_poses(poses), RATE, MendOptions(POSED, ankle_m=0.08)))
    return mended, mended_poses(points, poses, mended, np.array(POSED))


def test_the_armature_is_at_the_mended_joints_with_its_own_lengths() -> None:
    points, poses = shaken()
    mended, made = result()
    placed = points.of_poses(poses | made)
    assert_recorded("mended armature", *(made[name] for name in sorted(made)), share=1e-4)
    apart = np.linalg.norm(placed - mended.motion.points, axis=-1)
    assert apart.mean() < 0.01 and apart[:, -2:].max() < 0.025
    for side in "LR":
        knee, ankle = (HUMAN.point_names.index(f"{name}.{side}") for name in ("knee", "ankle"))
        assert np.ptp(np.linalg.norm(placed[:, knee] - placed[:, ankle], axis=-1)) < 1e-9
    assert jitter_mm(placed) < 0.3 * jitter_mm(points.of_poses(poses))


def test_turns_about_the_limbs_are_smooth_too() -> None:
    _, poses = shaken()
    _, made = result()
    for name in ("upper_arm.L", "forearm.R", "thigh.L", "head"):
        before, after = (np.diff(each[name][:, :3, 0], n=2, axis=0) for each in (poses, made))
        assert np.linalg.norm(after, axis=1).mean() < 0.4 * np.linalg.norm(before, axis=1).mean()


def test_toes_are_left_alone_and_a_posed_frame_stays() -> None:
    _, poses = shaken()
    _, made = result()
    assert not any(name.startswith("toe") for name in made)
    turn = made["upper_arm.L"][30, :3, :3].T @ poses["upper_arm.L"][30, :3, :3]
    assert np.degrees(np.arccos(np.clip((np.trace(turn) - 1.0) / 2.0, -1.0, 1.0))) < 4.0


def test_a_resting_foot_does_not_turn() -> None:
    mended, made = result()
    assert mended.contacts
    for contact in mended.contacts:
        turns = made[f"foot.{'LR'[contact.point]}"][contact.first : contact.last + 1, :3, :3]
        assert np.abs(turns - turns[0]).max() < 0.02
