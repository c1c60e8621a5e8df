"""Settings of a conversion: keyframes, keypoints, evidence, library, floor, method, pictures, character."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated, Any

from ..errors import InputError
from ..files.fields import Fields
from ..files.inherited_fields import child_location
from ..files.json_file import shown
from ..files.kinds import Choice, Items, Kind, Number, Text
from ..files.records import Record, read_record
from ..files.safe_path import LONGEST_PATH, relative_path
from ..library.several_libraries import EVERY_LIBRARY
from .character_settings import CharacterFields, CharacterSettings
from .evidence_kinds import evidence_mistake, in_order
from .methods import METHODS

HIGHEST_FLOOR_M = 1000.0
LONGEST_NAME = 200
KEYFRAMES_VALID = (
    f"a path inside the take's folder, as in keyframes.json, or {EVERY_LIBRARY} to find keyframes with all "
    "libraries"
)
KEYPOINTS_VALID = "a file or folder inside the take's folder, as in keypoints.json, or a list of several"
MOST_KEYPOINT_FILES = 16
"""Sources of keypoints of one take: some detectors, tracks and clicks."""
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
    """`map` (the default), `ekf` or `interpolation`."""
    pictures: bool | None = None
    """Whether to draw the report; by default it is drawn."""
    character: CharacterSettings | None = None
    """The character that gets the motion too; None for none."""
    keypoints: tuple[Path, ...] | None = None
    """Files or folders of keypoints; by default the take's own where it has some."""
    evidence: tuple[str, ...] | None = None
    """Kinds of evidence that are used, in the order of `EVIDENCE`; None for whatever the take has."""

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
    """The fields of one file, where `"keyframes": "auto"` has become `"library": "auto"`, which is the same.

    Args:
        values: The fields as the file has them.
        inherited: Those that they override.
        location: The file, for sentences.

    Raises:
        InputError: The file also names a library, which is another question.
    """
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
    path_like = len(text) > LONGEST_NAME or any(letter in "/\\" for letter in text)
    return f"must be {LIBRARY_VALID}" if path_like else ""


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
    """The settings in a take's description.

    Args:
        description: The fields of the take, inherited ones included.
        folders: For each source of fields, the folder that its paths are relative to.

    Raises:
        InputError: A field has no valid value, or a path leaves its folder.
    """
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
    )
