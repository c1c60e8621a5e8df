"""Nonsense in every setting of every operator: it is refused by a sentence or done, without a traceback."""

import re
from itertools import chain
from pathlib import Path

import bpy
import pytest
from keymark.core.take.take import Take
from keymark.operators.shell.takes import active_take

TEXTS = ("", "nowhere/none.xyz", "\u00e4:,;\n")
SOURCES = Path(__file__).parents[2].joinpath("operators").rglob("*.py")
FOUND = (re.findall(r"class KEYMARK_OT_(\w+)", file.read_text("utf-8")) for file in SOURCES)
NAMES = sorted({*chain(*FOUND)} - {"add_rigify_human"})  # which has a process of its own, see `_own_process`
NUMBERS = (-1e9, 1e9)


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
    return found


@pytest.mark.parametrize("name", NAMES)
def test_what_cannot_be_is_a_sentence(
    registered: None, opened: bpy.types.Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    operator = getattr(bpy.ops.keymark, name)
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
