"""Fields that records of results have in common: lines, sentences, and digests of files."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..files.fields import Fields
from ..files.json_file import shown
from ..files.safe_path import safe_path

LONGEST_LINE, LONGEST_NOTE = 1000, 10_000
MOST_NOTES, MOST_FILES = 1000, 100
_SHA256 = re.compile(r"[0-9a-f]{64}", re.ASCII)


def record_line(fields: Fields, name: str) -> str:
    """A text that is not empty."""
    valid = f"a text of at most {LONGEST_LINE} characters"
    text = fields.text(name, valid)
    if len(text) > LONGEST_LINE:
        raise InputError(f"{fields.source_of(name)}: {name} is {shown(text)}; it must be {valid}")
    return text


def record_list(fields: Fields, name: str, kind: type, most: int, valid: str) -> list[Any]:
    """A list of values of one kind."""
    value = fields.required(name, valid)
    if not isinstance(value, list) or len(value) > most or not all(type(item) is kind for item in value):
        raise InputError(f"{fields.source_of(name)}: {name} is {shown(value)}; it must be {valid}")
    return value


def record_notes(fields: Fields, name: str = "notes") -> tuple[str, ...]:
    """A list of sentences."""
    valid = f"a list of at most {MOST_NOTES} sentences of {LONGEST_NOTE} characters"
    notes = record_list(fields, name, str, MOST_NOTES, valid)
    if any(len(note) > LONGEST_NOTE for note in notes):
        raise InputError(f"{fields.source_of(name)}: {name} is {shown(notes)}; it must be {valid}")
    return tuple(notes)


def record_lines(fields: Fields, name: str, most: int) -> Mapping[str, str]:
    """An object of texts that are not empty, by name."""
    found = fields.child(name, f"an object of at most {most} texts")
    if len(found.values) > most:
        raise InputError(f"{found.where} has {len(found.values)} names; at most {most} are read")
    return {key: record_line(found, key) for key in found.values}


def record_files(fields: Fields) -> Mapping[str, str]:
    """The SHA-256 of every file of a result, by its path in the folder."""
    files = fields.child("files", f"an object of at most {MOST_FILES} digests by file")
    if len(files.values) > MOST_FILES:
        raise InputError(f"{files.where} names {len(files.values)} files; at most {MOST_FILES} are read")
    for name, digest in files.values.items():
        safe_path(Fields({"name": name}, files.where), "name", Path(), "a file of this folder")
        checked_sha256(digest, f"{files.where}: {shown(name)}")
    return dict(files.values)


def checked_sha256(digest: object, where: str) -> str:
    """A SHA-256 in hexadecimal digits; `where` begins the sentence."""
    if not isinstance(digest, str) or _SHA256.fullmatch(digest) is None:
        raise InputError(f"{where} is {shown(digest)}; it must be a SHA-256 of 64 digits")
    return digest
