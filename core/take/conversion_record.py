"""`conversion.json`: the record of a finished conversion, its input digest, notes and files.

It is the manifest of the result's commit: written last and removed first, so that a folder without it never
counts as finished.
"""

import os
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..files.fields import Fields
from ..files.json_file import read_json, shown, write_json
from ..files.safe_path import safe_path

RECORD_FILE = "conversion.json"
SCHEMA_VERSION = 1
LARGEST_BYTES = 2**22
MOST_LISTED = 10**6
FARTHEST_FRAME = 10**7
LONGEST_LINE, LONGEST_NOTE = 1000, 10_000
MOST_NOTES, MOST_FILES = 1000, 100
_SHA256 = re.compile(r"[0-9a-f]{64}", re.ASCII)


@dataclass(frozen=True)
class ConversionRecord:
    """The record of a finished conversion; nothing in it depends on time, folder or speed of the run."""

    digest: str
    """Digest of the input, see `conversion_digest`."""
    keymark: str
    """Keymark's version."""
    take: str
    """Name of the take."""
    method: str
    library: str | None
    """Identifier of the library that was matched; None where all keyframes are posed."""
    frames: int
    frame_start: int
    fps: float
    keyframes: tuple[int, ...]
    """Scene frames."""
    matched: tuple[int, ...]
    """Scene frames of the keyframes that were matched with a library; a person posed the others."""
    confidence: float | None
    """Mean confidence of the frames, 0 to 1; None for a method without uncertainty."""
    weakest: float | None
    """Confidence that one frame in twenty falls short of: the 5th percentile."""
    weak_frames: tuple[int, ...]
    """Scene frames that need another keyframe, the worst first."""
    notes: tuple[str, ...]
    """Notes for a person, one sentence each."""
    files: Mapping[str, str] = field(default_factory=dict)
    """SHA-256 of every file of the result, by its path in the folder; for motion.blend, in which Blender
    leaves memory addresses, that of its Action's curves."""


def write_record(folder: Path, record: ConversionRecord) -> None:
    """Write a record into a folder of results, atomically.

    Raises:
        ConversionError: The file cannot be written.
    """
    write_json(folder / RECORD_FILE, {"schema_version": SCHEMA_VERSION, **asdict(record)}, indent=1)


def read_record(folder: Path) -> ConversionRecord:
    """Read a folder's record.

    Raises:
        InputError: There is none, or a field is unusable.
    """
    path = folder / RECORD_FILE
    fields = Fields(read_json(path, LARGEST_BYTES), str(path))
    fields.check_version(SCHEMA_VERSION)
    return ConversionRecord(
        digest=_line(fields, "digest"),
        keymark=_line(fields, "keymark"),
        take=_line(fields, "take"),
        method=_line(fields, "method"),
        library=_line(fields, "library") if fields.has("library") else None,
        frames=fields.integer("frames", 1, MOST_LISTED),
        frame_start=fields.integer("frame_start", -FARTHEST_FRAME, FARTHEST_FRAME),
        fps=fields.number("fps", 1e-3, 1e4),
        keyframes=_frames(fields, "keyframes"),
        matched=_frames(fields, "matched"),
        confidence=_share(fields, "confidence"),
        weakest=_share(fields, "weakest"),
        weak_frames=_frames(fields, "weak_frames"),
        notes=_notes(fields),
        files=_files(fields),
    )


def find_record(folder: Path) -> ConversionRecord | None:
    """A folder's record; None where there is none, or it cannot be read."""
    try:
        return read_record(folder)
    except InputError:
        return None


def is_up_to_date(folder: Path, digest: str) -> bool:
    """Whether a folder holds the complete result of a conversion with this input digest."""
    record = find_record(folder)
    if record is None:
        return False
    return record.digest == digest and all(os.path.isfile(folder / name) for name in record.files)


def _share(fields: Fields, name: str) -> float | None:
    return fields.number(name, 0.0, 1.0) if fields.has(name) else None


def _line(fields: Fields, name: str) -> str:
    valid = f"a text of at most {LONGEST_LINE} characters"
    text = fields.text(name, valid)
    if len(text) > LONGEST_LINE:
        raise InputError(f"{fields.source_of(name)}: {name} is {shown(text)}; it must be {valid}")
    return text


def _list(fields: Fields, name: str, kind: type, most: int, valid: str) -> list[Any]:
    value = fields.required(name, valid)
    if not isinstance(value, list) or len(value) > most or not all(type(item) is kind for item in value):
        raise InputError(f"{fields.source_of(name)}: {name} is {shown(value)}; it must be {valid}")
    return value


def _frames(fields: Fields, name: str) -> tuple[int, ...]:
    valid = f"a list of at most {MOST_LISTED} frames"
    frames = _list(fields, name, int, MOST_LISTED, valid)
    if any(abs(frame) > FARTHEST_FRAME + MOST_LISTED for frame in frames):
        raise InputError(f"{fields.source_of(name)}: {name} is {shown(frames)}; it must be {valid}")
    return tuple(frames)


def _notes(fields: Fields) -> tuple[str, ...]:
    valid = f"a list of at most {MOST_NOTES} sentences of {LONGEST_NOTE} characters"
    notes = _list(fields, "notes", str, MOST_NOTES, valid)
    if any(len(note) > LONGEST_NOTE for note in notes):
        raise InputError(f"{fields.source_of('notes')}: notes is {shown(notes)}; it must be {valid}")
    return tuple(notes)


def _files(fields: Fields) -> Mapping[str, str]:
    files = fields.child("files", f"an object of at most {MOST_FILES} digests by file")
    if len(files.values) > MOST_FILES:
        raise InputError(f"{files.where} names {len(files.values)} files; at most {MOST_FILES} are read")
    for name, digest in files.values.items():
        safe_path(Fields({"name": name}, files.where), "name", Path(), "a file of this folder")
        if not isinstance(digest, str) or _SHA256.fullmatch(digest) is None:
            raise InputError(
                f"{files.where}: {shown(name)} is {shown(digest)}; it must be a SHA-256 of 64 digits"
            )
    return dict(files.values)
