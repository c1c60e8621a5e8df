"""Labels in title case, descriptions without a full stop, reports with a capital letter."""

from collections.abc import Iterator

import bpy
import pytest
from keymark.operators.shell.base_operator import FIELDS, capitalized

OWN = "KEYMARK_"
OUTSIDE = ("filepath", "directory", "filter_glob", "filter_folder")
"""Names that Blender gives its own meaning; the rest of an operator's properties are Keymark's."""
SMALL = {"a", "an", "and", "as", "at", "by", "for", "from", "in", "of", "on", "or", "the", "to", "with"}
"""Words in lower case inside a label, as in Blender's own."""
NAMES = {"glTF"}
"""Names written as their owners write them."""


def is_title(text: str) -> bool:
    """Whether every word but the small ones inside begins with a capital."""
    words = [word for word in text.replace("/", " ").split() if word not in NAMES]
    return all(
        not word[0].isalpha() or word[0].isupper() or (0 < index and word in SMALL)
        for index, word in enumerate(words)
    )


def definitions() -> Iterator[tuple[str, str, str]]:
    """Yield path, label and description of Keymark's operators and properties."""
    for name in dir(bpy.ops.keymark):
        kind = getattr(bpy.ops.keymark, name).get_rna_type()
        yield f"keymark.{name}", kind.name, kind.description
        yield from properties(f"keymark.{name}", kind)
    yield from properties("keymark", bpy.types.Scene.bl_rna.properties["keymark"].fixed_type)


def properties(where: str, kind: bpy.types.Struct) -> Iterator[tuple[str, str, str]]:
    """Yield the same of a class's shown properties, of the entries of its menus, and of nested groups."""
    for definition in kind.properties:
        path = f"{where}.{definition.identifier}"
        if definition.identifier in ("rna_type", *OUTSIDE) or definition.is_hidden:
            continue
        if definition.type in ("COLLECTION", "POINTER") and definition.fixed_type.identifier.startswith(OWN):
            yield from properties(path, definition.fixed_type)
            continue
        yield path, definition.name, definition.description
        for item in definition.enum_items if definition.type == "ENUM" else ():
            yield f"{path}.{item.identifier}", item.name, item.description or "said by its name"


@pytest.mark.usefixtures("registered")
def test_labels_are_in_title_case() -> None:
    found = list(definitions())
    assert len(found) > 60
    wrong = [(where, name) for where, name, _ in found if not name or not is_title(name)]
    drawn = [getattr(bpy.types, name) for name in dir(bpy.types) if name.startswith(OWN)]
    labels = [(each.__name__, each.bl_label) for each in drawn if hasattr(each, "bl_label")]
    assert len(labels) > 8
    wrong += [(where, name) for where, name in labels if not is_title(name)]
    assert wrong == []


@pytest.mark.usefixtures("registered")
def test_descriptions_are_there_and_end_without_a_full_stop() -> None:
    tooltips = [(where, text) for where, _, text in definitions()]
    assert [(where, text) for where, text in tooltips if not text or text.endswith(".")] == []


@pytest.mark.parametrize(
    ("text", "right"),
    [
        ("Load Footage", True),
        ("Jump to Proposed Keyframe", True),
        ("Load footage", False),
        ("to Load", False),
        ("3D View", True),
    ],
)
def test_title_case_is_told(text: str, right: bool) -> None:
    assert is_title(text) is right


def test_sentences_begin_with_a_capital_and_names_as_they_are() -> None:
    assert capitalized("the clip is interlaced") == "The clip is interlaced"
    assert capitalized("no bone is chosen; click on one") == "No bone is chosen; click on one"
    assert capitalized("take.json: fps is 0") == "take.json: fps is 0"
    part = "the motion is that of frames 1 to 4: --frames names another shot"
    assert capitalized(part).endswith("4: Part of the Clip (in Picture and Part) names another shot")


@pytest.mark.usefixtures("registered")
def test_fields_that_sentences_name_for_options_are_there() -> None:
    operators = [bpy.ops.keymark.animate, bpy.ops.keymark.load_motion, bpy.ops.keymark.pose_all]
    types = [each.get_rna_type() for each in operators]
    labels = {each.name for each in types} | {prop.name for each in types for prop in each.properties}
    assert {field.split(" (")[0].removeprefix("the field ") for field in FIELDS.values()} <= labels
