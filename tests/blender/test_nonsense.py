"""Nonsense in every setting of every operator: it is refused by a sentence or done, without a traceback."""

import re
from itertools import chain
from pathlib import Path

import bpy
import pytest
from _armatures import build_character
from _characters import plain_character
from _found import show_found
from _performances import made_up_review
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.operators.bridge.fcurves import write_motion
from keymark.operators.reconstruct.live_preview import show_review
from keymark.operators.shell.takes import active_take

TEXTS = ("", "nowhere/none.xyz", "\u00e4:,;\n")
SOURCES = Path(__file__).parents[2].joinpath("operators").rglob("*.py")
OPERATOR = re.compile(r"(?:class KEYMARK_OT_|^@operator\(.*?\)\ndef )(\w+)", re.MULTILINE | re.DOTALL)
FOUND = (OPERATOR.findall(file.read_text("utf-8")) for file in SOURCES)
NAMES = sorted({*chain(*FOUND)} - {"add_rigify_human"})  # which has a process of its own, see `_own_process`
NUMBERS = (-1e9, 1e9)


@pytest.fixture
def ready(opened: bpy.types.Scene, wave_motion: Motion) -> bpy.types.Scene:
    """The tiny take with all that operators need: proposals, a found keyframe, a result, a posed bone."""
    take = active_take(opened)
    take.motion_action = write_motion(take.armature, wave_motion)
    show_review(take, made_up_review())
    bpy.ops.keymark.propose_keyframes()
    bpy.ops.keymark.ignore_region(path=[{"name": "", "loc": (4.0, 4.0), "time": 0.0}] * 2, radius=3.0)
    show_found(opened, wave_motion)
    bpy.ops.keymark.add_character(armature=build_character(plain_character()).name)
    bpy.ops.keymark.retarget()
    bpy.context.window_manager.keymark_shelf.libraries.add()
    bpy.context.view_layer.objects.active = take.armature
    bpy.ops.object.mode_set(mode="POSE")
    take.armature.data.bones.active = take.armature.data.bones["forearm.L"]
    forearm = take.armature.pose.bones["forearm.L"]
    (forearm if hasattr(forearm, "select") else forearm.bone).select = True  # of the pose since Blender 5.0
    return opened


def nonsense(operator: bpy.types.Operator) -> list[dict[str, object]]:
    """Settings with one wrong value each, the others as they are."""
    found: list[dict[str, object]] = [{}]
    for each in operator.get_rna_type().properties:
        if each.identifier == "rna_type":
            continue
        if each.type == "STRING":
            found += [{each.identifier: text} for text in TEXTS]
        elif each.type in ("INT", "FLOAT") and not each.is_array:
            found += [{each.identifier: (int if each.type == "INT" else float)(value)} for value in NUMBERS]
        elif each.type == "ENUM":
            found += [{each.identifier: item.identifier} for item in each.enum_items_static]
    return found


@pytest.mark.parametrize("name", NAMES)
def test_what_cannot_be_is_a_sentence(
    ready: bpy.types.Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    operator = getattr(bpy.ops.keymark, name)
    if not operator.poll():
        bpy.ops.object.mode_set(mode="OBJECT")
    assert operator.poll() or len(nonsense(operator)) == 1, "it is never tried"
    for settings in nonsense(operator):
        try:
            assert operator(**settings) <= {"FINISHED", "CANCELLED", "RUNNING_MODAL"}
        except RuntimeError as error:
            assert "Traceback" not in str(error) and str(error).strip(), settings


def test_a_height_in_centimeters_is_one(opened: bpy.types.Scene, tiny_take: Take) -> None:
    take = active_take(opened)
    for typed, height in ((178.0, 1.78), (1.65, 1.65), (17.0, 3.0)):
        take.stature = typed
        assert take.stature == pytest.approx(height)
    bpy.ops.keymark.build_actor(stature=178.0)
    assert take.stature == pytest.approx(1.78)
    with pytest.raises(RuntimeError, match="Height is 17; meters from"):
        bpy.ops.keymark.build_actor(stature=17.0)
