"""Labels in title case, descriptions without a full stop, reports and labels from literal templates."""

import ast
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest
from keymark.operators.shell.messages import count_label, label, say

OWN = "KEYMARK_"
OUTSIDE = ("filepath", "directory", "filter_glob", "filter_folder")
"""Names that Blender gives its own meaning; the rest of an operator's properties are Keymark's."""
PUT_TOGETHER = (ast.JoinedStr, ast.BinOp)
"""Expressions that put strings together; the name of a template is fine."""
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
    """Panels, menus, operators, properties and the entries of menus."""
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
    """Blender adds the stop itself."""
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
    """The check above can fail."""
    assert is_title(text) is right


def test_sentences_that_are_said_are_not_put_together(repository: Path) -> None:
    """Translators' tools read templates from the source, so none may be put together there."""
    wrong, found = [], 0
    for file in sorted((repository / "operators").rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.args:
                places = {"say": (2,), "label": (0,), "count_label": (1, 2)}.get(node.func.id, ())
                places = tuple(place for place in places if place < len(node.args))
                found += len(places)
                templates = [part for place in places for part in ast.walk(node.args[place])]
                if any(isinstance(part, PUT_TOGETHER) for part in templates):
                    wrong.append(f"{file.name}:{node.lineno}")
    assert found > 5
    assert wrong == []


class Operator:
    """Keeps what is reported."""

    def report(self, kind: set[str], text: str) -> None:
        """Keep it."""
        self.said = (kind, text)


def test_a_sentence_is_filled_in_after_translation(monkeypatch: pytest.MonkeyPatch) -> None:
    """The template is what is looked up, in the language that Blender speaks."""
    words = {"Opened {name}": "{name} geöffnet"}
    german = SimpleNamespace(pgettext_rpt=words.get, pgettext_iface=words.get)
    operator = Operator()
    say(operator, "INFO", "Opened {name}", name="walk")
    assert operator.said == ({"INFO"}, "Opened walk")
    monkeypatch.setattr(
        "keymark.operators.shell.messages.bpy", SimpleNamespace(app=SimpleNamespace(translations=german))
    )
    say(operator, "INFO", "Opened {name}", name="walk")
    assert operator.said == ({"INFO"}, "walk geöffnet")
    assert label("Opened {name}", name="walk") == "walk geöffnet"


def test_one_is_not_several() -> None:
    """A number goes with words for one or for more."""
    said = [count_label(count, "1 posture", "{count} postures") for count in (0, 1, 12)]
    assert said == ["0 postures", "1 posture", "12 postures"]
