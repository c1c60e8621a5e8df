"""Controls of rigs that no preset knows are found from what constraints and drivers do."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from _armatures import build_character
from _characters import plain_character, plain_map
from _control_rigs import control_rig, simple_ik_rig
from _performances import performance, stepping
from keymark.core.progress import run
from keymark.core.retarget.character import Character
from keymark.core.retarget.maps.character_map import IkControls, RoleBones, Setting, Switch
from keymark.core.retarget.options import LimbKeys, RetargetOptions
from keymark.operators.bridge.character.complete_map import complete_map
from keymark.operators.bridge.character.controls.find_controls import find_controls
from keymark.operators.bridge.character.read_character import read_character
from keymark.operators.bridge.character.retarget import retarget

SIZE = 1.6


def test_controls_of_an_unknown_rig_are_found() -> None:
    """FK chains, goals, poles, switches whichever end is IK, and what carries the hips."""
    character, known = control_rig()
    found = find_controls(character, known, SIZE)
    assert found.notes == ()
    assert found.character_map.fk["hips"] == ("body",)
    for side in "LR":
        for part in ("upper_arm", "forearm", "hand", "thigh", "shin", "foot"):
            assert found.character_map.fk[f"{part}.{side}"] == (f"fk_{part}.{side}",)
        for limb, end in (("arm", "hand"), ("leg", "foot")):
            assert found.character_map.ik[f"{limb}.{side}"] == IkControls(
                f"ik_{end}.{side}",
                f"pole_{limb}.{side}",
                None,
                Switch(f"ik_{end}.{side}", "to_ik", ik=1.0, fk=0.0),
            )
    assert "chest" not in found.character_map.fk


@pytest.mark.parametrize("pole_behind", [False, True])
@pytest.mark.parametrize("keys", [LimbKeys.BOTH, LimbKeys.FK])
def test_an_unknown_rig_performs(pole_behind: bool, keys: LimbKeys) -> None:
    """Elbows and knees are where they belong, on whatever side the poles lie."""
    character, known = control_rig(pole_behind)
    body, posture = stepping()
    source = performance(body, posture[:40])
    options = RetargetOptions(arms=keys, legs=keys)
    made = run(retarget(character, source, 1.0 + np.arange(40), known, options))
    made.write(bpy.context.scene, "Steps")
    assert made.notes == ()
    off = []
    for number, frame in enumerate(made.keys.frames):
        bpy.context.scene.frame_set(int(frame))
        shown = character.evaluated_get(bpy.context.evaluated_depsgraph_get()).pose.bones
        off += [
            np.linalg.norm(np.array(shown[bone].head) - poses[number, :3, 3])
            for bone, poses in made.motion.poses.items()
        ]
    assert max(off) < 0.007
    if keys is LimbKeys.BOTH:
        assert made.quality.ik_fk_mm is not None and made.quality.ik_fk_mm < 1.0


@pytest.mark.parametrize("keys", [LimbKeys.BOTH, LimbKeys.FK])
def test_legs_that_are_always_in_ik_are_keyed_there(keys: LimbKeys) -> None:
    """Whatever is chosen; the toes turn on feet that only legs within reach place."""
    character, known = simple_ik_rig()
    body, posture = stepping()
    source = performance(body, posture[:40])
    made = run(retarget(character, source, 1.0 + np.arange(40), known, RetargetOptions(legs=keys)))
    assert made.character_map.ik["leg.L"] == IkControls("goal.L", "pole.L")
    names = {one.control.name: one for one in made.keys.controls}
    assert {"goal.L", "pole.R", "toe.L"} <= set(names)
    assert not {"thigh.L", "shin.L", "foot.L"} & set(names)
    assert names["toe.L"].location is None
    assert made.quality.legs_deg is not None and made.quality.legs_deg < 3.0
    assert made.quality.penetration_mm is not None and made.quality.penetration_mm < 2.0


def test_a_plain_skeleton_has_no_other_controls() -> None:
    """Bones that nothing else moves are keyed themselves, limits and single drivers or not."""
    character, known = build_character(plain_character()), plain_map(plain_character())
    assert find_controls(character, known, SIZE).character_map is known
    character.pose.bones["neck"].constraints.new("LIMIT_ROTATION")
    assert find_controls(character, known, SIZE).character_map is known


def test_what_has_no_control_is_named_and_keyed_itself() -> None:
    """A bone that follows one which nobody can pose stays its own control."""
    character, known = build_character(plain_character()), plain_map(plain_character())
    constraint = character.pose.bones["head"].constraints.new("COPY_ROTATION")
    constraint.target, constraint.subtarget, constraint.influence = character, "finger.L", 0.5
    bpy.context.view_layer.update()
    found = find_controls(character, known, SIZE)
    assert found.character_map.fk["head"] == ("head",)
    assert found.notes and "'head'" in found.notes[0]


def test_what_the_map_says_stays() -> None:
    """Only roles without controls of their own are completed."""
    character, known = control_rig()
    given = replace(known, fk={"thigh.L": ("mch_thigh.L",), "hips": ("hips",)})
    found = find_controls(character, given, SIZE).character_map
    assert found.fk["thigh.L"] == ("mch_thigh.L",)
    assert found.fk["hips"] == ("hips",)
    assert found.fk["thigh.R"] == ("fk_thigh.R",)


def test_properties_that_are_not_there_are_left_out_and_named() -> None:
    """A rig of another version than its map is still keyed."""
    character, known = control_rig()
    ik = {"arm.L": IkControls("ik_hand.L", "pole_arm.L", None, Switch("ik_hand.L", "ik_fk", 0.0, 1.0))}
    given = replace(known, ik=ik, settings=(Setting("body", "follow", 1.0),))
    completed = complete_map(character, read_character(character), given)
    assert completed.character_map.settings == ()
    assert completed.character_map.ik["arm.L"].switch is None
    assert ["'follow'" in note or "'ik_fk'" in note for note in completed.notes] == [True, True]


def test_a_goal_that_a_constraint_carries_is_a_control() -> None:
    """Child Of is a parent by another name: the animator still poses the foot."""
    character, known = control_rig()
    for side in "LR":
        constraint = character.pose.bones[f"ik_foot.{side}"].constraints.new("CHILD_OF")
        constraint.target, constraint.subtarget = character, "body"
        constraint.inverse_matrix = character.data.bones["body"].matrix_local.inverted()
    found = find_controls(character, known, SIZE).character_map
    assert found.ik["leg.L"].goal == "ik_foot.L" and found.ik["leg.R"].goal == "ik_foot.R"


@pytest.mark.parametrize("in_ik", [0.0, 1.0])
def test_switches_behind_helper_bones_are_found(in_ik: float) -> None:
    """The bones of the mesh copy bones that choose between FK and IK, whichever the rig shows."""
    character, known = control_rig()
    bpy.ops.object.mode_set(mode="EDIT")
    names = [f"{part}.{side}" for part in ("thigh", "shin", "foot") for side in "LR"]
    for name in names:
        inner = character.data.edit_bones[name]
        outer = character.data.edit_bones.new(f"DEF-{name}")
        outer.head, outer.tail, outer.roll = inner.head, inner.tail, inner.roll
    bpy.ops.object.mode_set(mode="OBJECT")
    for name in names:
        constraint = character.pose.bones[f"DEF-{name}"].constraints.new("COPY_TRANSFORMS")
        constraint.target, constraint.subtarget = character, name
    for side in "LR":
        character.pose.bones[f"ik_foot.{side}"]["to_ik"] = in_ik
    outer_roles = {name: RoleBones((f"DEF-{name}",)) for name in names}
    found = find_controls(character, replace(known, roles={**known.roles, **outer_roles}), SIZE)
    for side in "LR":
        assert found.character_map.fk[f"shin.{side}"] == (f"fk_shin.{side}",)
        assert found.character_map.ik[f"leg.{side}"].switch == Switch(f"ik_foot.{side}", "to_ik", 1.0, 0.0)


def test_a_spine_that_shares_the_chests_turn_is_left_to_it() -> None:
    """One control bends all of the spine; what hangs on it is where it belongs all the same."""
    plain = plain_character()
    chest = plain.bone("chest")
    control = replace(chest, name="c_chest", parent=plain.index["hips"], deforms=False)
    character = build_character(Character("Shared", (*plain.bones, control)))
    known = plain_map(plain)
    for name, share in (("spine", 0.5), ("chest", 1.0)):
        constraint = character.pose.bones[name].constraints.new("COPY_ROTATION")
        constraint.target, constraint.subtarget, constraint.influence = character, "c_chest", share
    body, posture = stepping()
    source = performance(body, posture[:20])
    made = run(retarget(character, source, 1.0 + np.arange(20), known, RetargetOptions()))
    assert made.character_map.fk["spine"] == (None, "c_chest")
    (note,) = made.notes
    assert "Constraints follow the carriers of bone" in note
    made.write(bpy.context.scene, "Steps")
    for number in (0, 10, 19):
        bpy.context.scene.frame_set(1 + number)
        shown = character.evaluated_get(bpy.context.evaluated_depsgraph_get()).pose.bones
        for bone in ("neck", "head", "hand.L", "hand.R", "foot.L"):
            apart = np.array(shown[bone].head) - made.motion.poses[bone][number, :3, 3]
            assert np.linalg.norm(apart) < 0.02
