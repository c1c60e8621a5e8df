"""JSON files: read strictly, written atomically, formatted for people where they edit them."""

import errno
import json
import os
import re
import shutil
import sys
from collections.abc import Callable, Iterable, Mapping
from math import isfinite
from pathlib import Path
from typing import Any

from ..errors import ConversionError, InputError, shown
from .file_lock import LOCK, file_lock, hidden_prefix
from .paths import regular_file_size

ENDING = ".json"


def json_files(folder: Path) -> list[Path]:
    """The first 500 JSON files in a folder, by name; none where it is missing."""
    try:
        files = [path for path in folder.iterdir() if path.suffix.lower() == ENDING and path.is_file()]
    except OSError:
        return []
    return sorted(files)[:500]


def is_path(name_or_path: str | Path) -> bool:
    """Whether a file is meant where names are valid too: it ends in `.json` or contains a path separator."""
    text = os.fspath(name_or_path)
    parted = any(mark in text for mark in (os.sep, os.altsep, "/") if mark)
    return isinstance(name_or_path, Path) or parted or text.lower().endswith(ENDING)


DISK_ERRORS = frozenset(
    getattr(errno, name) for name in ("ENOSPC", "EDQUOT", "EFBIG", "EIO") if hasattr(errno, name)
)
"""Errors that say the disk is full or broken, not that a path was ill chosen."""


