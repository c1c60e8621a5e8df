"""The digest of a conversion's input: a batch skips takes whose results have the same one."""

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..files.digest import content_digest, digest
from ..files.json_file import read_json
from ..prior.texts import COMPOSED, EVERY_LIBRARY
from ..video.image_sequence import find_images
from .conversion_settings import METHODS, ConversionSettings
from .description import FILE_FIELDS, SETTING_FIELDS, Description, keypoint_files

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
    keypoints = keypoint_files(description, settings)
    evidence: tuple[object, ...] = ()
    if keypoints or settings.evidence is not None:
        evidence = (tuple(_keypoints(file) for file in keypoints), settings.evidence)
    return digest(
        FORMAT,
        version,
        _take_fields(description.fields.values),
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
        *_named(settings.reference, "reference motion"),
        *_named(None if keypoints else settings.network, "network"),
    )


def _named(path: Path | None, what: str) -> tuple[object, ...]:
    """The name and the content of a file, where there is one."""
    if path is None:
        return ()
    try:
        return ((path.name, content_digest(path)),)
    except OSError as error:
        raise InputError(f"{path}: the {what} cannot be read ({error.strerror})") from error


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


def _take_fields(fields: Mapping[str, Any]) -> str:
    """The fields of the take itself as JSON; markers in their order, which is that of the results."""
    kept = {name: value for name, value in fields.items() if name not in (*FILE_FIELDS, *SETTING_FIELDS)}
    markers = kept.get("markers")
    if isinstance(markers, Mapping):
        kept["markers"] = list(markers.items())
    return json.dumps(kept, sort_keys=True, ensure_ascii=False)
