"""Controls of a rig that no preset knows, named by a map: how they act is seen from a few poses."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from _armatures import control_rig, retargeted
from keymark.core.body.kinematics import SegmentMotion
from keymark.core.retarget.maps.character_map import CharacterMap, IkControls, Setting, Switch
from keymark.core.take.conversion_settings import LimbKeys, RetargetOptions
from keymark.operators.bridge.character.read_character import read_character
from keymark.operators.bridge.character.retarget import complete_map


def with_controls(known: CharacterMap) -> CharacterMap:
    """The map with the controls of `control_rig`."""
    fk = {"hips": ("body",)}
    ik = {}
    for side in "LR":
        for part in ("upper_arm", "forearm", "hand", "thigh", "shin", "foot"):
            fk[f"{part}.{side}"] = (f"fk_{part}.{side}",)
        for limb, end in (("arm", "hand"), ("leg", "foot")):
            switch = Switch(f"ik_{end}.{side}", "to_ik", ik=1.0, fk=0.0)
            ik[f"{limb}.{side}"] = IkControls(f"ik_{end}.{side}", f"pole_{limb}.{side}", None, switch)
    return replace(known, fk=fk, ik=ik)


@pytest.mark.parametrize("pole_behind", [False, True])
@pytest.mark.parametrize("keys", [LimbKeys.BOTH, LimbKeys.FK])
def test_a_rig_whose_map_names_its_controls_performs(
    source: SegmentMotion, pole_behind: bool, keys: LimbKeys
) -> None:
    character, known = control_rig(pole_behind)
    made = retargeted(character, with_controls(known), source, RetargetOptions(arms=keys, legs=keys))
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


def test_properties_that_are_not_there_are_left_out_and_named() -> None:
    character, known = control_rig()
    ik = {"arm.L": IkControls("ik_hand.L", "pole_arm.L", None, Switch("ik_hand.L", "ik_fk", 0.0, 1.0))}
    given = replace(known, ik=ik, settings=(Setting("body", "follow", 1.0),))
    completed, notes = complete_map(character, read_character(character), given)
    assert completed.settings == ()
    assert completed.ik["arm.L"].switch is None
    assert ["'follow'" in note or "'ik_fk'" in note for note in notes] == [True, True]
