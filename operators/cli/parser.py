"""The parser of the command line, what a command declares, and mistakes, each told in one line."""

import argparse
import importlib.util
import sys
import tomllib
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn

from ...core.errors import ConversionError
from ...core.files.paths import escape_control_characters
from .commands import SUMMARIES

ROOT = Path(__file__).resolve().parent.parent.parent


def version() -> str:
    """The version; the extension's manifest is its only source."""
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    return str(manifest["version"])


Argument = tuple[tuple[str, ...], dict[str, Any]]
"""The names and the settings of an argument."""


def argument(*names: str, **settings: Any) -> Argument:
    """An argument of a command, as `ArgumentParser.add_argument` takes it."""
    return names, settings


@dataclass(frozen=True)
class Command:
    """A command."""

    name: str
    description: str
    """What the command's own help begins with."""
    run: Callable[[argparse.Namespace], None]
    arguments: Sequence[Argument] = ()
    """Beside those that every command has."""
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
    """Refuse to replace a file unless `--replace` is given."""
    if output.exists() and not replace:
        raise UsageError(f"{output} is there already; name another file, or add --replace to replace it")


def require_blender(needing: str) -> None:
    """Refuse work that needs Blender where there is none, at once rather than after minutes."""
    if importlib.util.find_spec("bpy") is None:
        raise ConversionError(
            f"{needing} Blender: install its Python module (pip install 'keymark[blender]') "
            "or run blender --command keymark in a Blender that has Keymark"
        )


DESCRIPTION = "Turns one video of a performer, in colored markers or any clothes, into an animated armature."
EXAMPLES = """\
examples:
  {program} demo
  {program} animate clip.mp4 --height 1.78 --character anna.blend --output out/clip
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


class OneLineParser(argparse.ArgumentParser):
    """A parser that tells a mistake in one sentence and leaves the exit to its caller."""

    def error(self, message: str) -> NoReturn:
        """Raise instead of writing several lines and leaving the process."""
        raise UsageError(f"{message}; see {self.prog} --help")


def build_parser(chosen: str | None) -> argparse.ArgumentParser:
    """The parser; its result has `run`, which runs the command."""
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
        added.add_parser(WORKER).set_defaults(run=_run_worker)
    return parser


def _run_worker(_arguments: argparse.Namespace) -> None:
    import_module(".batch.worker", __package__).run_worker()


def _declared(name: str) -> Any:
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
    for names, settings in command.arguments:
        one.add_argument(*names, **settings)
    one.set_defaults(run=command.run)


def _refuse_no_command(names: Sequence[str], program: str) -> Callable[[argparse.Namespace], None]:
    valid = f"{', '.join(names[:-1])} and {names[-1]}"

    def refuse(_arguments: argparse.Namespace) -> None:
        raise UsageError(f"no command is given; {valid} are valid, see {program} --help")

    return refuse
