"""JSON formatted for people: easy to read, and to compare line by line between versions."""

import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from .json_file import write_atomically

WIDTH = 110
"""Characters of a line: a list or an object of plain values that fits stands in one line."""
INDENT = 2
_AXIS = re.compile(r"_[xyz]$")


def write_readable_json(path: Path, value: Any) -> None:
    """Write a value as formatted strict JSON, atomically; the same value always gives the same bytes.

    Raises:
        ValueError: A number is NaN or infinite.
        ConversionError: The file cannot be written.
    """
    text = format_json(value) + "\n"
    write_atomically(path, lambda beside: beside.write_text(text, encoding="utf-8", newline="\n"))


def format_json(value: Any, depth: int = 0, before: int = 0) -> str:
    """A value as JSON text, one item a line.

    Short lists and objects stand in one line, and so do the components x, y and z of one quantity where names
    of the object are compound ones: a change of one quantity is a change of one line.

    Args:
        value: A value that `json` can write.
        depth: Spaces before its lines.
        before: Characters before it in its line.
    """
    if not isinstance(value, Mapping | list | tuple) or not value:
        return _plain(value)
    if isinstance(value, Mapping):
        compound = any("." in name for name in value)
        rows = _rows(value)
    else:
        compound = False
        rows = [[("", item)] for item in value]
    flat = not any(isinstance(item, Mapping | list | tuple) for row in rows for _, item in row)
    short = _plain(value)
    if flat and not compound and depth + before + len(short) <= WIDTH:
        return short
    inner = depth + INDENT
    lines = [", ".join(name + format_json(item, inner, len(name)) for name, item in row) for row in rows]
    opening, closing = ("{", "}") if isinstance(value, Mapping) else ("[", "]")
    between = "\n" + " " * inner
    return opening + between + f",{between}".join(lines) + "\n" + " " * depth + closing


def _plain(value: Any) -> str:
    return json.dumps(value, allow_nan=False, ensure_ascii=False)


def _rows(fields: Mapping[str, Any]) -> Iterable[list[tuple[str, Any]]]:
    """The fields with their names as JSON; those that differ in the axis only share a row."""
    rows: dict[str, list[tuple[str, Any]]] = {}
    for name, item in fields.items():
        stem = _AXIS.sub("", name) if "." in name else name
        rows.setdefault(stem, []).append((f"{_plain(name)}: ", item))
    return list(rows.values())
