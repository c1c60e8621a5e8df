"""`conversion.json`: the record of a finished conversion, its input digest, notes and files.

It is the manifest of the result's commit: written last and removed first, so that a folder without it never
counts as finished.
"""

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from .. import MOST_FRAMES
from ..errors import InputError
from ..files.json_file import read_json, write_json
from ..files.kinds import ByName, Items, Number, Whole
from ..files.records import Record
from .evidence import (
    FARTHEST_FRAME,
    FileDigests,
    Frame,
    FrameCount,
    FrameRate,
    Line,
    Notes,
    UsedEvidence,
)

RECORD_FILE = "conversion.json"
MOTION, BLEND, BVH, REPORT = "motion.json", "motion.blend", "motion.bvh", "report"
CHARACTER_BLEND, CHARACTER_PICTURE = "character.blend", f"{REPORT}/character.png"
PICTURES = ("overlay.png", "side.png")
EARLIER_PICTURES = ("speed.png", "front.png", "top.png", "matches.png", "strip.jpg")
"""Pictures of 0.1.0, which a conversion into the same folder removes."""
LARGEST_BYTES = 2**22
MOST_LIBRARIES = 10_000
"""In all folders that are searched: more than people gather, and well within the bytes above."""


Share = Annotated[float, Number(0.0, 1.0)]
Frames = Annotated[
    tuple[Annotated[int, Whole(-FARTHEST_FRAME - MOST_FRAMES, FARTHEST_FRAME + MOST_FRAMES)], ...],
    Items("frames", 0, MOST_FRAMES),
]


@dataclass(frozen=True)
class ConversionRecord(Record):
    """The record of a finished conversion; nothing in it depends on time, folder or speed of the run."""

    VERSION, TITLE, SPARSE, REQUIRED = 1, "conversion", False, ("files",)

    digest: Line
    """Digest of the input, see `conversion_digest`."""
    keymark: Line
    """Keymark's version."""
    take: Line
    """Name of the take."""
    method: Line
    """`map`, `ekf` or `interpolation`."""
    library: Line | None
    """Identifier of the library that was matched, `composed` where all took part; None where all keyframes
    are posed."""
    frames: FrameCount
    """Number of frames."""
    frame_start: Frame
    """Scene frame of the first frame."""
    fps: FrameRate
    """Frames per second."""
    keyframes: Frames
    """Scene frames."""
    matched: Frames
    """Scene frames of the keyframes that were found in the footage; a person posed the others."""
    confidence: Share | None
    """Mean confidence of the frames, 0 to 1; None for a method without uncertainty."""
    weakest: Share | None
    """Confidence that one frame in twenty falls short of: the 5th percentile."""
    weak_frames: Frames
    """Scene frames that need another keyframe, the worst first."""
    notes: Notes
    """Notes for a person, one sentence each."""
    files: FileDigests = field(default_factory=dict)
    """SHA-256 of every file of the result, by its path in the folder; for motion.blend, in which Blender
    leaves memory addresses, that of its Action's curves."""
    evidence: UsedEvidence | None = None
    """What the motion was held against beside its keyframes; None in records of before this was noted."""
    libraries: Annotated[Mapping[str, Line], ByName("digests of libraries", MOST_LIBRARIES)] = field(
        default_factory=dict
    )
    """Digest of every library that took part, by its identifier; see `library_digest`."""
    warnings: Notes = ()
    """What is not right on the character by its own figures, one sentence each."""
    doubtful: Frames = ()
    """Scene frames of the found keyframes that are doubtful."""


def write_record(folder: Path, record: ConversionRecord) -> None:
    """Write a record into a folder of results, atomically."""
    write_json(folder / RECORD_FILE, record.to_json(), indent=1)


def read_record(folder: Path) -> ConversionRecord:
    """Read a folder's record."""
    path = folder / RECORD_FILE
    return ConversionRecord.from_json(read_json(path, LARGEST_BYTES), str(path))


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
