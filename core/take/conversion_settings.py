"""Settings of a conversion: keyframes, keypoints, evidence, library, floor, method, pictures, character."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..files.control_characters import is_control_character
from ..files.fields import Fields, listed
from ..files.json_file import shown
from ..files.safe_path import safe_path
from ..library.several_libraries import EVERY_LIBRARY
from .character_settings import CharacterSettings, read_character_settings
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


def read_settings(description: Fields, folders: dict[str, Path]) -> ConversionSettings:
    """The settings in a take's description.

    Args:
        description: The fields of the take, inherited ones included.
        folders: For each source of fields, the folder that its paths are relative to.

    Raises:
        InputError: A field has no valid value, or a path leaves its folder.
    """
    method = description.text("method", listed(METHODS)) if description.has("method") else None
    if method not in (None, *METHODS):
        raise InputError(
            f"{description.source_of('method')}: method is {shown(method)}; "
            f"it must be one of {listed(METHODS)}"
        )
    pictures = description.values.get("pictures")
    if pictures is not None and not isinstance(pictures, bool):
        raise InputError(
            f"{description.source_of('pictures')}: pictures is {shown(pictures)}; it must be true or false"
        )
    floor_m = None
    if description.has("floor_m"):
        floor_m = description.number("floor_m", -HIGHEST_FLOOR_M, HIGHEST_FLOOR_M, "m")
    keyframes = None
    if description.has("keyframes"):
        keyframes = safe_path(
            description, "keyframes", folders[description.source_of("keyframes")], KEYFRAMES_VALID
        )
    library = _library(description, folders)
    character = read_character_settings(description, folders)
    return ConversionSettings(
        keyframes,
        library,
        floor_m,
        method,
        pictures,
        character,
        _keypoints(description, folders),
        _evidence(description),
    )


def _keypoints(description: Fields, folders: dict[str, Path]) -> tuple[Path, ...] | None:
    if not description.has("keypoints"):
        return None
    source, value = description.source_of("keypoints"), description.values["keypoints"]
    named = value if isinstance(value, list) else [value]
    if not 1 <= len(named) <= MOST_KEYPOINT_FILES:
        raise InputError(
            f"{source}: keypoints lists {len(named)} files; it must be {KEYPOINTS_VALID}, at most "
            f"{MOST_KEYPOINT_FILES}"
        )
    folder = folders[source]
    paths = [
        safe_path(Fields({"keypoints": one}, source), "keypoints", folder, KEYPOINTS_VALID) for one in named
    ]
    if len(set(paths)) < len(paths):
        raise InputError(f"{source}: keypoints names a file twice; each counts once")
    return tuple(paths)


def _evidence(description: Fields) -> tuple[str, ...] | None:
    if not description.has("evidence"):
        return None
    kinds = description.values["evidence"]
    mistake = evidence_mistake(kinds)
    if mistake is not None:
        raise InputError(f"{description.source_of('evidence')}: evidence is {shown(kinds)}; {mistake}")
    return in_order(kinds)


def _library(description: Fields, folders: dict[str, Path]) -> str | None:
    if not description.has("library"):
        return None
    name = description.text("library", LIBRARY_VALID)
    if not name.lower().endswith(".json"):  # a name, which must not look like a path
        if len(name) > LONGEST_NAME or any(char in "/\\" or is_control_character(char) for char in name):
            raise InputError(
                f"{description.source_of('library')}: library is {shown(name)}; it must be {LIBRARY_VALID}"
            )
        return name
    return str(safe_path(description, "library", folders[description.source_of("library")], LIBRARY_VALID))
