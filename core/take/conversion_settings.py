"""How a take is converted: the settings, the fields that say them, and the character that gets the motion."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Annotated, Any

from ..errors import InputError, shown
from ..files.fields import Fields, child_location, listed
from ..files.json_file import ENDING
from ..files.kinds import INSIDE, LONGEST_PATH, Choice, Items, Kind, Number, Text, relative_path
from ..files.records import Record, declared, read_record
from ..prior.texts import EVERY_LIBRARY
from .evidence import evidence_mistake, in_order

METHODS = ("map", "ekf", "interpolation")
"""The estimate over the whole clip, the default; the paper's Kalman filter; interpolated keyframes alone."""


ROOT_MOTIONS = ("as-filmed", "in-place", "root-bone")
PLACEMENTS = ("performer", "character")
LIMB_KEYS = ("fk", "ik", "both")
"""The options of `core/retarget/options` are called the same, with underscores."""


CHARACTER_ENDINGS = (".blend", ".fbx", ".glb", ".gltf", ".vrm")
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
        return str(self.path) if self.object is None else f"{self.path}:{self.object}"

    @classmethod
    def parse(cls, text: str) -> "CharacterFile":
        """Read `FILE` or `FILE:OBJECT`; drive letters and colons in folders or objects are no separators."""
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


HIGHEST_FLOOR_M = 1000.0
KEYFRAMES_VALID = (
    f"a path inside the take's folder, as in keyframes.json, or {EVERY_LIBRARY} to find keyframes with all "
    "libraries"
)
KEYPOINTS_VALID = "a file or folder inside the take's folder, as in keypoints.json, or a list of several"
MOST_KEYPOINT_FILES = 16
"""Sources of keypoints of one take: some detectors, tracks and clicks."""
REFERENCE_VALID = "the path of a motion inside the take's folder, as in network.bvh"
LIBRARY_VALID = (
    f"a library's name, {EVERY_LIBRARY}, or the path of a library file inside the folder, as in walking.json"
)


@dataclass(frozen=True)
class ConversionSettings:
    """Settings; those that are None are left to the take and to Keymark."""

    keyframes: Path | None = None
    """The keyframe file; by default the take's own where it exists."""
    library: str | None = None
    """Name or file of the library to find keyframes with, `EVERY_LIBRARY` for all of them; None where all
    keyframes are posed."""
    floor_m: float | None = None
    """Height of the floor where it is known [m]; for finding keyframes."""
    method: str | None = None
    pictures: bool | None = None
    character: CharacterSettings | None = None
    keypoints: tuple[Path, ...] | None = None
    """Files or folders of keypoints; by default the take's own where it has some."""
    evidence: tuple[str, ...] | None = None
    """Kinds of evidence that are used, in the order of `EVIDENCE`; None for whatever the take has."""
    reference: Path | None = None
    """The file of a motion from elsewhere that is evidence too."""

    def with_defaults(self, defaults: "ConversionSettings") -> "ConversionSettings":
        """These settings, and the default for each that is None."""
        merged = {}
        for field in fields(self):
            own = getattr(self, field.name)
            merged[field.name] = getattr(defaults, field.name) if own is None else own
        return ConversionSettings(**merged)


NO_SETTINGS = ConversionSettings()


def with_auto_as_library(
    values: Mapping[str, Any], inherited: Mapping[str, Any], location: str
) -> dict[str, Any]:
    """A file's fields, where `"keyframes": "auto"` has become `"library": "auto"`, which is the same."""
    fields, keyframes, library = dict(values), values.get("keyframes"), values.get("library")
    if keyframes == EVERY_LIBRARY:
        if library not in (None, EVERY_LIBRARY):
            raise InputError(
                f"{location}: keyframes is {shown(keyframes)} and library is {shown(library)}; "
                "the first finds keyframes with all libraries, the second with one: give one of them"
            )
        del fields["keyframes"]
        fields["library"] = EVERY_LIBRARY
    elif "keyframes" in values and keyframes is None and inherited.get("library") == EVERY_LIBRARY:
        fields.setdefault("library", None)
    return fields


