"""Topics of operators: each lists the modules it registers, and keeps its operators and panels to itself."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest
from _house import imports, modules, nodes

BASES = {"Operator", "Panel", "UIList", "Menu", "FileHandler"}
REGISTERED = {"register", "unregister", "HANDLERS", "MENUS"}
"""Names of what `operators` registers of a module beside its classes."""
SHARED = ("operators.bridge", "operators.shell")
"""Rooms without operators of their own, for all topics."""


def assigned(source: str) -> dict[str, ast.expr]:
    """The values a module assigns at its top, by name; each name of a tuple has the whole value."""
    found = {}
    for node in ast.parse(source).body:
        if isinstance(node, ast.Assign):
            names = [
                each.id for target in node.targets for each in ast.walk(target) if isinstance(each, ast.Name)
            ]
            found.update(dict.fromkeys(names, node.value))
        elif isinstance(node, ast.FunctionDef):
            found[node.name] = ast.Constant(None)
    return found


def listed(source: str) -> list[str]:
    """What a topic's own file lists as PROPERTIES and MODULES."""
    values = assigned(source)
    return [
        name for key in ("PROPERTIES", "MODULES") if key in values for name in ast.literal_eval(values[key])
    ]


def topic_of(name: str) -> str:
    """`operators.bridge.library` belongs to `operators.bridge`."""
    return ".".join(name.split(".")[:2])


def test_every_module_that_registers_is_listed_by_its_topic_once(repository: Path) -> None:
    known = modules(repository, "operators")
    sources = {name: file.read_text(encoding="utf-8") for name, file in known.items()}
    topics = sorted({topic_of(name) for name in known} - {"operators"})
    in_lists = [f"{topic}.{name}" for topic in topics for name in listed(sources[topic])]
    registering = [
        name
        for name in known
        if name != "operators"
        and (REGISTERED & assigned(sources[name]).keys() or "\nclass KEYMARK_" in sources[name])
    ]
    assert sorted(in_lists) == sorted(registering)
    assert len(registering) > 50


def is_private(source: str) -> bool:
    """Whether a module defines what Blender registers as an operator or a part of the interface."""
    classes = [node for node in nodes(source) if isinstance(node, ast.ClassDef)]
    return any(
        isinstance(base, ast.Attribute) and base.attr in BASES for node in classes for base in node.bases
    )


def trespasses(name: str, is_package: bool, source: str, known: set[str], private: set[str]) -> Iterator[str]:
    """What one module imports that is another's own, as sentences."""
    for line, target in imports(name, is_package, source, known):
        if target not in private or topic_of(target) == topic_of(name) or topic_of(target) in SHARED:
            continue
        node = next(each for each in nodes(source) if getattr(each, "lineno", 0) == line and is_import(each))
        names = [alias.name for alias in node.names]
        if target.rpartition(".")[2] in names or any(each.startswith("KEYMARK_") for each in names):
            yield f"{name}:{line} imports {target}'s operators or panels, which are another topic's"
    for node in nodes(source):
        if isinstance(node, ast.ImportFrom) and (node.level or node.module == "keymark"):
            for alias in node.names:
                if alias.name.startswith("_"):
                    yield f"{name}:{node.lineno} imports {alias.name}, which is private"


def is_import(node: ast.AST) -> bool:
    """Whether a node is `from ... import ...`."""
    return isinstance(node, ast.ImportFrom)


def test_no_topic_imports_the_private_parts_of_another(repository: Path) -> None:
    known = modules(repository, "core", "operators")
    sources = {name: file.read_text(encoding="utf-8") for name, file in known.items()}
    private = {name for name, source in sources.items() if is_private(source)}
    assert "operators.follow.marker_tools" in private and "operators.follow.panel" in private
    wrong: list[str] = []
    for name, file in known.items():
        wrong += trespasses(name, file.name == "__init__.py", sources[name], set(known), private)
    assert wrong == []


@pytest.mark.parametrize(
    ("name", "source"),
    [
        ("operators.review.panel", "from ..follow import marker_panel"),
        (
            "operators.takes.open_take",
            "def late():\n    from ..follow.marker_panel import KEYMARK_PT_markers",
        ),
        ("core.take.take", "from .read_footage import _turned"),
    ],
)
def test_a_trespass_is_found(name: str, source: str) -> None:
    known = {"operators.follow", "operators.follow.marker_panel", "core.take.read_footage"}
    assert len(list(trespasses(name, False, source, known, {"operators.follow.marker_panel"}))) == 1


def test_an_import_within_a_topic_is_none() -> None:
    known = {"operators.follow.marker_panel", "operators.shell.base_operator"}
    source = "from . import panel\nfrom ..shell.messages import say"
    assert (
        list(
            trespasses(
                "operators.follow.marker_list", False, source, known, {"operators.follow.marker_panel"}
            )
        )
        == []
    )
