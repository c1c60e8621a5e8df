"""Keyframe libraries made in a file: from the actor's pose to a shared file, and onto another actor."""

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.mirror import mirrored
from keymark.core.body.posture import Posture
from keymark.core.body.soles import sole_heights_m
from keymark.core.library.library_file import read_library
from keymark.core.take.motion import Motion
from keymark.operators.bridge.actor_lengths import read_body
from keymark.operators.bridge.armature import build_armature
from keymark.operators.bridge.object_space import evaluated
from keymark.operators.bridge.pose import read_posture, write_posture
from keymark.operators.library.editing.library_from_scene import library_from_scene
from keymark.operators.library.editing.library_to_scene import add_library
from keymark.operators.shell.takes import active_take, add_take

RandomPosture = Callable[[int], Posture]


@pytest.fixture
def take(registered: None, body: Body) -> bpy.types.PropertyGroup:
    """A take with an actor, and a library to fill."""
    result = add_take(bpy.context.scene, "Take")
    result.armature = build_armature(bpy.context.scene, body)
    bpy.ops.keymark.new_library(title="Gestures", author="A. Person")
    return result


def group() -> bpy.types.PropertyGroup:
    """The library that is made."""
    return bpy.context.scene.keymark.libraries[0]


def pose(seed: int, random_posture: RandomPosture) -> Posture:
    """Pose the actor at random."""
    posture = random_posture(seed)
    write_posture(active_take(bpy.context.scene).armature, posture)
    return posture


def matrices(armature_object: bpy.types.Object) -> np.ndarray:
    """Every bone's matrix in the world."""
    shown = evaluated(armature_object)
    return np.array([shown.matrix_world @ bone.matrix for bone in shown.pose.bones])


def test_a_pose_goes_through_a_file_to_another_blend_exactly(
    take: bpy.types.PropertyGroup, random_posture: RandomPosture, tmp_path: Path
) -> None:
    """Armature, asset, .json and .blend, another file, armature: each bone's matrix to 1e-6."""
    for seed in range(3):
        pose(seed, random_posture)
        bpy.ops.keymark.add_posture(posture=f"P{seed}")
    wanted = []
    for seed in range(3):
        pose(seed, random_posture)
        wanted.append(matrices(take.armature))
    lengths = read_body(take.armature, HUMAN)
    for kind, name in (("JSON", "x.json"), ("BLEND", "y.blend")):
        bpy.ops.keymark.export_library(filepath=str(tmp_path / name), format=kind)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    for name in ("x.json", "y.blend"):
        assert bpy.ops.keymark.import_library(filepath=str(tmp_path / name)) == {"FINISHED"}
    assert not len(bpy.data.actions)
    other = add_take(bpy.context.scene, "Other")
    other.armature = build_armature(bpy.context.scene, lengths)
    for seed in range(3):
        # Where the actor stood, as it must be told from where.
        write_posture(other.armature, random_posture(seed))
        stand = read_posture(other.armature, lengths).posture
        write_posture(other.armature, Posture.rest(HUMAN).plus(_placed(stand)))
        bpy.ops.keymark.apply_posture(library="gestures", posture=f"P{seed}", place="WORLD")
        apart = np.linalg.inv(wanted[seed][0]) @ wanted[seed]
        shown = matrices(other.armature)
        assert np.abs(np.linalg.inv(shown[0]) @ shown - apart).max() < 2e-6


def _placed(stand: Posture) -> np.ndarray:
    step = np.zeros(HUMAN.dof_count)
    step[:3] = stand.translation
    return step


def test_the_place_of_the_actor_is_kept(
    take: bpy.types.PropertyGroup, random_posture: RandomPosture, body: Body
) -> None:
    """Applied at the actor's location, a posture restores its pose: location, heading and floor."""
    pose(4, random_posture)
    before = matrices(take.armature)
    bpy.ops.keymark.add_posture(posture="Here")
    bpy.ops.keymark.apply_posture(posture="Here", mirrored=True)
    assert np.abs(matrices(take.armature) - before).max() > 0.1
    write_posture(take.armature, pose(4, random_posture))
    bpy.ops.keymark.apply_posture(posture="Here")
    assert np.abs(matrices(take.armature) - before).max() < 3e-6
    kept = library_from_scene(group()).postures[0].posture
    assert kept.translation[:2] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert sole_heights_m(body, body.pose(kept)).min() == pytest.approx(0.0, abs=1e-5)