def _library_fault(text: str) -> str:
    if text.lower().endswith(".json"):
        return relative_path(LIBRARY_VALID).fault(text)
    odd = len(text) > 200 or any(letter in "/\\" for letter in text)
    return f"must be {LIBRARY_VALID}" if odd else ""


LibraryName = Annotated[str, Text(LONGEST_PATH, LIBRARY_VALID, one_line=True, fault=_library_fault)]


class KeypointFiles(Kind):
    """A path, or a list of several."""

    valid = KEYPOINTS_VALID
    path = relative_path(KEYPOINTS_VALID)
    paths = Items("files", 1, MOST_KEYPOINT_FILES, item=path)

    def read(self, value: Any, where: str, name: str) -> tuple[str, ...]:
        """See `Kind`."""
        if not isinstance(value, list):
            return (self.path.read(value, where, name),)
        files = self.paths.read(value, where, name)
        if len(set(map(Path, files))) < len(files):
            raise InputError(f"{where}: {name} names a file twice; each counts once")
        return files


class EvidenceKinds(Kind):
    """Kinds of evidence, each once."""

    valid = "a list of kinds of evidence"

    def read(self, value: Any, where: str, name: str) -> tuple[str, ...]:
        """See `Kind`."""
        mistake = evidence_mistake(value)
        if mistake is not None:
            raise InputError(f"{where}: {name} is {shown(value)}; {mistake}")
        return in_order(value)


@dataclass(frozen=True)
class SettingsFields(Record):
    """The fields of a take that say how it is converted."""

    keyframes: Annotated[str, relative_path(KEYFRAMES_VALID)] | None = None
    """The keyframe file, relative to the take's folder and inside it; the default is keyframes.json if it
    exists. Or auto: keyframes are found in the footage with all libraries, beside those in the file."""
    keypoints: Annotated[tuple[str, ...], KeypointFiles()] | None = None
    """Keypoints seen in the clip: a file of Keymark's or of a detector, the folder of a detector that writes
    a file a frame, or a list of several; relative to the take's folder and inside it. In shoot.json a name
    that every take has. The default is keypoints.json if it exists."""
    evidence: Annotated[tuple[str, ...], EvidenceKinds()] | None = None
    """What the motion is held against; the default is whatever the take has. Hints of depth come with
    keypoints."""
    reference: Annotated[str, relative_path(REFERENCE_VALID)] | None = None
    """A 3D motion of the same performance from elsewhere, as a neural network's, in axes, size and time of
    its own; relative to the take's folder and inside it. In shoot.json a name that every take has."""
    library: LibraryName | None = None
    """Keyframe library to find keyframes with, beside posed ones: its name, a file ending in .json below the
    folder of the file with this field, or auto for all libraries, which is the same as auto in keyframes."""
    floor_m: Annotated[float, Number(-HIGHEST_FLOOR_M, HIGHEST_FLOOR_M, "m")] | None = None
    """Height of the floor [m], if known; used where keyframes are found."""
    method: Annotated[str, Choice(METHODS)] | None = None
    """Method of the estimate; the default is map."""
    pictures: bool | None = None
    """Whether pictures of the result are drawn; the default is true."""
    character: CharacterFields | None = None
    """The character that gets the motion too, as character.blend in the results."""


def read_settings(description: Fields, folders: dict[str, Path]) -> ConversionSettings:
    """The settings in a take's description."""
    said = read_record(SettingsFields, description)

    def inside(name: str) -> Path:
        return folders[description.source_of(name)]

    library, character = said.library, None
    if library is not None and library.lower().endswith(".json"):
        library = str(inside("library") / library)
    if said.character is not None:
        fields = Fields(description.values["character"], "")
        bases = {child_location(location, "character"): folder for location, folder in folders.items()}
        character = said.character.settings(
            bases[fields.source_of("file")], bases.get(fields.source_of("map"), Path())
        )
    return ConversionSettings(
        None if said.keyframes is None else inside("keyframes") / said.keyframes,
        library,
        said.floor_m,
        said.method,
        said.pictures,
        character,
        None if said.keypoints is None else tuple(inside("keypoints") / file for file in said.keypoints),
        said.evidence,
        None if said.reference is None else inside("reference") / said.reference,
    )
