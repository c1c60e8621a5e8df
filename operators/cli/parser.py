"""The parser of the command line, made of the commands in `commands/`."""

import argparse
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Any, NoReturn

from .command import Command, CommandGroup
from .commands import SUMMARIES
from .usage import UsageError, program_name
from .version import version

DESCRIPTION = "Turns one video of a performer, in colored markers or any clothes, into an animated armature."
EXAMPLES = """\
examples:
  {program} demo
  {program} convert takes/walk --output out/walk
  {program} convert takes/walk --output out/walk --keyframes posed.json --method ekf --json
  {program} convert takes/walk --output out/walk --library walking --floor 0
  {program} convert takes/walk --output out/walk --keypoints pose.json --evidence keypoints,contours
  {program} new shoot
  {program} check shoot
  {program} batch shoot --output out --jobs 4
  {program} merge out --output library.blend
  {program} character anna.blend --output anna.json
  {program} retarget out/walk --character anna.blend --output out/anna_walk --format fbx
  {program} detect shoot
  {program} propose takes/walk --count 12
  {program} library list

A take is a folder with take.json, the clip and keyframes.json, or a clip below a shoot.json, which tells of
many; a library takes the place of keyframes.
Exit status: 0 done, 1 the conversion failed, 2 the input or the command line is unusable."""
WORKER = "worker"
"""A command that only a batch runs."""


class OneLineParser(argparse.ArgumentParser):
    """A parser that tells a mistake in one sentence and leaves the exit to its caller."""

    def error(self, message: str) -> NoReturn:
        """Raise instead of writing several lines and leaving the process."""
        raise UsageError(f"{message}; see {self.prog} --help")


def build_parser(chosen: str | None) -> argparse.ArgumentParser:
    """The parser; its result has `run`, which runs the command.

    Args:
        chosen: The command that the line names, the only one whose arguments are known; None for no command.
    """
    program = program_name()
    parser = OneLineParser(
        prog=program,
        description=DESCRIPTION,
        epilog=EXAMPLES.format(program=program),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"keymark {version()}")
    parser.set_defaults(run=_refuse_no_command(list(SUMMARIES), program))
    added = parser.add_subparsers(metavar="COMMAND", title="commands")
    for name, summary in SUMMARIES.items():
        if name == chosen:
            _add_command(added, _declared(name), summary, program)
        else:
            added.add_parser(name, help=summary)
    if chosen == WORKER:  # without `help`, by which argparse would list it
        added.add_parser(WORKER).set_defaults(run=_declared(WORKER).run)
    return parser


def _declared(name: str) -> Any:
    """What the file of a command declares."""
    return getattr(import_module(f".commands.{name}", __package__), name.upper())


def _add_command(added: Any, command: Command | CommandGroup, summary: str, program: str) -> None:
    one = added.add_parser(
        command.name,
        help=summary,
        description=command.description,
        formatter_class=argparse.RawDescriptionHelpFormatter
        if isinstance(command, CommandGroup)
        else argparse.HelpFormatter,
    )
    if isinstance(command, CommandGroup):
        inner = f"{program} {command.name}"
        one.epilog = command.epilog.format(program=inner)
        one.set_defaults(run=_refuse_no_command([each.name for each in command.commands], inner))
        below = one.add_subparsers(metavar="COMMAND", title="commands")
        for each in command.commands:
            _add_command(below, each, each.summary, inner)
        return
    one.add_argument("--quiet", "-q", action="store_true", help="write nothing but errors")
    one.add_argument("--json", action="store_true", help="write one JSON object instead of text")
    one.add_argument("--debug", action="store_true", help="on errors, show where in the program")
    command.add_arguments(one)
    one.set_defaults(run=command.run)


def _refuse_no_command(names: Sequence[str], program: str) -> Callable[[argparse.Namespace], None]:
    """What runs where the user names none of these commands."""
    valid = f"{', '.join(names[:-1])} and {names[-1]}"

    def refuse(_arguments: argparse.Namespace) -> None:
        raise UsageError(f"no command is given; {valid} are valid, see {program} --help")

    return refuse
