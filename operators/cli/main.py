"""The command line: `keymark ...`, `python -m keymark ...` and `blender --command keymark ...`.

Exit status: 0 done, 1 the conversion failed, 2 the input or the command line is unusable, 3 with --strict a
result's own figures are out of bounds, 130 interrupted.
On all but 0, one line on standard error says why, and the output is as it was before.
"""

import argparse
import os
import shutil
import signal
import sys
import threading
import time
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from importlib import import_module
from types import FrameType
from typing import Any, NoReturn

from ...core.errors import InputError, KeymarkError, describe_unexpected
from .blender_silence import codec_silence
from .commands import SUMMARIES
from .console import Command, Console, UsageError, argument, print_error, program_name, version

DONE, FAILED, UNUSABLE, OUT_OF_BOUNDS, INTERRUPTED = 0, 1, 2, 3, 130


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command."""
    status = _run(list(sys.argv[1:] if argv is None else argv))
    if argv is None:
        _end_process(status)
    return status


def _run(words: list[str]) -> int:
    _open_standard_streams()
    if words[:2] == ["--command", "keymark"]:  # as Blender needs it, so that farms call both programs alike
        words = words[2:]
    debug = "--debug" in words
    if "numpy" not in sys.modules:  # numpy reads these when it is loaded
        # The matrices here are small: a second thread doubles the work and saves no time.
        for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"):
            os.environ.setdefault(variable, "1")
    started = time.perf_counter()
    chosen = next((word for word in words if not word.startswith("-")), None)
    try:
        with _sigterm_as_interrupt(), codec_silence(debug):
            if words == ["worker"]:  # by which a batch starts its workers; the list of commands has it not
                import_module(".batch.worker", __package__).run_worker()
                return DONE
            arguments = build_parser(chosen).parse_args(words)
            with Console(quiet=arguments.quiet, as_json=arguments.json, started=started) as console:
                arguments.run(arguments, console)
        return OUT_OF_BOUNDS if console.warned and arguments.strict else DONE
    except SystemExit as stop:  # --help and --version
        return stop.code if isinstance(stop.code, int) else DONE
    except KeyboardInterrupt as stop:
        return _fail(str(stop) or "interrupted; nothing was written", INTERRUPTED, debug)
    except (UsageError, InputError) as error:
        return _fail(str(error), UNUSABLE, debug)
    except KeymarkError as error:
        return _fail(str(error), FAILED, debug)
    except ImportError as error:
        lacking = f"the Python module {error.name}" if error.name else "a Python module"
        return _fail(f"{lacking} cannot be loaded ({error}); install Keymark anew", FAILED, debug)
    except Exception as error:
        what = describe_unexpected(error)
        return _fail(f"failed unexpectedly ({what}); --debug shows where", FAILED, debug)


def _open_standard_streams() -> None:
    """Open the null device for standard streams that were closed when the process started.

    Else the next files to be opened got their descriptors, and Blender's messages were written into these.
    """
    for number, name, mode in ((0, "stdin", "r"), (1, "stdout", "w"), (2, "stderr", "w")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # the lowest number that is free
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))


def _fail(sentence: str, status: int, debug: bool) -> int:
    if debug:
        traceback.print_exc()
    print_error(sentence)
    return status


@contextmanager
def _sigterm_as_interrupt() -> Iterator[None]:
    """Treat SIGTERM, which render farms send, as Ctrl-C, so that the command cleans up."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def interrupt(_signal: int, _frame: FrameType | None) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _end_process(status: int) -> None:
    """End the process at once where Blender 4.5 as a module may hang, as it does after glTF; else return."""
    blender = sys.modules.get("bpy")
    if blender is None or blender.app.binary_path or blender.app.version >= (5, 0):
        return
    if not any(name.startswith("io_scene_gltf2.blender.") for name in list(sys.modules)):
        return
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError, AttributeError):
            stream.flush()
    shutil.rmtree(blender.app.tempdir, ignore_errors=True)
    os._exit(status)


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
Exit status: 0 done, 1 the conversion failed, 2 the input or the command line is unusable, 3 with --strict a
result whose own figures are out of bounds."""


class OneLineParser(argparse.ArgumentParser):
    """A parser that tells a mistake in one sentence and leaves the exit to its caller."""

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message}; see {self.prog} --help")


EVERYWHERE = (
    argument("--quiet -q", "write nothing but errors"),
    argument("--json", "write one JSON object instead of text"),
    argument("--strict", "exit with 3 where a result's own figures are bad"),
    argument("--debug", "on errors, show where in the program"),
)
"""Arguments that every command has."""


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
    added = parser.add_subparsers(metavar="COMMAND", title="commands", required=True)
    for name, summary in SUMMARIES.items():
        if name != chosen:
            added.add_parser(name, help=summary)
            continue
        found = getattr(import_module(f".commands.{name}", __package__), f"{name}_command")
        if isinstance(found, Command):
            _add_command(added, name, found, summary)
            continue
        group = added.add_parser(
            name,
            help=summary,
            description=found.description,
            epilog=found.epilog.format(program=f"{program} {name}"),
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        below = group.add_subparsers(metavar="COMMAND", title="commands", required=True)
        for inner, each in found.commands.items():
            _add_command(below, inner, each, each.summary)
    return parser


def _add_command(added: Any, name: str, command: Command, summary: str) -> None:
    one = added.add_parser(name, help=summary, description=command.run.__doc__)
    for names, settings in (*EVERYWHERE, *command.arguments):
        one.add_argument(*names, **settings)
    one.set_defaults(run=command.run)
