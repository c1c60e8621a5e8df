"""By what it is known that a take has been converted already: everything the result follows from."""

import json
import os
from collections.abc import Sequence
from pathlib import Path

from ..files.digest import content_digest, digest
from ..footage.clips.image_sequence import find_images
from .conversion_settings import ConversionSettings
from .description import Description
from .shoot_file import SETTINGS

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
    said = {name: value for name, value in description.fields.values.items() if name not in SETTINGS}
    images = find_images(description.clip)
    footage = [description.clip] if images is None else images
    posed = settings.keyframes
    if posed is None and description.keyframes.exists():
        posed = description.keyframes
    return digest(
        FORMAT,
        version,
        json.dumps(said, sort_keys=True, ensure_ascii=False),
        description.name,
        _way(description.clip, output),
        tuple((file.name, content_digest(file)) for file in footage),
        None if posed is None else content_digest(posed),
        tuple(libraries),
        settings.floor_m,
        settings.method,
        settings.pictures,
    )


def _way(clip: Path, output: Path) -> str:
    try:
        return os.path.relpath(os.path.realpath(clip), os.path.realpath(output))
    except ValueError:  # another drive
        return str(clip)
