"""Sentences that people meet, read from the source: every note and warning by its template."""

import ast
from collections.abc import Iterator
from pathlib import Path

from _house import modules

ERRORS = frozenset({"InputError", "ConversionError", "BusyError"})
STAGES = frozenset({"within", "Progress"})
"""Calls that name the stage of a job."""
WARNING_ARGUMENT, TEMPLATE_ARGUMENT = 1, 2
"""Of `messages.say`: how grave it is, and the sentence."""


def name_of(call: ast.Call) -> str:
    """The name of the function or method that is called."""
    return call.func.id if isinstance(call.func, ast.Name) else getattr(call.func, "attr", "")


def literal(node: ast.AST) -> str | None:
    """A literal's text; None for anything else."""
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None


def notes_and_warnings(source: str) -> Iterator[str]:
    """Templates of the notes and warnings of a module: what it says beside its errors."""
    calls = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call)]
    others = {part for call in calls if name_of(call) in ERRORS | STAGES for part in ast.walk(call)}
    for call in calls:
        template = None
        if name_of(call) == "Sentence" and call not in others:
            template = literal(call.args[0])
        elif name_of(call) == "say" and literal(call.args[WARNING_ARGUMENT]) == "WARNING":
            template = literal(call.args[TEMPLATE_ARGUMENT])
        if template is not None:
            yield template


def all_notes_and_warnings(repository: Path) -> dict[str, str]:
    """Those of the whole program, each with the module that says it."""
    return {
        template: name
        for name, file in modules(repository, "core", "operators").items()
        for template in notes_and_warnings(file.read_text(encoding="utf-8"))
    }
