"""What a command of the command line declares: its help, its arguments and what it runs.

A command is added by a file in `commands/`, in which it has the file's name in capitals, and a line in
`commands/__init__.py`; the parser, `--help` and the sentence on a missing command follow from these.
"""

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass


def no_arguments(_parser: argparse.ArgumentParser) -> None:
    """The arguments of a command that has none of its own."""


@dataclass(frozen=True)
class Command:
    """A command."""

    name: str
    """What the user types."""
    description: str
    """What the command's own help begins with."""
    run: Callable[[argparse.Namespace], None]
    add_arguments: Callable[[argparse.ArgumentParser], None] = no_arguments
    """Adds the command's own arguments to those that every command has."""
    summary: str = ""
    """Half a line for the list of a group; those of the other commands are in `commands/__init__.py`."""


@dataclass(frozen=True)
class CommandGroup:
    """A command that consists of commands, as `keymark library` does."""

    name: str
    description: str
    epilog: str
    """Below the list of commands; `{program}` stands for what the user types in front of them."""
    commands: Sequence[Command]
