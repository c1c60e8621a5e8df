"""`conversion.json`: the record of a finished conversion, its input digest, notes and files.

It is the manifest of the result's commit: written last and removed first, so that a folder without it never
counts as finished.
"""

import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path

from ..errors import InputError
from ..files.fields import Fields
from ..files.json_file import read_json, shown, write_json
from .record_fields import record_files, record_line, record_lines, record_list, record_notes
from .used_evidence import UsedEvidence, read_used_evidence

RECORD_FILE = "conversion.json"
SCHEMA_VERSION = 1
LARGEST_BYTES = 2**22
MOST_LISTED = 10**6
FARTHEST_FRAME = 10**7
MOST_LIBRARIES = 10_000
"""In all folders that are searched: more than people gather, and well within the bytes above."""


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
    """Identifier of the library that was matched, `COMPOSED` where all took part; None where all keyframes
    are posed."""
    frames: int
    frame_start: int
    fps: float
    keyframes: tuple[int, ...]
    """Scene frames."""
    matched: tuple[int, ...]
    """Scene frames of the keyframes that were found in the footage; a person posed the others."""
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
    evidence: UsedEvidence | None = None
    """What the motion was held against beside its keyframes; None in records of before this was noted."""
    libraries: Mapping[str, str] = field(default_factory=dict)
    """Digest of every library that took part, by its identifier; see `library_digest`."""
    doubtful: tuple[int, ...] = ()
    """Scene frames of the found keyframes that are doubtful."""


def write_record(folder: Path, record: ConversionRecord) -> None:
    """Write a record into a folder of results, atomically.

    Raises:
        ConversionError: The file cannot be written.
    """
    evidence = None if record.evidence is None else record.evidence.to_json()
    fields = {"schema_version": SCHEMA_VERSION, **asdict(record), "evidence": evidence}
    write_json(folder / RECORD_FILE, fields, indent=1)


def read_record(folder: Path) -> ConversionRecord:
    """Read a folder's record.

    Raises:
        InputError: There is none, or a field is unusable.
    """
    path = folder / RECORD_FILE
    fields = Fields(read_json(path, LARGEST_BYTES), str(path))
    fields.check_version(SCHEMA_VERSION)
    return ConversionRecord(
        digest=record_line(fields, "digest"),
        keymark=record_line(fields, "keymark"),
        take=record_line(fields, "take"),
        method=record_line(fields, "method"),
        library=record_line(fields, "library") if fields.has("library") else None,
        frames=fields.integer("frames", 1, MOST_LISTED),
        frame_start=fields.integer("frame_start", -FARTHEST_FRAME, FARTHEST_FRAME),
        fps=fields.number("fps", 1e-3, 1e4),
        keyframes=_frames(fields, "keyframes"),
        matched=_frames(fields, "matched"),
        confidence=_share(fields, "confidence"),
        weakest=_share(fields, "weakest"),
        weak_frames=_frames(fields, "weak_frames"),
        notes=record_notes(fields),
        files=record_files(fields),
        evidence=read_used_evidence(fields.child("evidence", "an object"))
        if fields.has("evidence")
        else None,
        libraries=record_lines(fields, "libraries", MOST_LIBRARIES) if "libraries" in fields.values else {},
        doubtful=_frames(fields, "doubtful") if "doubtful" in fields.values else (),
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


def _frames(fields: Fields, name: str) -> tuple[int, ...]:
    valid = f"a list of at most {MOST_LISTED} frames"
    frames = record_list(fields, name, int, MOST_LISTED, valid)
    if any(abs(frame) > FARTHEST_FRAME + MOST_LISTED for frame in frames):
        raise InputError(f"{fields.source_of(name)}: {name} is {shown(frames)}; it must be {valid}")
    return tuple(frames)
