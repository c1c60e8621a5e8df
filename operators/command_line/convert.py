"""`keymark convert`."""

import argparse
from typing import Any

from .console import arguments_console
from .conversion import Conversion, convert


def convert_command(arguments: argparse.Namespace) -> None:
    """Convert the take that the command line names, and say what was made."""
    with arguments_console(arguments) as console:
        conversion = convert(
            arguments.take,
            arguments.output,
            console,
            keyframes=arguments.keyframes,
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
        "notes": list(conversion.reconstruction.notes),
    }


def _text(conversion: Conversion) -> str:
    motion = conversion.reconstruction.motion
    notes = [f"Note: {note}." for note in conversion.reconstruction.notes]
    lines = [f"{len(motion.time_s)} frames from {len(motion.keyframe_indices)} keyframes ({motion.method}):"]
    return "\n".join([*notes, *lines, *(f"  {file}" for file in conversion.files)])