def test_a_posture_fits_a_rig_of_other_rolls_modes_and_size(
    take: bpy.types.PropertyGroup, random_posture: RandomPosture
) -> None:
    """Bones rolled, in other rotation modes, on another performer and object: the same angles."""
    pose(5, random_posture)
    bpy.ops.keymark.add_posture(posture="P")
    wanted = library_from_scene(group()).postures[0].posture
    tall = Body(Actor.from_stature(1.95))
    other = take.armature = build_armature(bpy.context.scene, tall, "Tall")
    bpy.context.view_layer.objects.active = other
    bpy.ops.object.mode_set(mode="EDIT")
    for place, bone in enumerate(other.data.edit_bones):
        bone.roll += 0.4 * (place + 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    for place, bone in enumerate(other.pose.bones):
        bone.rotation_mode = ("QUATERNION", "AXIS_ANGLE", "XYZ", "ZYX")[place % 4]
    other.location = (1.0, 2.0, 0.5)
    other.rotation_euler = (0.0, 0.0, 0.7)
    bpy.context.view_layer.update()
    for mirror in (False, True):
        bpy.ops.keymark.apply_posture(posture="P", place="WORLD", mirrored=mirror)
        shown = read_posture(other, tall).posture
        expected = mirrored(wanted) if mirror else wanted
        assert np.abs(shown.minus(expected)[3:]).max() < 1e-5
        assert sole_heights_m(tall, tall.pose(shown)).min() == pytest.approx(0.0, abs=1e-5)


def test_a_library_goes_through_the_scene_to_the_last_byte(
    take: bpy.types.PropertyGroup, random_posture: RandomPosture, tmp_path: Path
) -> None:
    """File, scene with pose assets, saved and opened, file: the same bytes."""
    for seed in range(3):
        pose(seed, random_posture)
        bpy.ops.keymark.add_posture(posture=f"P{seed}", tags="one, two")
    bpy.ops.keymark.add_motion(motion="Cycle", duration_s=1.0 / 3.0, cyclic=True)
    group().motions[0].travel_y = -1.1
    group().sources.add().text = "Somebody (1999), a book"
    first, second = tmp_path / "a.json", tmp_path / "b.json"
    bpy.ops.keymark.export_library(filepath=str(first))
    bpy.ops.keymark.remove_library()
    assert not len(bpy.data.actions)
    add_library(bpy.context.scene, read_library(first))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "work.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "work.blend"))
    bpy.ops.keymark.export_library(filepath=str(second))
    assert second.read_bytes() == first.read_bytes()
    library = read_library(first)
    assert library.motions[0].travel == pytest.approx((0.0, -1.1, 0.0))
    assert [step.posture for step in library.motions[0].steps] == ["P0", "P1", "P2"]
    assert library.sources == ("Somebody (1999), a book",)
    assert library.postures[0].tags == ("one", "two")


def test_names_stay_unique_and_motions_follow(
    take: bpy.types.PropertyGroup, random_posture: RandomPosture
) -> None:
    """Renamed in the panel or in the asset browser; removed; moved."""
    for _ in range(3):
        pose(1, random_posture)
        bpy.ops.keymark.add_posture(posture="Same")
    bpy.ops.keymark.add_motion(motion="All")
    assert [entry.name for entry in group().postures] == ["Same", "Same 2", "Same 3"]
    group().postures[1].name = "same"
    assert group().postures[1].name == "same 2"
    assert group().motions[0].steps[1].posture == "same 2"
    assert group().postures[1].action.name == "same 2"
    group().postures[2].action.name = "In the Browser"
    library = library_from_scene(group())
    assert [step.posture for step in library.motions[0].steps] == ["Same", "same 2", "In the Browser"]
    group().active_posture = 0
    bpy.ops.keymark.move_posture(direction="DOWN")
    assert [entry.name for entry in group().postures] == ["same 2", "Same", "In the Browser"]
    bpy.ops.keymark.remove_posture()
    assert [step.posture for step in library_from_scene(group()).motions[0].steps] == [
        "same 2",
        "In the Browser",
    ]
    assert len(bpy.data.actions) == 2


def test_keyframes_become_a_motion(take: bpy.types.PropertyGroup, wave_motion: Motion, body: Body) -> None:
    """Postures at their times, the first straight ahead above the origin, the soles on the floor."""
    bpy.context.scene.render.fps = 25
    for index in wave_motion.keyframe_indices:
        bpy.context.scene.frame_set(index + 1)
        write_posture(take.armature, wave_motion.posture[index])
        bpy.ops.keymark.store_keyframe()
    bpy.ops.keymark.add_motion(source="KEYFRAMES", motion="Wave")
    library = library_from_scene(group())
    assert [posture.name for posture in library.postures] == ["Wave 1", "Wave 2", "Wave 3"]
    assert [step.time_s for step in library.motions[0].steps] == pytest.approx([0.0, 0.24, 0.48])
    postures = Posture.stack([posture.posture for posture in library.postures])
    assert sole_heights_m(body, body.pose(postures)).min() == pytest.approx(0.0, abs=1e-5)
    risen = postures.translation[:, 2] - wave_motion.posture.translation[[0, 6, 12], 2]
    assert risen == pytest.approx(risen[:1].repeat(3), abs=1e-5)


def test_mirrored_postures_are_added(take: bpy.types.PropertyGroup, random_posture: RandomPosture) -> None:
    """At the end of the list, under names of their own."""
    pose(2, random_posture)
    bpy.ops.keymark.add_posture(posture="Kick")
    bpy.ops.keymark.mirror_library(what="POSTURE")
    kick, other = library_from_scene(group()).postures
    assert other.name == "Kick (mirrored)"
    assert np.abs(other.posture.minus(mirrored(kick.posture))).max() < 1e-6


def test_what_is_missing_is_said(registered: None, tmp_path: Path) -> None:
    """Without a library, without postures, without an actor."""
    with pytest.raises(RuntimeError, match="No keyframe library is made in this file"):
        bpy.ops.keymark.export_library(filepath=str(tmp_path / "a.json"))
    bpy.ops.keymark.new_library(title="Empty")
    with pytest.raises(RuntimeError, match="has no postures yet"):
        bpy.ops.keymark.export_library(filepath=str(tmp_path / "a.json"))
    with pytest.raises(RuntimeError, match="Build the actor first"):
        bpy.ops.keymark.add_posture()
    with pytest.raises(RuntimeError, match="it must be a text"):
        bpy.ops.keymark.new_library(title="")
    assert list(tmp_path.iterdir()) == []


def test_every_change_of_a_library_is_undone(
    take: bpy.types.PropertyGroup, random_posture: RandomPosture
) -> None:
    """Postures with their assets, motions and details come and go with undo."""

    def state() -> tuple[object, ...]:
        libraries = bpy.context.scene.keymark.libraries
        return tuple(
            (g.name, g.author, [(p.name, p.action.name) for p in g.postures], [m.name for m in g.motions])
            for g in libraries
        ), sorted(action.name for action in bpy.data.actions)

    ops = bpy.ops.keymark
    pose(3, random_posture)
    bpy.ops.ed.undo_push(message="Begin")
    for do in (
        lambda: ops.add_posture(posture="A"),
        lambda: ops.add_posture(posture="B"),
        lambda: ops.add_motion(motion="M"),
        lambda: ops.mirror_library(what="POSTURES"),
        lambda: ops.move_posture(direction="UP"),
        ops.remove_posture,
        ops.remove_motion,
        ops.remove_library,
    ):
        before = state()
        do()
        bpy.ops.ed.undo_push(message="Step")
        after = state()
        assert after != before
        bpy.ops.ed.undo()
        assert state() == before
        bpy.ops.ed.redo()
        assert state() == after
