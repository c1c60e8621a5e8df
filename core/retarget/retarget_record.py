"""`retarget.json`: the record of a motion on a character: what was recognized, and how good it came out."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

from ..files.json_file import read_json
from ..files.kinds import ByName, Choice, Number, Text
from ..files.records import Record
from ..take.conversion_settings import RetargetOptions
from ..take.evidence import FileDigests, Frame, FrameCount, FrameRate, Line, Notes, Sha256
from .character import LIMBS
from .maps.character_map import Roles, roles_mistake

RECORD_FILE = "retarget.json"
LARGEST_BYTES = 2**22
GIVEN, SAVED, RECOGNIZED = "given", "saved", "recognized"
ORIGINS = (GIVEN, SAVED, RECOGNIZED)  # the person named it, its file fits the bones, it was made of them
KEYED = ("fk", "ik", "both")


class Figure(Number):
    """A figure, written with five digits; a number of things stays whole."""

    def read(self, value: Any, where: str, name: str) -> float:
        """See `Kind`."""
        super().read(value, where, name)
        return value

    def write(self, value: float) -> float:
        """See `Kind`."""
        return value if isinstance(value, int) else float(f"{value:.5g}") + 0.0


@dataclass(frozen=True)
class UsedCharacter(Record):
    """The character of a result."""

    file: Line
    """Its file, without its folder."""
    object: Line
    """Name of its armature."""
    sha256: Sha256
    """Of the file's content."""


@dataclass(frozen=True)
class UsedMap(Record):
    """The character map of a result."""

    SPARSE = False

    title: Line
    """Its title."""
    origin: Annotated[str, Choice(ORIGINS)]
    """Where it comes from."""
    preset: Line | None
    """The convention that was recognized; None where there is none."""


@dataclass(frozen=True)
class RetargetRecord(Record):
    """The record of a motion on a character; nothing in it depends on time, folder or speed of the run."""

    VERSION, TITLE, SPARSE = 1, "motion on a character", False
    REQUIRED = ("quality", "doubts", "notes", "files")

    keymark: Line
    """Keymark's version."""
    take: Line
    """Name of the take, or of the motion's folder."""
    character: UsedCharacter
    """The character."""
    map: UsedMap
    """Its map."""
    action: Line
    """Name of the Action in character.blend."""
    frames: FrameCount
    """Number of frames."""
    frame_start: Frame
    """Scene frame of the first frame."""
    fps: FrameRate
    """Frames per second."""
    size: Annotated[float, Number(0.0, 1e6, decimals=6)]
    """The character's size: its legs' length over the performer's."""
    options: RetargetOptions
    """How the motion was put onto it."""
    roles: Roles
    """By role, what was recognized and how surely."""
    limbs: Annotated[
        Mapping[str, Annotated[str, Choice(KEYED)]], ByName("controls by limb", names=tuple(LIMBS))
    ]
    """By limb, which of its controls are keyed."""
    quality: Annotated[
        Mapping[str, Annotated[float, Figure(-1e12, 1e12)] | None],
        ByName("figures", 200, key=Text(100)),
    ] = field(default_factory=dict)
    """Figures by name, units at the names' ends; None where one does not apply."""
    warnings: Notes = ()
    """Which figures are out of bounds, so that the motion is not right on the character."""
    doubts: Notes = ()
    """What was recognized without being sure, one sentence each."""
    notes: Notes = ()
    """What a person should know, one sentence each."""
    files: FileDigests = field(default_factory=dict)
    """SHA-256 of files of the result; for character.blend that of its Action's curves. Exports are left out:
    Blender writes the time into them."""

    def mistake(self) -> str:
        """See `Record`."""
        return roles_mistake(self.roles)


def read_retarget_record(folder: Path) -> RetargetRecord:
    """Read a folder's record.

    Raises:
        InputError: There is none, or a field is unusable.
    """
    path = folder / RECORD_FILE
    return RetargetRecord.from_json(read_json(path, LARGEST_BYTES), str(path))
