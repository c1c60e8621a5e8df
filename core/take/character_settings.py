"""The character that a take's motion is put onto: its file, its map, and how, in the words of files."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from ..errors import InputError
from ..files.control_characters import is_control_character
from ..files.fields import Fields, listed
from ..files.inherited_fields import child_location
from ..files.json_file import shown
from ..files.json_folder import ENDING
from ..files.records import Choice, Number, Record, read_record
from ..files.safe_path import safe_path
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
FIELDS = (
    *("file", "object", "map", "root_motion", "place", "arms", "legs", "plant_feet", "reach_hands"),
    "tolerance_mm",
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


def read_character_settings(
    description: Fields, folders: Mapping[str, Path], name: str = "character"
) -> CharacterSettings | None:
    """The character in a take's description; None where there is none.

    Args:
        description: The fields of the take, inherited ones included.
        folders: For each source of fields, the folder that its paths are relative to.
        name: The field.

    Raises:
        InputError: A field has no valid value, or a path leaves its folder.
    """
    if not description.has(name):
        return None
    fields = description.child(name, "an object with file")
    fields.refuse_others(FIELDS)
    bases = {child_location(location, name): folder for location, folder in folders.items()}
    file = safe_path(fields, "file", bases[fields.source_of("file")], FILE_VALID)
    if file.suffix.lower() not in CHARACTER_ENDINGS:
        raise InputError(
            f"{fields.source_of('file')}: file is {shown(fields.values['file'])}; it must be {FILE_VALID}"
        )
    return CharacterSettings(
        CharacterFile(
            file, _line(fields, "object", "the name of an armature") if fields.has("object") else None
        ),
        _map(fields, bases) if fields.has("map") else AUTO,
        read_record(CharacterOptions, fields),
    )


def _line(fields: Fields, name: str, valid: str) -> str:
    text = fields.text(name, valid)
    if len(text) > LONGEST_NAME or any(map(is_control_character, text)):
        raise InputError(f"{fields.source_of(name)}: {name} is {shown(text)}; it must be {valid}")
    return text


def _map(fields: Fields, bases: Mapping[str, Path]) -> str:
    text = _line(fields, "map", MAP_VALID)
    if text.lower().endswith(ENDING):
        return str(safe_path(fields, "map", bases[fields.source_of("map")], MAP_VALID))
    if any(letter in "/\\" for letter in text):
        raise InputError(f"{fields.source_of('map')}: map is {shown(text)}; it must be {MAP_VALID}")
    return text
