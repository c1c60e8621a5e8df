"""What commands of the command line declare, and how they speak: mistakes, progress and results."""

import importlib.util
import json
import os
import sys
import time
import tomllib
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from shutil import get_terminal_size
from textwrap import wrap
from typing import Any

from ...core.errors import ConversionError
from ...core.files.paths import escape_control_characters
from ...core.progress import Progress

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


FEWEST_COLUMNS = 60
"""Narrower terminals are wrapped as if they had this many."""
JOB_SHARE = 0.9
"""Share of a command's progress that the job has; the rest is writing files."""


def terminal_columns() -> int | None:
    """Width of the terminal; None where standard output is none, and sentences stay whole."""
    if sys.stdout is None or not sys.stdout.isatty():
        return None
    return get_terminal_size().columns


def wrapped(sentence: str, indent: int, columns: int | None) -> list[str]:
    """A sentence broken into lines between words; all but the first are indented by two columns more."""
    begin = " " * indent
    if columns is None or indent + len(sentence) <= columns:
        return [begin + sentence]
    return wrap(
        sentence,
        max(columns, FEWEST_COLUMNS),
        initial_indent=begin,
        subsequent_indent=f"{begin}  ",
        break_long_words=False,
        break_on_hyphens=False,
    )


class _OpenjdBar:
    """Lines of Open Job Description, which render farms read, by the interface of a tqdm bar."""

    def __init__(self, write: Callable[[str], object]) -> None:
        self.n = 0.0
        self._write = write
        self._text, self._percent = "", -1

    def set_description(self, text: str, refresh: bool = True) -> None:
        if text != self._text:
            self._text = text
            self._write(f"openjd_status: {text}")

    def update(self, more: float) -> None:
        self.n += more
        percent = min(int(self.n), 100)
        if percent > self._percent:
            self._percent = percent
            self._write(f"openjd_progress: {percent}")

    def clear(self) -> None:
        """Nothing stands before a line of text."""

    refresh = close = clear


class Console:
    """Progress, text and results of one command, as its options ask for; also times its stages.

    On a terminal progress is a bar on standard error, where tqdm is installed; else a line of text for each
    stage, or the lines that a render farm asks for. With `--json` standard output gets one object and nothing
    else, with `--quiet` nothing at all.
    """

    def __init__(self, *, quiet: bool, as_json: bool, started: float | None = None) -> None:
        self.quiet, self.as_json = quiet, as_json
        self.warned = False  # whether a result is there whose own figures are out of bounds
        self.seconds: dict[str, float] = {}
        """Time spent in each stage so far [s]."""
        self._stage = "Starting"
        self._overall = ""
        self._since = time.perf_counter() if started is None else started
        self._bar: Any = None if quiet else _bar()
        if os.environ.get("KEYMARK_PROGRESS") == "openjd" and not quiet and not as_json:
            self._bar = _OpenjdBar(self._write)

    def __enter__(self) -> "Console":
        return self

    def __exit__(self, *_error: object) -> None:
        self._close_bar()

    def progress(self, progress: Progress) -> None:
        if progress.stage != self._stage and progress.fraction < 1.0:
            self.stage(progress.stage)
        if self._bar is not None:
            self._bar.update(max(0.0, 100.0 * JOB_SHARE * progress.fraction - self._bar.n))

    def stage(self, name: str) -> None:
        """Begin a stage; the time until the next one counts as its time."""
        if name == self._stage:
            return
        self._stop()
        self._stage = name
        if self._bar is not None:
            self._bar.set_description(name)
        elif name and not self.quiet and not self.as_json:
            self._write(f"{name} ...")

    def overall(self, fraction: float, name: str) -> None:
        """Show the progress of many jobs together, 0 to 1, with a few words on their state."""
        if self._bar is not None:
            self._bar.set_description(name, refresh=name != self._overall)
            self._overall = name
            self._bar.update(max(0.0, 100.0 * fraction - self._bar.n))

    def take_line(self, text: str, error: str | None) -> None:
        """Write a line on the outcome of one of many takes; with `--quiet` only an error."""
        if self.quiet and not self.as_json and error is not None:
            print_error(error)
        self.announce(" ".join(text.split("\n")))

    def announce(self, text: str) -> None:
        """Write a line at once, before the result; nothing with `--json` or `--quiet`."""
        if self.as_json or self.quiet:
            return
        if self._bar is not None:
            self._bar.clear()
        self._write("\n".join(wrapped(text, 0, terminal_columns())))
        if self._bar is not None:
            self._bar.refresh()

    def finish(self, result: dict[str, Any], text: str) -> None:
        """Write the result: the object with `--json`, else the text."""
        self._stop()
        self._close_bar()
        if self.as_json:
            seconds = {name: round(value, 3) for name, value in self.seconds.items()}
            seconds["total"] = round(sum(self.seconds.values()), 3)
            self._write(json.dumps({**result, "seconds": seconds}, allow_nan=False))
        elif not self.quiet:
            self._write(text)

    def warn(self, sentences: Sequence[str]) -> None:
        """Write what is not right with a result that is there, each on a line of standard error."""
        for sentence in sentences:
            self.warned = True
            print_error(sentence)

    def _stop(self) -> None:
        now = time.perf_counter()
        if self._stage:
            self.seconds[self._stage] = self.seconds.get(self._stage, 0.0) + now - self._since
        self._stage, self._since = "", now

    def _close_bar(self) -> None:
        if self._bar is not None:
            self._bar.close()
            self._bar = None

    def _write(self, text: str) -> None:
        """Write a line; where pipe, disk or terminal is gone, write nothing more and go on with the work."""
        encoding = sys.stdout.encoding or "utf-8"
        try:
            print(text.encode(encoding, "backslashreplace").decode(encoding), flush=True)
        except OSError as error:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            if self.as_json and not isinstance(error, BrokenPipeError):
                reason = error.strerror or error
                raise ConversionError(
                    f"standard output cannot be written ({reason}); the result is not told, the rest is done"
                ) from error


def _bar() -> Any:
    if sys.stderr is None or not sys.stderr.isatty():
        return None
    try:
        from tqdm import tqdm
    except ImportError:  # not among the extension's wheels
        return None
    return tqdm(
        total=100.0, leave=False, file=sys.stderr, bar_format="{desc}{percentage:3.0f}% |{bar}| {elapsed}"
    )
