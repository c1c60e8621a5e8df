"""How a take is converted: the settings, each declared once for files and for the command line."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Annotated, Any

from ..errors import InputError, shown
from ..files.fields import Fields, child_location
from ..files.json_file import ENDING
from ..files.kinds import LONGEST_PATH, Choice, Items, Kind, Number, Text, Whole, relative_path
from ..files.records import Record, read_record
from ..prior.texts import EVERY_LIBRARY
from .character_settings import CharacterSettings, name_or_file_fault
from .evidence import FARTHEST_FRAME, evidence_mistake, in_order

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


class EvidenceKinds(Kind):
    """Kinds of evidence, each once."""

    valid = "a list of kinds of evidence"

    def read(self, value: Any, where: str, name: str) -> tuple[str, ...]:
        """See `Kind`."""
        mistake = evidence_mistake(value)
        if mistake is not None:
            raise InputError(f"{where}: {name} is {shown(value)}; {mistake}")
        return in_order(value)


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
    evidence: Annotated[tuple[str, ...], EvidenceKinds()] | None = None
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
