"""The parser of the command line, made of the commands in `commands/`."""

import argparse
from collections.abc import Callable, Sequence
from typing import NoReturn

from .command import Command, CommandGroup
from .commands import COMMANDS
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


class OneLineParser(argparse.ArgumentParser):
    """A parser that tells a mistake in one sentence and leaves the exit to its caller."""

    def error(self, message: str) -> NoReturn:
        """Raise instead of writing several lines and leaving the process."""
        raise UsageError(f"{message}; see {self.prog} --help")


def build_parser() -> argparse.ArgumentParser:
    """The parser of all commands; its result has `run`, which runs the chosen one."""
    program = program_name()
    parser = OneLineParser(
        prog=program,
        description=DESCRIPTION,
        epilog=EXAMPLES.format(program=program),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"keymark {version()}")
    _add_commands(parser, COMMANDS, program)
    return parser


def _add_commands(
    parser: argparse.ArgumentParser, commands: Sequence[Command | CommandGroup], program: str
) -> None:
    parser.set_defaults(run=_refuse_no_command(commands, program))
    added = parser.add_subparsers(metavar="COMMAND", title="commands")
    for command in commands:
        if isinstance(command, CommandGroup):
            inner = f"{program} {command.name}"
            group = added.add_parser(
                command.name,
                help=command.summary,
                description=command.description,
                epilog=command.epilog.format(program=inner),
                formatter_class=argparse.RawDescriptionHelpFormatter,
            )
            _add_commands(group, command.commands, inner)
        elif command.hidden:  # without `help`, by which argparse would list it
            _fill(added.add_parser(command.name), command)
        else:
            one = added.add_parser(command.name, help=command.summary, description=command.description)
            one.add_argument("--quiet", "-q", action="store_true", help="write nothing but errors")
            one.add_argument("--json", action="store_true", help="write one JSON object instead of text")
            one.add_argument("--debug", action="store_true", help="on errors, show where in the program")
            _fill(one, command)


def _fill(parser: argparse.ArgumentParser, command: Command) -> None:
    command.add_arguments(parser)
    parser.set_defaults(run=command.run)


def _refuse_no_command(
    commands: Sequence[Command | CommandGroup], program: str
) -> Callable[[argparse.Namespace], None]:
    """What runs where the user names none of these commands."""
    names = [command.name for command in commands if isinstance(command, CommandGroup) or not command.hidden]
    valid = f"{', '.join(names[:-1])} and {names[-1]}"

    def refuse(_arguments: argparse.Namespace) -> None:
        raise UsageError(f"no command is given; {valid} are valid, see {program} --help")

    return refuse
