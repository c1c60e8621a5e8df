"""Sentences that people meet, read from the source: every literal, with braces where values go."""

import ast
from collections.abc import Iterator
from pathlib import Path

from _house import modules


def sentences(source: str) -> Iterator[str]:
    """The literals of a module; a value that is filled in is `{}`."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.JoinedStr):
            parts = (part.value if isinstance(part, ast.Constant) else "{}" for part in node.values)
            yield "".join(map(str, parts))
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield without_names(node.value)


def without_names(template: str) -> str:
    """A template without the names of its values."""
    result, depth = "", 0
    for letter in template:
        depth += (letter == "{") - (letter == "}")
        result += letter if letter == "{" or not depth else ""
    return result


def all_sentences(repository: Path) -> set[str]:
    """Those of the whole program."""
    files = modules(repository, "core", "operators").values()
    return {said for file in files for said in sentences(file.read_text(encoding="utf-8"))}