def fsync_path(path: Path) -> None:
    """Wait until a file's content, or a folder's list of names, is on the disk; OSError if that is full."""
    if sys.platform == "win32" and path.is_dir():
        return
    try:
        descriptor = os.open(path, os.O_RDWR if sys.platform == "win32" else os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
    except OSError as error:
        if error.errno in DISK_ERRORS:  # others only mean that this file system has no fsync
            raise


LARGEST_BYTES = 64 * 2**20
"""A moving camera of an hour fits; a video given by mistake does not."""
DEEPEST = 50
"""Levels of nested lists and objects; no file of ours has ten."""
MOST_LISTS = 4 * 10**6
"""Lists and objects of a file, each of which takes many times its two characters once it is read."""
WORK = "-work"
_STRING = re.compile(r'"(?:[^"\\]|\\.)*"')
_SURROGATE = re.compile(r"\\u[dD][89a-fA-F]")
_NO_BRACKETS = re.compile(r"[^\[\]{}]+")


def read_json(path: Path, largest_bytes: int = LARGEST_BYTES) -> dict[str, Any]:
    """Read a JSON object; an `InputError` says why it is none, see `parse_json`."""
    return parse_json(_read_text(path, largest_bytes), str(path))


def read_json_value(path: Path, largest_bytes: int = LARGEST_BYTES) -> Any:
    """Read any JSON value from a file of another program, as strictly as `read_json`; NaN becomes null.

    Programs write NaN for what they did not find; no other number that is not finite means anything.
    """
    return _parse(_read_text(path, largest_bytes), str(path), nan_is_null=True)


def parse_json(text: str, where: str) -> dict[str, Any]:
    """The JSON object in a text.

    Raises:
        InputError: It is none, nested too deeply, names a field twice or has a number that is not finite.
    """
    value = _parse(text, where)
    if not isinstance(value, dict):
        raise InputError(f"{where}: holds {shown(value)}; it must hold an object, {{...}}")
    return value


def _parse(text: str, where: str, nan_is_null: bool = False) -> Any:
    """Any JSON value in a text; lists and objects are counted before memory is taken for them."""
    count, depth = text.count("[") + text.count("{"), 0
    if count > MOST_LISTS:
        raise InputError(f"{where}: holds {count} lists and objects; at most {MOST_LISTS} are read")
    for mark in _NO_BRACKETS.sub("", _STRING.sub("", text)) if count > DEEPEST else "":
        depth += 1 if mark in "[{" else -1
        if depth > DEEPEST:
            deep = f"its lists and objects are nested too deeply; {DEEPEST} levels are read"
            raise InputError(f"{where}: {deep}")

    def constant(name: str) -> None:
        if not nan_is_null or name != "NaN":
            raise ValueError(f"{name} is no number in JSON; every number must be finite")

    try:
        value = json.loads(
            text,
            object_pairs_hook=_unique_fields,
            parse_constant=constant,
            parse_float=_float,
            parse_int=_int,
        )
        if _SURROGATE.search(text) is not None:  # escapes can write halves of characters, UTF-8 cannot
            json.dumps(value, ensure_ascii=False).encode()
    except json.JSONDecodeError as error:
        raise InputError(
            f"{where}: line {error.lineno}, column {error.colno} is no valid JSON ({error.msg})"
            f"{_reason(text, error)}"
        ) from error
    except UnicodeEncodeError as error:
        half = shown(error.object[error.start])
        raise InputError(f"{where}: {half} is half of a character; texts must be valid Unicode") from error
    except ValueError as error:
        raise InputError(f"{where}: {error}") from error
    return value


_TABLE = re.compile(r"[^\n\[{,;\t]*([,;\t])[^\n\[{]*\n[^\n\[{]*\1")
_PYTHON = re.compile(r"'|None\b|True\b|False\b|nan\b|\(|array\(")


def _reason(text: str, error: json.JSONDecodeError) -> str:
    """What text that is no JSON is instead, to end a sentence; empty where that is not known."""
    if not text.strip():
        return "; the file is empty"
    if error.pos >= len(text.rstrip()) or error.msg.startswith("Unterminated"):
        return "; the file is cut off, or is still being written"
    if error.msg == "Extra data" and text[: error.pos].rstrip(" \t\r").endswith("\n"):
        return "; a value a line is JSON Lines, and the file must hold one value: a list of them, [..., ...]"
    if _TABLE.match(text):
        return "; it is a table (CSV), and must be JSON"
    if _PYTHON.match(text, error.pos):
        return "; it is what Python prints, and must be written by json.dump"
    return ""


def write_json(path: Path, value: Any, indent: int | None = None) -> None:
    """Write a value as strict JSON, atomically; the same value always gives the same bytes."""
    separators = (",", ":") if indent is None else (",", ": ")
    text = json.dumps(value, indent=indent, separators=separators, allow_nan=False, ensure_ascii=False)
    _write_text(path, text)


def _write_text(path: Path, text: str) -> None:
    write_atomically(path, lambda beside: beside.write_text(text + "\n", encoding="utf-8", newline="\n"))


def write_atomically(path: Path, write: Callable[[Path], object]) -> None:
    """Write a file atomically: `write` makes it in a hidden folder beside `path`, from which it is moved.

    Others that write the same file meanwhile wait. The remains of a killed process go with the next writing.
    """
    try:
        stem = path.parent / hidden_prefix(path.name)
        busy = f"{path}: another process has been writing it for too long; try again when it has finished"
        with file_lock(stem.with_name(stem.name + LOCK), busy, wait=True):
            folder = stem.with_name(stem.name + WORK)
            try:
                if os.path.lexists(folder):
                    shutil.rmtree(folder)
                folder.mkdir()
                beside = folder / path.name
                write(beside)
                fsync_path(beside)
                os.replace(beside, path)
            finally:
                shutil.rmtree(folder, ignore_errors=True)
    except OSError as error:
        raise ConversionError(f"{path}: cannot be written ({error.strerror or error})") from error


def _read_text(path: Path, largest_bytes: int) -> str:
    valid = "a JSON file in UTF-8"
    size = regular_file_size(path, valid)
    try:
        with path.open("rb") as file:
            content = file.read(largest_bytes + 1)  # it may have grown since
        if len(content) > largest_bytes:
            has, limit = max(size, len(content)) / 2**20, largest_bytes / 2**20
            raise InputError(f"{path}: has {has:.1f} MiB; at most {limit:g} are read")
        return content.decode("utf-8-sig")
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(f"{path}: cannot be read ({reason}); it must be {valid}") from error


def _unique_fields(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    fields: dict[str, Any] = {}
    for name, value in pairs:
        if name in fields:
            raise ValueError(f"the field {shown(name)} stands twice in one object; it must stand once")
        fields[name] = value
    return fields


def _float(text: str) -> float:
    value = float(text)
    if not isfinite(value):
        raise ValueError(f"the number {text[:40]} is too large; every number must be finite")
    return value


def _int(text: str) -> int:
    if len(text.lstrip("-")) > 15:  # which have an exact float64
        raise ValueError(f"the whole number {text[:40]} is too large; at most 15 digits are read")
    return int(text)


WIDTH = 110
"""Characters of a line: a list or an object of plain values that fits stands in one line."""
_AXIS = re.compile(r"_[xyz]$")


def write_readable_json(path: Path, value: Any) -> None:
    """Write a value as formatted strict JSON, atomically; the same value always gives the same bytes."""
    _write_text(path, format_json(value))


def format_json(value: Any, depth: int = 0, before: int = 0) -> str:
    """A value as JSON text, one item a line.

    Short lists and objects stand in one line, and so do the components x, y and z of one quantity where names
    of the object are compound ones: a change of one quantity is a change of one line. `depth` are the spaces
    before its lines, `before` the characters before it in its first line.
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
    inner = depth + 2
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
