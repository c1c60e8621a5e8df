"""What a command of the command line declares, and mistakes, each told in one line."""

import importlib.util
import sys
import tomllib
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.errors import ConversionError
from ...core.files.paths import escape_control_characters

ROOT = Path(__file__).resolve().parent.parent.parent


def version() -> str:
    """The version; the extension's manifest is its only source."""
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    return str(manifest["version"])


Argument = tuple[tuple[str, ...], dict[str, Any]]
"""The names and the settings of an argument, as `ArgumentParser.add_argument` takes them."""


def argument(usage: str, words: str, **settings: Any) -> Argument:
    """An argument, as in `argument("--output -o DIR", "folder for the result", type=Path)`.

    `usage` is what its help shows: all names, and what stands for its value. An option without is a switch.
    """
    names = usage.split()
    if not names[-1].startswith("-"):
        settings = {"metavar": names.pop()} | settings
    elif not {"action", "choices"} & settings.keys():
        settings["action"] = "store_true"
    return tuple(names), {"help": words, **settings}


@dataclass(frozen=True)
class Command:
    """A command: a function `NAME_command` of the arguments and the console, its docstring the help."""

    run: Callable[..., None]
    arguments: Sequence[Argument]
    """Beside those that every command has."""
    summary: str
    """Half a line for the list of a group; those of the other commands are in `commands/__init__.py`."""


def command(*arguments: Argument, summary: str = "") -> Callable[[Callable[..., None]], Command]:
    """Decorator that makes a command of a function."""
    return lambda run: Command(run, arguments, summary)


@dataclass(frozen=True)
class CommandGroup:
    """A command that consists of commands, by what the user types, as `keymark library` does."""

    description: str
    epilog: str
    """Below the list of commands; `{program}` stands for what the user types in front of them."""
    commands: dict[str, Command]


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
