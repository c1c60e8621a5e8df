"""What a command of the command line declares: its name, its help, its arguments and what it runs.

A command is added by a file in `commands/` and a line in `commands/__init__.py`; the parser, `--help` and the
sentence on a missing command follow from these.
"""

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass


def no_arguments(_parser: argparse.ArgumentParser) -> None:
    """The arguments of a command that has none of its own."""


@dataclass(frozen=True)
class Command:
    """A command, as its file in `commands/` declares it."""

    name: str
    """What the user types."""
    summary: str
    """Half a line for the list of commands."""
    description: str
    """What the command's own help begins with."""
    run: Callable[[argparse.Namespace], None]
    """Runs the command; imports its use case, so that `--help` waits for no scipy and no Blender."""
    add_arguments: Callable[[argparse.ArgumentParser], None] = no_arguments
    """Adds the command's own arguments to those that every command has."""
    hidden: bool = False
    """Whether `--help` leaves the command out; only Keymark itself runs it, without the common options."""


@dataclass(frozen=True)
class CommandGroup:
    """A command that consists of commands, as `keymark library` does."""

    name: str
    summary: str
    description: str
    epilog: str
    """Below the list of commands; `{program}` stands for what the user types in front of them."""
    commands: Sequence[Command]
