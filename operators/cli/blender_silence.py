"""Silence for C code, whose messages would mix with a command's output."""

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import TextIOWrapper


@contextmanager
def blender_silence(debug: bool) -> Iterator[None]:
    """Discard meanwhile what C code writes past Python: `--json` is to be one object."""
    _flush()
    try:
        kept = [os.dup(1), os.dup(2)]
    except OSError:  # a process without standard streams has nothing to keep clean
        yield
        return
    null = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(2 if debug else null, 1)
        if not debug:
            os.dup2(null, 2)
        # Else paths that Blender's exporters print on Windows may be what standard output cannot encode.
        stream = sys.stdout
        errors = stream.errors if isinstance(stream, TextIOWrapper) else None
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
        try:
            yield
        finally:
            if isinstance(stream, TextIOWrapper):
                stream.reconfigure(errors=errors)
    finally:
        _flush()
        for descriptor, copy in zip((1, 2), kept, strict=True):
            os.dup2(copy, descriptor)
            os.close(copy)
        os.close(null)


def _flush() -> None:
    """Flush the buffers of Python and C, which would else be written after the descriptors have changed."""
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            with suppress(OSError, ValueError):
                stream.flush()
    with suppress(OSError, AttributeError):
        library = ctypes.CDLL("ucrtbase" if os.name == "nt" else None)
        library.fflush(None)


@contextmanager
def codec_silence(debug: bool) -> Iterator[None]:
    """Discard what C code, as image decoders, writes on standard error meanwhile, but not Python's lines."""
    before, number = sys.stderr, -1
    with suppress(AttributeError, OSError, ValueError):  # a replacement without one, or a closed stream
        number = before.fileno()
    if debug or number != 2:
        yield
        return
    before.flush()
    with open(os.dup(2), "w", encoding=before.encoding, errors=before.errors, buffering=1) as own:
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, 2)
        os.close(null)
        sys.stderr = own
        try:
            yield
        finally:
            sys.stderr = before
            own.flush()
            os.dup2(own.fileno(), 2)
