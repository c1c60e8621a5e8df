"""The command line: `keymark ...`, `python -m keymark ...` and `blender --command keymark ...`.

Exit status: 0 done, 1 the conversion failed, 2 the input or the command line is unusable, 130 interrupted.
On all but 0, one line on standard error says why, and the output is as it was before.
"""

import os
import shutil
import signal
import sys
import threading
import time
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from types import FrameType

from ...core.errors import InputError, KeymarkError, describe_unexpected
from .blender_silence import codec_silence
from .parser import UsageError, build_parser, print_error

BLENDER_PREFIX = ["--command", "keymark"]
"""What Blender needs before a command; accepted here too, so that farms call both programs alike."""
DONE, FAILED, UNUSABLE, INTERRUPTED = 0, 1, 2, 130
ONE_THREAD = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
"""The matrices here are small: a second thread of linear algebra doubles the work and saves no time."""
GLTF = "io_scene_gltf2.blender."
"""Beginning of the modules that glTF's importer and exporter load when they run."""
FIXED_IN = (5, 0)


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command."""
    status = _run(list(sys.argv[1:] if argv is None else argv))
    if argv is None:
        _end_process(status)
    return status


def _run(words: list[str]) -> int:
    _open_standard_streams()
    if words[: len(BLENDER_PREFIX)] == BLENDER_PREFIX:
        words = words[len(BLENDER_PREFIX) :]
    debug = "--debug" in words
    if "numpy" not in sys.modules:  # numpy reads these when it is loaded
        for variable in ONE_THREAD:
            os.environ.setdefault(variable, "1")
    started = time.perf_counter()
    chosen = next((word for word in words if not word.startswith("-")), None)
    try:
        with _sigterm_as_interrupt(), codec_silence(debug):
            arguments = build_parser(chosen).parse_args(words)
            arguments.started = started
            arguments.run(arguments)
        return DONE
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
        return _fail(
            f"failed unexpectedly ({describe_unexpected(error)}); --debug shows where", FAILED, debug
        )


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
    """End the process at once where it would wait for ever; else return.

    Blender 4.5 as a Python module may hang at its exit once it has read or written glTF.
    """
    blender = sys.modules.get("bpy")
    if blender is None or blender.app.binary_path or blender.app.version >= FIXED_IN:
        return
    if not any(name.startswith(GLTF) for name in list(sys.modules)):
        return
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError, AttributeError):
            stream.flush()
    shutil.rmtree(blender.app.tempdir, ignore_errors=True)
    os._exit(status)
