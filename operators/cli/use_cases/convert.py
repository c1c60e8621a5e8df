"""`keymark convert`: convert one take and report the result."""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ....core.pipeline.found_keyframes import found_summary
from ....core.pipeline.result import Conversion
from ....core.shoot.discovery.take_path import take_path
from ....core.take.conversion_settings import HIGHEST_FLOOR_M, ConversionSettings
from ....core.take.description import Description, describe, effective_settings
from ....core.take.evidence_kinds import KEYPOINTS
from ..console import arguments_console
from ..conversion.convert_take import convert_take
from ..usage import UsageError
from ..wanted_keyframes import wanted_keyframes


def convert_command(arguments: argparse.Namespace) -> None:
    """Convert the take that the command line names, and list the files that were made."""
    with arguments_console(arguments) as console:
        console.stage("Reading the take")
        description = describe(take_path(arguments.take))
        settings = _settings(arguments, description)
        conversion = convert_take(description, arguments.output, console, settings, arguments.debug)
        console.finish(conversion_summary(conversion), _text(conversion))


def conversion_summary(conversion: Conversion) -> dict[str, Any]:
    """The result of a conversion as an object for `--json`."""
    motion = conversion.reconstruction.motion
    return {
        "files": [str(file) for file in conversion.files],
        "method": motion.method,
        "frames": len(motion.time_s),
        "frame_start": motion.frame_start,
        "fps": motion.fps,
        "keyframes": [index + motion.frame_start for index in motion.keyframe_indices],
        "notes": list(conversion.notes),
        **({} if conversion.found is None else found_summary(conversion.take, conversion.found)),
    }


def _settings(arguments: argparse.Namespace, description: Description) -> ConversionSettings:
    """The settings of the command line, and else of the take.

    Where keyframes are to be found by the command line's word, only posed ones that it names count beside.

    Raises:
        UsageError: The options contradict each other.
    """
    keyframes, library = wanted_keyframes(arguments.keyframes, arguments.library)
    given = ConversionSettings(
        keyframes=keyframes,
        library=library,
        floor_m=arguments.floor,
        method=arguments.method,
        pictures=False if arguments.no_report else None,
        keypoints=None if arguments.keypoints is None else tuple(arguments.keypoints),
        evidence=arguments.evidence,
    )
    settings = given.with_defaults(effective_settings(description))
    _check_floor(arguments.floor, settings)
    _check_keypoints(arguments.keypoints, settings)
    return settings if library is None else replace(settings, keyframes=keyframes)


def _check_floor(floor_m: float | None, settings: ConversionSettings) -> None:
    if floor_m is None:
        return
    if settings.library is None:
        raise UsageError(
            "--floor is given without --keyframes auto or --library; the floor is asked for only where "
            "keyframes are found"
        )
    if not abs(floor_m) <= HIGHEST_FLOOR_M:
        raise UsageError(f"--floor is {floor_m:g}; a height within {HIGHEST_FLOOR_M:g} m is valid")


def _check_keypoints(files: Sequence[Path] | None, settings: ConversionSettings) -> None:
    if files and settings.evidence is not None and KEYPOINTS not in settings.evidence:
        raise UsageError(
            f"--keypoints is given, but the evidence is {', '.join(settings.evidence)} alone; name "
            f"{KEYPOINTS} in --evidence"
        )


def _text(conversion: Conversion) -> str:
    motion = conversion.reconstruction.motion
    notes = [f"Note: {note}." for note in conversion.notes]
    count = f"{len(motion.keyframe_indices)} keyframes"
    if conversion.found is not None:
        posed = sum(keyframe.matched is None for keyframe in conversion.take.keyframes)
        count = f"{posed} posed and {len(motion.keyframe_indices) - posed} found keyframes"
    lines = [f"{len(motion.time_s)} frames from {count} ({motion.method}):"]
    return "\n".join([*notes, *lines, *(f"  {file}" for file in conversion.files)])
