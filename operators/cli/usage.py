"""What the parsers of all commands share: mistakes are one sentence, and every command has three options."""

import argparse
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import NoReturn

from ...core.files.control_characters import seen


class UsageError(Exception):
    """The command line is unusable; the text is one sentence."""


class LineParser(argparse.ArgumentParser):
    """A parser that says what is wrong in one line and leaves the exit to its caller."""

    def error(self, message: str) -> NoReturn:
        """Raise instead of writing several lines and leaving the process."""
        raise UsageError(f"{message}; see {self.prog} --help")


Commands = argparse._SubParsersAction  # the only name the library gives it


def program_name() -> str:
    """How the user calls this program: by its own name, or as a command of Blender."""
    blender = sys.modules.get("bpy")
    return "blender --command keymark" if blender is not None and blender.app.binary_path else "keymark"


def complain(sentence: str) -> None:
    """Write one line on standard error, whatever the sentence holds."""
    line = f"{program_name()}: {seen(' '.join(sentence.split()))}"
    encoding = sys.stderr.encoding or "utf-8"
    with suppress(OSError):  # the exit status tells, too
        print(line.encode(encoding, "backslashreplace").decode(encoding), file=sys.stderr, flush=True)


def add_command(
    commands: "Commands[LineParser]",
    name: str,
    summary: str,
    description: str,
    run: Callable[[argparse.Namespace], None],
) -> LineParser:
    """Add a command with the options that every one has.

    Args:
        commands: Where to.
        name: What the user writes.
        summary: Half a line for the list of commands.
        description: What its own help begins with.
        run: What does it; imported when it runs: --help and mistakes shall not wait for scipy and Blender.
    """
    parser = commands.add_parser(name, help=summary, description=description)
    parser.add_argument("--quiet", "-q", action="store_true", help="write nothing but errors")
    parser.add_argument("--json", action="store_true", help="write one JSON object instead of text")
    parser.add_argument("--debug", action="store_true", help="on errors, show where in the program")
    parser.set_defaults(run=run)
    return parser
