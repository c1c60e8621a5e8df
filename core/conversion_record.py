"""`conversion.json`: what a finished conversion was made of and what came out, beside its files.

It is the last file to arrive and the first to go, so that files without it are never taken for whole.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from .errors import InputError
from .files.fields import Fields
from .files.json_file import read_json, shown, write_json

NAME = "conversion.json"
SCHEMA_VERSION = 1
LARGEST_BYTES = 2**22
MOST_LISTED = 10**6


@dataclass(frozen=True)
class ConversionRecord:
    """A finished conversion. Nothing in it depends on when, where or how fast it ran."""

    digest: str
    """Of everything the result follows from, see `conversion_digest`."""
    keymark: str
    """The version that made it."""
    take: str
    """What people call the take."""
    method: str
    library: str | None
    """Identifier of the library that was matched; None where all was posed."""
    frames: int
    frame_start: int
    fps: float
    keyframes: tuple[int, ...]
    """Scene frames."""
    matched: tuple[int, ...]
    """Those of them that were matched with a library; a person posed the others."""
    confidence: float | None
    """Mean over the frames of what a review believes, 0 to 1; None for a method without uncertainty."""
    weakest: float | None
    """Confidence that one frame in twenty falls short of."""
    weak_frames: tuple[int, ...]
    """Scene frames worth another keyframe, the worst first."""
    notes: tuple[str, ...]
    """What a person should know, one sentence each."""
    files: Mapping[str, str] = field(default_factory=dict)
    """SHA-256 of every file of the result, by its path in the folder; for motion.blend, in which Blender
    leaves memory addresses, that of its Action's curves."""


def write_record(folder: Path, record: ConversionRecord) -> None:
    """Write a record into a folder of results, beside and moved into place.

    Raises:
        ConversionError: The file cannot be written.
    """
    write_json(folder / NAME, {"schema_version": SCHEMA_VERSION, **asdict(record)}, indent=1)


def read_record(folder: Path) -> ConversionRecord:
    """Read a folder's record.

    Raises:
        InputError: There is none, or a field is unusable.
    """
    path = folder / NAME
    fields = Fields(read_json(path, LARGEST_BYTES), str(path))
    version = fields.whole("schema_version", 1, 10**6)
    if version > SCHEMA_VERSION:
        raise InputError(f"{path}: schema_version is {version}; this Keymark reads up to {SCHEMA_VERSION}")
    return ConversionRecord(
        digest=fields.text("digest", "a digest"),
        keymark=fields.text("keymark", "a version"),
        take=fields.text("take", "a name"),
        method=fields.text("method", "a method"),
        library=fields.text("library", "an identifier") if fields.has("library") else None,
        frames=fields.whole("frames", 1, MOST_LISTED),
        frame_start=fields.whole("frame_start", -(10**7), 10**7),
        fps=fields.number("fps", 1e-3, 1e4),
        keyframes=tuple(_list(fields, "keyframes", int, "a list of frames")),
        matched=tuple(_list(fields, "matched", int, "a list of frames")),
        confidence=_share(fields, "confidence"),
        weakest=_share(fields, "weakest"),
        weak_frames=tuple(_list(fields, "weak_frames", int, "a list of frames")),
        notes=tuple(_list(fields, "notes", str, "a list of sentences")),
        files=_files(fields),
    )


def is_finished(folder: Path, digest: str) -> bool:
    """Whether a folder holds the whole result of a conversion with this digest."""
    try:
        record = read_record(folder)
    except InputError:
        return False
    return record.digest == digest and all((folder / name).is_file() for name in record.files)


def _share(fields: Fields, name: str) -> float | None:
    return fields.number(name, 0.0, 1.0) if fields.has(name) else None


def _list(fields: Fields, name: str, kind: type, valid: str) -> list[Any]:
    value = fields.required(name, valid)
    if not isinstance(value, list) or not all(type(item) is kind for item in value):
        raise InputError(f"{fields.at(name)}: {name} is {shown(value)}; it must be {valid}")
    return value


def _files(fields: Fields) -> Mapping[str, str]:
    files = fields.child("files", "an object of digests by file").values
    for name, digest in files.items():
        parts = Path(name).parts
        if Path(name).is_absolute() or ".." in parts or not isinstance(digest, str):
            raise InputError(f"{fields.where}: files names {shown(name)}; it must be a file of this folder")
    return dict(files)
