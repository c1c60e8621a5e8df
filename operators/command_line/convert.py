"""`keymark convert`."""

import argparse
from typing import Any

from .console import arguments_console
from .conversion import Conversion, convert
from .line_parser import UsageError
from .matching import match_summary

HIGHEST_FLOOR_M = 1000.0


def convert_command(arguments: argparse.Namespace) -> None:
    """Convert the take that the command line names, and say what was made."""
    with arguments_console(arguments) as console:
        conversion = convert(
            arguments.take,
            arguments.output,
            console,
            keyframes=arguments.keyframes,
            library=arguments.library,
            floor_m=_floor_m(arguments),
            method=arguments.method,
            pictures=not arguments.no_report,
            debug=arguments.debug,
        )
        console.finish(summary(conversion), _text(conversion))


def summary(conversion: Conversion) -> dict[str, Any]:
    """What a conversion made, for `--json`."""
    motion = conversion.reconstruction.motion
    return {
        "files": [str(file) for file in conversion.files],
        "method": motion.method,
        "frames": len(motion.time_s),
        "frame_start": motion.frame_start,
        "fps": motion.fps,
        "keyframes": [index + motion.frame_start for index in motion.keyframe_indices],
        "notes": list(conversion.notes),
        **({} if conversion.choice is None else match_summary(conversion.take, conversion.choice)),
    }


def _floor_m(arguments: argparse.Namespace) -> float | None:
    """The floor's height, if it is given and means something.

    Raises:
        UsageError: It does not.
    """
    if arguments.floor is None:
        return None
    if arguments.library is None:
        raise UsageError("--floor is given without --library; only matching asks for the floor")
    if not abs(arguments.floor) <= HIGHEST_FLOOR_M:
        raise UsageError(f"--floor is {arguments.floor:g}; a height within {HIGHEST_FLOOR_M:g} m is valid")
    return float(arguments.floor)


def _text(conversion: Conversion) -> str:
    motion = conversion.reconstruction.motion
    notes = [f"Note: {note}." for note in conversion.notes]
    count = f"{len(motion.keyframe_indices)} keyframes"
    if conversion.choice is not None:
        posed = sum(keyframe.matched is None for keyframe in conversion.take.keyframes)
        count = f"{posed} posed and {len(motion.keyframe_indices) - posed} matched keyframes"
    lines = [f"{len(motion.time_s)} frames from {count} ({motion.method}):"]
    return "\n".join([*notes, *lines, *(f"  {file}" for file in conversion.files)])
