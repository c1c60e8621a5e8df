"""The character that a take's motion is put onto: its file, its map, and how, in the words of files."""

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

from ..errors import InputError
from ..files.fields import listed
from ..files.json_folder import ENDING
from ..files.kinds import Choice, Number, Text
from ..files.records import Record, declared
from ..files.safe_path import INSIDE, relative_path
from .character_words import LIMB_KEYS, PLACEMENTS, ROOT_MOTIONS

CHARACTER_ENDINGS = (".blend", ".fbx", ".glb", ".gltf", ".vrm")
"""Files that a character is read from."""
AUTO, NO_MAP = "auto", "none"
"""In place of a map: a saved one that knows the character's bones, else recognition; recognition alone."""
LARGEST_TOLERANCE_MM = 1000.0
LONGEST_NAME = 255
FILE_VALID = (
    f"the path of a character file inside the folder, ending in {', '.join(CHARACTER_ENDINGS[:-1])} or "
    f"{CHARACTER_ENDINGS[-1]}"
)
MAP_VALID = (
    "a character map's title, auto, none, or the path of a map file inside the folder, as in anna.json"
)
_FILE = re.compile(
    rf"(.*?(?:{'|'.join(map(re.escape, CHARACTER_ENDINGS))}))(?::(.*))?", re.IGNORECASE | re.DOTALL
)


@dataclass(frozen=True)
class CharacterFile:
    """A character in a file."""

    path: Path
    object: str | None = None
    """Name of its armature; None where the file has only one."""

    def __str__(self) -> str:
        """As it is typed on the command line."""
        return str(self.path) if self.object is None else f"{self.path}:{self.object}"

    @classmethod
    def parse(cls, text: str) -> "CharacterFile":
        """Read `FILE` or `FILE:OBJECT`; drive letters and colons in folders or objects are no separators.

        Raises:
            InputError: It names no file that characters are read from.
        """
        found = _FILE.fullmatch(text)
        if found is None or found[2] == "":
            raise InputError(
                f"{text}: names no character; it must be a file that ends in {listed(CHARACTER_ENDINGS)}, "
                "and after a colon the name of its armature where it has several, as in anna.blend:rig"
            )
        return cls(Path(found[1]), found[2])


@dataclass(frozen=True)
class CharacterOptions(Record):
    """How a motion is put onto a character."""

    SPARSE = False

    root_motion: Annotated[str, Choice(ROOT_MOTIONS)] = ROOT_MOTIONS[0]
    """Where the way over the ground goes; the default is as-filmed."""
    place: Annotated[str, Choice(PLACEMENTS)] = PLACEMENTS[0]
    """Where the character performs: where the performer stood, which is the default, or where it stands."""
    arms: Annotated[str, Choice(LIMB_KEYS)] = LIMB_KEYS[2]
    """Controls of the arms that are keyed; the default is both."""
    legs: Annotated[str, Choice(LIMB_KEYS)] = LIMB_KEYS[2]
    """Controls of the legs that are keyed; the default is both."""
    plant_feet: bool = True
    """Whether resting feet stay where they are; the default is true."""
    reach_hands: bool = True
    """Whether hands reach what the performer's reached; the default is true."""
    tolerance_mm: Annotated[float, Number(0.0, LARGEST_TOLERANCE_MM, "mm")] = 5.0
    """Largest distance of any joint from the motion [mm], for few keys; 0 for a key on every frame; the
    default is 5."""


@dataclass(frozen=True)
class CharacterSettings:
    """The character of a conversion."""

    file: CharacterFile
    map: str = AUTO
    """Title or path of a map, `auto` or `none`."""
    options: CharacterOptions = CharacterOptions()

    @property
    def map_file(self) -> Path | None:
        """The map's file, where it is given by path."""
        return Path(self.map) if self.map.lower().endswith(ENDING) else None


def _map_fault(text: str) -> str:
    if text.lower().endswith(ENDING):
        return relative_path(MAP_VALID).fault(text)
    return f"must be {MAP_VALID}" if any(letter in "/\\" for letter in text) else ""


_ENDINGS = "|".join("".join(f"[{one}{one.upper()}]" for one in ending[1:]) for ending in CHARACTER_ENDINGS)


@dataclass(frozen=True, kw_only=True)
class CharacterFields(CharacterOptions):
    """The character that gets the motion too, as character.blend in the results."""

    STRICT = True
    ORDER = ("file", "object", "map", *declared(CharacterOptions))

    file: Annotated[str, replace(relative_path(FILE_VALID), pattern=rf"{INSIDE[:-2]}\.({_ENDINGS})$")]
    """The character's file, relative to the folder of the file with this field and inside it: .blend, .fbx,
    .glb, .gltf or .vrm."""
    object: Annotated[str, Text(LONGEST_NAME, "the name of an armature", one_line=True)] | None = None
    """Name of the character's armature, where its file has several."""
    map: Annotated[str, Text(LONGEST_NAME, MAP_VALID, one_line=True, fault=_map_fault)] | None = None
    """Character map: its title, a file ending in .json inside the folder, auto (the default) for a saved map
    that knows the character's bones, none for recognition alone."""

    def settings(self, folder: Path, map_folder: Path) -> CharacterSettings:
        """The settings, with paths in the folders of the files that give `file` and `map`."""
        named = self.map or AUTO
        return CharacterSettings(
            CharacterFile(folder / self.file, self.object),
            str(map_folder / named) if named.lower().endswith(ENDING) else named,
            CharacterOptions(**{name: getattr(self, name) for name in declared(CharacterOptions)}),
        )
