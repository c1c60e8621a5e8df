"""The character that gets a motion: its file, its map, and how the motion is put onto it.

Each choice is declared once: fields of files, options of the command line and Blender's properties follow.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import Annotated

from ..errors import InputError
from ..files.fields import listed
from ..files.json_file import ENDING
from ..files.kinds import INSIDE, Number, Text, relative_path
from ..files.records import Record, declared


class RootMotion(StrEnum):
    """Where the way over the ground goes."""

    AS_FILMED = "as-filmed"
    """The character goes where the performer went, by its hips."""
    IN_PLACE = "in-place"
    """The character stays where it begins, as on a treadmill."""
    ROOT_BONE = "root-bone"
    """The way over the ground is keyed on the root bone, for games and loops."""


class Placement(StrEnum):
    """Where the character performs."""

    PERFORMER = "performer"
    """The character is placed and turned to where the performer stands and faces in the footage."""
    CHARACTER = "character"
    """The character stays where it stands, and the motion begins there."""


class LimbKeys(StrEnum):
    """Which controls of a limb are keyed, and which of them shows."""

    FK = "fk"
    """Key the bones of the chain, or their FK controls, and show FK."""
    IK = "ik"
    """Key the IK controls and show IK; a limb that has none is keyed in FK."""
    BOTH = "both"
    """Key FK and IK alike and show IK, so that you may switch between them."""


@dataclass(frozen=True)
class RetargetOptions(Record):
    """How a motion is put onto a character."""

    SPARSE = False

    root_motion: RootMotion = RootMotion.AS_FILMED
    """Where the way over the ground goes: on the hips, nowhere, or on the root bone; the default is
    as-filmed."""
    place: Placement = Placement.PERFORMER
    """Where the character performs: where the performer stood and faced, which is the default, or where it
    stands itself."""
    arms: LimbKeys = LimbKeys.IK
    """Controls of the arms that are keyed; the default is ik."""
    legs: LimbKeys = LimbKeys.IK
    """Controls of the legs that are keyed; the default is ik."""
    plant_feet: bool = True
    """Hold resting feet at one place, flat on the floor; the legs follow."""
    reach_hands: bool = True
    """Let the hands reach what the performer's reached: each other, the body, the floor."""
    tolerance_mm: Annotated[float, Number(0.0, 1000.0, "mm")] = 5.0
    """Largest distance of any joint, end or sole from the full motion [mm], for few keys; 0 for a key on
    every frame; the default is 5."""

    @property
    def tolerance_m(self) -> float | None:
        """The tolerance [m]; None for a key on every frame."""
        return self.tolerance_mm / 1000.0 or None


CHARACTER_ENDINGS = (".blend", ".fbx", ".glb", ".gltf", ".vrm")
AUTO, NO_MAP = "auto", "none"
"""In place of a map: a saved one that knows the character's bones, else recognition; recognition alone."""
LONGEST_NAME = 255
FILE_VALID = (
    f"the path of a character file inside the folder, ending in {', '.join(CHARACTER_ENDINGS[:-1])} or "
    f"{CHARACTER_ENDINGS[-1]}"
)
MAP_VALID = (
    "a character map's title, auto, none, or the path of a map file inside the folder, as in anna.json"
)
_ENDINGS = "|".join("".join(f"[{one}{one.upper()}]" for one in ending[1:]) for ending in CHARACTER_ENDINGS)


@dataclass(frozen=True)
class CharacterFile:
    """A character in a file."""

    path: Path
    object: str | None = None
    """Name of its armature; None where the file has only one."""

    def __str__(self) -> str:
        return str(self.path) if self.object is None else f"{self.path}:{self.object}"

    @classmethod
    def parse(
        cls, text: str, endings: Sequence[str] = CHARACTER_ENDINGS, wrong: str = "names no character"
    ) -> "CharacterFile":
        """Read `FILE` or `FILE:OBJECT`; drive letters and colons in folders or objects are no separators."""
        either = "|".join(map(re.escape, endings))
        found = re.fullmatch(rf"(.*?(?:{either}))(?::(.*))?", text, re.IGNORECASE | re.DOTALL)
        if found is None or found[2] == "":
            raise InputError(
                f"{text}: {wrong}; it must be a file that ends in {listed(endings)}, and after a colon the "
                "name of its armature where it has several, as in anna.blend:rig"
            )
        return cls(Path(found[1]), found[2])


def name_or_file_fault(text: str, valid: str) -> str:
    """What is wrong with a name that may be a JSON file inside a folder too, to follow "it"."""
    if text.lower().endswith(ENDING):
        return relative_path(valid).fault(text)
    return f"must be {valid}" if any(letter in "/\\" for letter in text) else ""


@dataclass(frozen=True, kw_only=True)
class CharacterSettings(RetargetOptions):
    """The character that gets the motion too, as character.blend in the results."""

    STRICT = True
    ORDER = ("file", "object", "map", *declared(RetargetOptions))

    file: Annotated[Path, replace(relative_path(FILE_VALID), pattern=rf"{INSIDE[:-2]}\.({_ENDINGS})$")]
    """The character's file, relative to the folder of the file with this field and inside it: .blend, .fbx,
    .glb, .gltf or .vrm."""
    object: Annotated[str, Text(LONGEST_NAME, "the name of an armature", one_line=True)] | None = None
    """Name of the character's armature, where its file has several."""
    map: Annotated[
        str,
        Text(LONGEST_NAME, MAP_VALID, one_line=True, fault=lambda text: name_or_file_fault(text, MAP_VALID)),
    ] = AUTO
    """Character map: its title, a file ending in .json inside the folder, auto (the default) for a saved map
    that knows the character's bones, none for recognition alone."""

    @property
    def character_file(self) -> CharacterFile:
        """The file and the armature in it."""
        return CharacterFile(self.file, self.object)

    @property
    def map_file(self) -> Path | None:
        """The map's file, where it is given by path."""
        return Path(self.map) if self.map.lower().endswith(ENDING) else None

    @property
    def options(self) -> RetargetOptions:
        """The options alone."""
        return RetargetOptions(**{name: getattr(self, name) for name in declared(RetargetOptions)})

    def inside(self, folder: Path, map_folder: Path) -> "CharacterSettings":
        """The settings with paths in the folders of the files that say `file` and `map`."""
        named = self.map if self.map_file is None else str(map_folder / self.map)
        return replace(self, file=folder / self.file, map=named)
