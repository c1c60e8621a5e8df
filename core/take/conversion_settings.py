"""How a take is converted and put onto a character: settings, declared once for all that ask."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

from ..errors import InputError, shown
from ..files.fields import Fields, child_location, listed
from ..files.json_file import ENDING
from ..files.kinds import INSIDE, LONGEST_PATH, Choice, Items, Kind, Number, Text, Whole, relative_path
from ..files.records import Record, declared, read_record
from ..prior.texts import EVERY_LIBRARY
from .evidence import DEPTH_HINTS, EVIDENCE, FARTHEST_FRAME, KEYPOINTS


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


METHODS = ("map", "ekf", "interpolation")
"""The estimate over the whole clip, the default; the paper's Kalman filter; interpolated keyframes alone."""
HIGHEST_FLOOR_M = 1000.0
LONGEST_LIBRARY_NAME = 200
KEYFRAMES_VALID = (
    f"a path inside the take's folder, as in keyframes.json, or {EVERY_LIBRARY} to find keyframes with all "
    "libraries"
)
KEYPOINTS_VALID = "a file or folder inside the take's folder, as in keypoints.json, or a list of several"
MOST_KEYPOINT_FILES = 16
"""Sources of keypoints of one take: some detectors, tracks and clicks."""
NETWORK_VALID = "the path of a network's file, inside the folder, as in rtmw.onnx"
REFERENCE_VALID = "the path of a motion inside the take's folder, as in network.bvh"
LONGEST_SUBJECT, MOST_PEOPLE = 255, 100
LIBRARY_VALID = (
    f"a library's name, {EVERY_LIBRARY}, or the path of a library file inside the folder, as in walking.json"
)


def _library_fault(text: str) -> str:
    long = len(text) > LONGEST_LIBRARY_NAME and not text.lower().endswith(ENDING)
    return f"must be {LIBRARY_VALID}" if long else name_or_file_fault(text, LIBRARY_VALID)


class KeypointFiles(Kind):
    """A path, or a list of several."""

    valid = KEYPOINTS_VALID
    path = relative_path(KEYPOINTS_VALID)
    paths = Items("files", 1, MOST_KEYPOINT_FILES, item=path)

    def read(self, value: Any, where: str, name: str) -> tuple[Path, ...]:
        """See `Kind`."""
        if not isinstance(value, list):
            return (self.path.read(value, where, name),)
        files = self.paths.read(value, where, name)
        if len(set(files)) < len(files):
            raise InputError(f"{where}: {name} names a file twice; each counts once")
        return files


class EvidenceKinds(Items):
    """Kinds of evidence, each once."""

    def read(self, value: Any, where: str, name: str) -> tuple[str, ...]:
        """See `Kind`."""
        kinds = super().read(value, where, name)
        if DEPTH_HINTS in kinds and KEYPOINTS not in kinds:
            raise InputError(f"{where}: {name} has {DEPTH_HINTS}, guesses for {KEYPOINTS}, without these")
        return kinds


KINDS = EvidenceKinds("kinds of evidence", 1, len(EVIDENCE), unique="kind", item=Choice(EVIDENCE))
SHOT = Items(
    "frames",
    2,
    2,
    "the first and the last frame, as in [20, 86]",
    item=Whole(-FARTHEST_FRAME, FARTHEST_FRAME),
)


@dataclass(frozen=True)
class ConversionSettings(Record):
    """How a take is converted; what is None is left to the take and to Keymark."""

    keyframes: Annotated[Path, relative_path(KEYFRAMES_VALID)] | None = None
    """The keyframe file; the default is the take's keyframes.json if it exists. Or auto: keyframes are found
    in the footage with all libraries, beside those in the file."""
    library: Annotated[str, Text(LONGEST_PATH, LIBRARY_VALID, one_line=True, fault=_library_fault)] | None = (
        None
    )
    """Keyframe library to find keyframes with, beside posed ones: its name, a file ending in .json, or auto
    for all libraries, which is the same as auto in keyframes."""
    floor_m: Annotated[float, Number(-HIGHEST_FLOOR_M, HIGHEST_FLOOR_M, "m")] | None = None
    """Height of the floor [m], if known, which says best how far away the performer is; used where keyframes
    are found."""
    method: Annotated[str, Choice(METHODS)] | None = None
    """Method of the estimate: map, the default, is the whole clip at once; ekf the filter of the paper;
    interpolation the keyframes alone."""
    pictures: bool | None = None
    """Whether pictures of the result are drawn; the default is true."""
    hands: bool | None = None
    """Whether hands are looked at, so that palms face where they are seen to; the default is true."""
    character: CharacterSettings | None = None
    """The character that gets the motion too, as character.blend in the results."""
    keypoints: Annotated[tuple[Path, ...], KeypointFiles()] | None = None
    """Keypoints seen in the clip: a file of Keymark's or of a detector, the folder of a detector that writes
    a file a frame, or several of them. In shoot.json a name that every take has. The default is
    keypoints.json if it exists."""
    network: Annotated[Path, relative_path(NETWORK_VALID)] | None = None
    """A network's file, .onnx, that looks for points of the body beside Keymark's own where keypoints are
    detected."""
    evidence: Annotated[tuple[str, ...], KINDS] | None = None
    """What the motion is held against; the default is whatever the take has. Hints of depth come with
    keypoints."""
    reference: Annotated[Path, relative_path(REFERENCE_VALID)] | None = None
    """A 3D motion of the same performance from elsewhere, as a neural network's, in axes, size and time of
    its own. In shoot.json a name that every take has."""

    subject: Annotated[str, Text(LONGEST_SUBJECT, one_line=True)] | None = None
    """Whose motion of several the reference holds: a prefix of points, a BVH's ROOT or an armature."""
    shot: Annotated[tuple[int, int], SHOT] | None = None
    """First and last frame of the part of the clip that is animated; the default is all of it, or of an
    edited clip one shot."""
    performer: Annotated[int, Whole(1, MOST_PEOPLE)] | None = None
    """Who of several people performs, counted from the left where all are first seen; the default is the one
    that is posed, or the largest who is there longest."""

    def with_defaults(self, defaults: "ConversionSettings") -> "ConversionSettings":
        """These settings, and the default for each that is None."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        return replace(defaults, **{name: value for name, value in values.items() if value is not None})


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


def read_settings(description: Fields, folders: dict[str, Path]) -> ConversionSettings:
    """The settings in a take's description, with paths in the folders of the files that say them."""
    read = read_record(ConversionSettings, description)
    found: dict[str, Any] = {}
    for name in ("keyframes", "reference", "keypoints", "network", "library", "character"):
        value = getattr(read, name)
        if value is None:
            continue
        folder = folders[description.source_of(name)]
        if isinstance(value, CharacterSettings):
            fields = Fields(description.values[name], "")
            within = {child_location(location, name): each for location, each in folders.items()}
            value = value.inside(*(within.get(fields.source_of(part), Path()) for part in ("file", "map")))
        elif isinstance(value, tuple):
            value = tuple(folder / file for file in value)
        elif isinstance(value, Path):
            value = folder / value
        elif value.lower().endswith(ENDING):
            value = str(folder / value)
        found[name] = value
    return replace(read, **found)
