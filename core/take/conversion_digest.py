"""By what it is known that a take has been converted already: everything the result follows from."""

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..files.digest import content_digest, digest
from ..footage.clips.image_sequence import find_images
from .conversion_settings import ConversionSettings
from .description import Description
from .methods import METHODS
from .shoot_file import FILE_FIELDS, SETTING_FIELDS

FORMAT = 1
"""Raised whenever the same input gives another result without a new version."""


def conversion_digest(
    description: Description,
    settings: ConversionSettings,
    libraries: Sequence[str],
    output: Path,
    version: str,
) -> str:
    """A digest that changes with everything a conversion depends on, and with nothing else.

    Files count by what is in them, never by when they were changed: clocks differ, copies keep no times.

    Args:
        description: The take's.
        settings: How it is converted.
        libraries: Digests of what each library to match with holds.
        output: Where results go: a .blend holds the way from there to its clip.
        version: Keymark's.

    Raises:
        InputError: A file cannot be read.
    """
    try:
        images = find_images(description.clip)
    except OSError as error:
        raise InputError(f"{description.clip}: the clip cannot be read ({error.strerror})") from error
    footage = [description.clip] if images is None else images
    posed = settings.keyframes
    if posed is None and os.path.exists(description.keyframes):
        posed = description.keyframes
    return digest(
        FORMAT,
        version,
        _said(description.fields.values),
        description.name,
        _way(description.clip, output),
        tuple((file.name, content_digest(file)) for file in footage),
        None if posed is None else content_digest(posed),
        tuple(libraries),
        settings.floor_m if libraries else None,
        settings.method or METHODS[0],
        settings.pictures is not False,
    )


def _said(fields: Mapping[str, Any]) -> str:
    """What is said of the take itself; of its markers also in which order, which is that of the results."""
    said = {name: value for name, value in fields.items() if name not in (*FILE_FIELDS, *SETTING_FIELDS)}
    markers = said.get("markers")
    if isinstance(markers, Mapping):
        said["markers"] = list(markers.items())
    return json.dumps(said, sort_keys=True, ensure_ascii=False)


def _way(clip: Path, output: Path) -> str:
    try:
        return os.path.relpath(os.path.realpath(clip), os.path.realpath(output))
    except ValueError:  # another drive
        return str(clip)
