"""What a detector has written into its folder: one keypoint file, or one folder with a file a frame."""

import os
from pathlib import Path

from ....core.errors import ConversionError, InputError
from ....core.files.fields import listed

OUTPUT_NAME = "keypoints.json"
"""The file that `{output}` stands for."""
LARGEST_BYTES = 4 * 2**30
"""Of all that a detector writes: hours of drawn video fit, a program that never stops writing does not."""
MOST_FILES = 200_000
"""Files and folders; the longest clips have a fifth as many frames."""
MOST_NAMED = 4


def folder_excess(folder: Path) -> str:
    """By what a folder is too large, as part of a sentence; empty where it is not."""
    size = count = 0
    for place, below, files in os.walk(folder):
        count += len(below) + len(files)
        if count > MOST_FILES:
            return f"more than {MOST_FILES} files"
        for name in files:
            try:
                size += os.lstat(os.path.join(place, name)).st_size
            except OSError:  # it was only for a while
                continue
        if size > LARGEST_BYTES:
            return f"more than {LARGEST_BYTES // 2**30} GiB"
    return ""


def find_output(folder: Path, detector: str, clip: Path) -> Path:
    """The keypoint file that a detector wrote, or the folder of its files.

    Args:
        folder: The detector's own folder, links resolved.
        detector: Its name, for sentences.
        clip: The clip, for sentences.

    Raises:
        ConversionError: There is none.
        InputError: There are several, or one leads out of the folder by a link.
    """
    named = folder / OUTPUT_NAME
    if os.path.lexists(named):
        found = named
    else:
        holding = _folders_with_json(folder)
        if not holding:
            raise ConversionError(
                f"{clip}: the detector {detector} ended well and wrote no keypoints; its command must "
                "hand it {output}, the file to write, or {output_folder}"
            )
        if len(holding) > 1:
            names = [str(place.relative_to(folder)) for place in holding]
            raise InputError(
                f"{clip}: the detector {detector} wrote JSON files into several folders "
                f"({listed(names, MOST_NAMED)}); one of them must be left out by its options"
            )
        files = _json_files(holding[0])
        found = files[0] if len(files) == 1 else holding[0]
    for file in (found, *(_json_files(found) if found.is_dir() else ())):
        real = Path(os.path.realpath(file))
        if not real.is_relative_to(folder):
            raise InputError(
                f"{clip}: the detector {detector} wrote {file.relative_to(folder)} as a link to {real}; "
                "it must write a file"
            )
    return found


def _json_files(folder: Path) -> list[Path]:
    return sorted(file for file in folder.iterdir() if file.suffix.lower() == ".json")


def _folders_with_json(folder: Path) -> list[Path]:
    """The folders, the given one among them, that hold JSON files themselves."""
    return sorted(
        Path(place)
        for place, _, files in os.walk(folder)
        if any(name.lower().endswith(".json") for name in files)
    )
