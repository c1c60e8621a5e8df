"""`conversion.json`, the record of a finished conversion, and the digest of its input.

It is the manifest of the result's commit: written last and removed first, so that a folder without it never
counts as finished.
"""

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from .. import MOST_FRAMES
from ..errors import InputError
from ..files.digest import content_digest, digest
from ..files.json_file import read_json, write_json
from ..files.kinds import ByName, Items, Number, Whole
from ..files.records import Record
from ..prior.texts import COMPOSED, EVERY_LIBRARY
from ..video.image_sequence import find_images
from .conversion_settings import METHODS, ConversionSettings
from .description import FILE_FIELDS, SETTING_FIELDS, Description, keypoint_files
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


FORMAT = 5
"""Raised whenever the same input gives another result without a new version."""


def conversion_digest(
    description: Description,
    settings: ConversionSettings,
    libraries: Sequence[str],
    output: Path,
    version: str,
    maps: Sequence[str] = (),
) -> str:
    """A digest that changes with every input of a conversion, and with nothing else.

    Files count by their content, not by their modification times: clocks differ, copies keep no times.

    Args:
        description: The take's description.
        settings: The settings of its conversion.
        libraries: Digests of the libraries to find keyframes with.
        output: The folder of the results: a .blend holds the relative path from there to its clip.
        version: Keymark's version.
        maps: Digests of the character maps that may be used, where there is a character.
    """
    try:
        images = find_images(description.clip)
    except OSError as error:
        raise InputError(f"{description.clip}: the clip cannot be read ({error.strerror})") from error
    try:
        clip = os.path.relpath(os.path.realpath(description.clip), os.path.realpath(output))
    except ValueError:  # another drive
        clip = str(description.clip)
    footage = [description.clip] if images is None else images
    posed = settings.keyframes
    if posed is None and os.path.exists(description.keyframes):
        posed = description.keyframes
    character, options = settings.character, ""
    contents: tuple[object, ...] = ()
    if character is not None:
        files = (character.file, *_buffers(character.file))
        contents = tuple((file.name, content_digest(file)) for file in files)
        options = json.dumps(character.options.to_json(), sort_keys=True)
    about_files = (*FILE_FIELDS, *SETTING_FIELDS)
    fields = {name: value for name, value in description.fields.values.items() if name not in about_files}
    if isinstance(fields.get("markers"), Mapping):  # in their order, which is that of the results
        fields["markers"] = list(fields["markers"].items())
    keypoints = keypoint_files(description, settings)
    network = None if keypoints else settings.network
    evidence: tuple[object, ...] = ()
    if keypoints or settings.evidence is not None:
        evidence = (tuple(_keypoints(file) for file in keypoints), settings.evidence)
    return digest(
        FORMAT,
        version,
        json.dumps(fields, sort_keys=True, ensure_ascii=False),
        description.name,
        clip,
        tuple((file.name, content_digest(file)) for file in footage),
        None if posed is None else content_digest(posed),
        (COMPOSED, *libraries) if settings.library == EVERY_LIBRARY else tuple(libraries),
        settings.floor_m if libraries else None,
        settings.method or METHODS[0],
        settings.pictures is not False,
        settings.hands is not False,
        None if character is None else ((contents, character.object, options), tuple(maps)),
        *evidence,
        *(value for value in (settings.subject, settings.shot, settings.performer) if value is not None),
        *((path.name, content_digest(path)) for path in (settings.reference, network) if path is not None),
    )


def _keypoints(path: Path) -> tuple[object, ...]:
    """The names and contents of a file, or of all files of a folder."""
    try:
        files = sorted(file for file in path.iterdir() if not file.name.startswith("."))
    except NotADirectoryError:
        files = [path]
    except OSError as error:
        raise InputError(f"{path}: the keypoints cannot be read ({error.strerror})") from error
    return (path.name, tuple((file.name, content_digest(file)) for file in files if not file.is_dir()))


def _buffers(path: Path) -> list[Path]:
    """Files beside a .gltf that hold its numbers, where it has any."""
    if path.suffix.lower() != ".gltf":
        return []
    try:
        buffers = read_json(path).get("buffers")
    except InputError:  # Blender has its own word on it
        return []
    names = [one.get("uri") for one in buffers if isinstance(one, dict)] if isinstance(buffers, list) else []
    beside = [path.parent / name for name in names if isinstance(name, str) and Path(name).name == name]
    return [file for file in beside if file.is_file()]
