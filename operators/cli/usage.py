"""Mistakes on the command line and what a command lacks, each told in one line on standard error."""

import importlib.util
import sys
from contextlib import suppress
from pathlib import Path

from ...core.errors import ConversionError
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


def refuse_existing(output: Path, replace: bool) -> None:
    """Refuse to replace a file unless `--replace` is given.

    Raises:
        UsageError: Something is there.
    """
    if output.exists() and not replace:
        raise UsageError(f"{output} is there already; name another file, or add --replace to replace it")


def require_blender(needing: str) -> None:
    """Refuse work that needs Blender where there is none, at once rather than after minutes.

    Args:
        needing: What the sentence begins with, as in `writing motion.blend needs`.

    Raises:
        ConversionError: The Python module `bpy` is missing.
    """
    if importlib.util.find_spec("bpy") is None:
        raise ConversionError(
            f"{needing} Blender: install its Python module (pip install 'keymark[blender]') "
            "or run blender --command keymark in a Blender that has Keymark"
        )
