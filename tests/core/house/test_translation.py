"""Every text of operators is one that translators find and Blender can show in another language."""

import ast
from pathlib import Path

import pytest
from _house import modules
from _sentences import name_of
from _untranslated import translated_names, untranslated

ENGLISH = {
    "operators.actor.properties": "names and descriptions, registered in a loop: Blender extracts them there",
    "operators.bridge.actions": "names of data blocks",
    "operators.bridge.armature": "names of data blocks and bone collections",
    "operators.bridge.assets.catalogs": "the head of a file",
    "operators.bridge.assets.motions": "names of data blocks and catalogs",
    "operators.bridge.body_mesh": "names of data blocks",
    "operators.bridge.character.import_character": "a part of an error of core's, which is English",
    "operators.bridge.character.measure": "a name of a data block",
    "operators.bridge.character.read_character": "a word in the place of a file's name",
    "operators.bridge.character.rigify_human": "names of data blocks",
    "operators.bridge.character.write_retargeted": "a name of a group of curves, as Blender gives it",
    "operators.bridge.footage_camera": "a name of a data block",
    "operators.bridge.footage_to_scene": "a name of a data block",
    "operators.bridge.library.pose_assets": "names of data, and the places of errors of core's",
    "operators.bridge.result_files": "names of data blocks",
    "operators.bridge.review_curves": "names and descriptions that are kept in a file",
    "operators.bridge.turntable": "names of data blocks",
    "operators.keyframes.store_keyframe": "what a notice is about, which nobody sees",
    "operators.library.editing.asset_updates": "a name of data",
    "operators.library.editing.library_from_scene": "an author in a file",
    "operators.library.learn_library": "an author in a file",
    "operators.markers.ignored_regions": "names of data",
    "operators.overlays.legend": "values of an enumeration, which nobody sees",
    "operators.overlays.registry": "names in the log",
    "operators.shell.lru_cache": "a type",
    "operators.shell.takes": "a name of data",
    "operators.takes.startup_cube": "the name that Blender's startup file gives it",
    "operators.takes.upgrade": "a name of data",
}
"""Modules with texts that stay as they are, and why; `operators.cli` is English throughout."""
REPORTING = {"operators.shell.messages", "operators.shell.error_reports"}


@pytest.fixture(scope="module")
def trees(repository: Path) -> dict[str, ast.Module]:
    """The modules of operators but for the command line, parsed."""
    return {
        name: ast.parse(file.read_text(encoding="utf-8"))
        for name, file in modules(repository, "operators").items()
        if not name.startswith("operators.cli")
    }


def reason(name: str) -> str | None:
    """The entry of `ENGLISH` for a module; None where its texts are to be translated."""
    return next((part for part in ENGLISH if name == part or name.startswith(f"{part}.")), None)


def test_every_text_is_translated_before_values_are_filled_in(trees: dict[str, ast.Module]) -> None:
    """Of all modules but those that have a reason, each of which still has such a text."""
    known = translated_names(trees.values())
    assert len(trees) > 250
    found = {name: list(untranslated(tree, known)) for name, tree in trees.items()}
    assert {name: texts for name, texts in found.items() if texts and reason(name) is None} == {}
    assert {reason(name) for name, texts in found.items() if texts} == set(ENGLISH)


def test_reports_go_through_one_place(trees: dict[str, ast.Module]) -> None:
    """`report` is called elsewhere with texts alone that are translated already, never with a literal."""
    calls = [
        (name, call)
        for name, tree in trees.items()
        for call in ast.walk(tree)
        if isinstance(call, ast.Call) and name_of(call) == "report" and name not in REPORTING
    ]
    assert calls
    wrong = [
        (name, call.lineno) for name, call in calls if isinstance(call.args[1], ast.Constant | ast.JoinedStr)
    ]
    assert wrong == []


PLANTED = {
    "a literal that is only handed on": 'def f():\n    return "Load the footage first"\n',
    "a formatted label": 'def f(row, n):\n    row.label(text=f"{n} keyframes posed")\n',
    "a formatted template": 'def f(n):\n    return label(f"{n} keyframes posed")\n',
    "a template that is added up": 'def f(n):\n    return label("Keyframes: " + n)\n',
    "a formatted error": 'def f(n):\n    raise InputError(f"take {n} has no clip")\n',
    "a literal kept as it is": 'def f(row):\n    row.label(text="Not Posed", translate=False)\n',
    "a table": 'STEPS = (("A", "Load the footage"),)\n',
    "a variable that is drawn": 'def f():\n    text = "Build Actor"\n    g(label(text))\n',
    "a title": 'def f(row):\n    draw(row, "Area")\n',
}
FINE = """
\"\"\"The words of documentation.\"\"\"
KEYS = "Drag: Move Joint   |   Enter: Done"
ITEMS = (("A", "Whole Clip", "All frames at once"),)
STEPS = (("A", pgettext_n("Load the footage")),)
class Panel:
    bl_label = "What to Follow"
    kind: bpy.props.EnumProperty(name="Kind of Line", items=ITEMS)
    def draw(self, row, take, n):
        row.label(text="No Footage Yet" if n else "Ready")
        row.label(text=f"{n:g} mm", translate=False)
        show(label(KEYS), count_label(n, "1 keyframe", "{count} keyframes"))
        if take.name == "Whole Clip":
            raise InputError("take '{name}' has no clip", name=take.name)
"""


@pytest.mark.parametrize("source", PLANTED.values(), ids=PLANTED)
def test_an_offender_is_found(source: str) -> None:
    """The check above can fail: each of these would be English in every language."""
    tree = ast.parse(source)
    assert len(list(untranslated(tree, translated_names([tree])))) == 1


def test_what_blender_or_keymark_translates_is_fine() -> None:
    """Registered names, literals of layouts, templates, items and templates that are kept in a constant."""
    tree = ast.parse(FINE)
    assert list(untranslated(tree, translated_names([tree]))) == []
