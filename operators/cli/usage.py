"""Mistakes on the command line, and the one line on standard error that every failure is told in."""

import sys
from contextlib import suppress

from ...core.files.control_characters import escape_control_characters


class UsageError(Exception):
    """The command line is unusable; the text is one sentence."""


def program_name() -> str:
    """What the user types to call this program: its own name, or that of a command of Blender."""
    blender = sys.modules.get("bpy")
    return "blender --command keymark" if blender is not None and blender.app.binary_path else "keymark"


def print_error(sentence: str) -> None:
    """Write one line on standard error, with every character in a form that it can encode."""
    line = f"{program_name()}: {escape_control_characters(' '.join(sentence.split()))}"
    encoding = sys.stderr.encoding or "utf-8"
    with suppress(OSError):  # the exit status tells, too
        print(line.encode(encoding, "backslashreplace").decode(encoding), file=sys.stderr, flush=True)
