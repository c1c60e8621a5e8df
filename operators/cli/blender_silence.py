"""Keeping Blender's own messages out of what a command says."""

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import TextIOWrapper
from typing import Any


@contextmanager
def blender_silence(debug: bool) -> Iterator[None]:
    """Send what C code writes meanwhile on standard output and error to nowhere.

    Blender writes past Python, on the file descriptors themselves: to a reader of one JSON object its
    chatter would be an error.

    Args:
        debug: Whether to let the chatter through, on standard error.
    """
    _flush()
    try:
        kept = [os.dup(1), os.dup(2)]
    except OSError:  # a process without standard streams has nothing to keep clean
        yield
        return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(2 if debug else nowhere, 1)
        if not debug:
            os.dup2(nowhere, 2)
        with _any_letters():
            yield
    finally:
        _flush()
        for descriptor, copy in zip((1, 2), kept, strict=True):
            os.dup2(copy, descriptor)
            os.close(copy)
        os.close(nowhere)


@contextmanager
def _any_letters() -> Iterator[None]:
    """Let every letter be printed: Blender's exporters print paths, which a pipe on Windows may not take."""
    stream = sys.stdout
    if not isinstance(stream, TextIOWrapper):
        yield
        return
    errors = stream.errors
    stream.reconfigure(errors="backslashreplace")
    try:
        yield
    finally:
        stream.reconfigure(errors=errors)


def _flush() -> None:
    """Empty Python's buffers and C's, which would else be written later, elsewhere."""
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            with suppress(OSError, ValueError):
                stream.flush()
    with suppress(OSError, AttributeError):
        library = ctypes.CDLL("ucrtbase" if os.name == "nt" else None)
        library.fflush(None)


@contextmanager
def codec_silence(debug: bool) -> Iterator[None]:
    """Send what C code writes meanwhile on standard error to nowhere; Python's own words still come through.

    Decoders of images complain of damaged ones there, where our one sentence shall stand.

    Args:
        debug: Whether to let the complaints through.
    """
    if debug or not _is_descriptor(sys.stderr, 2):
        yield
        return
    before = sys.stderr
    before.flush()
    with open(os.dup(2), "w", encoding=before.encoding, errors=before.errors, buffering=1) as own:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 2)
        os.close(nowhere)
        sys.stderr = own
        try:
            yield
        finally:
            sys.stderr = before
            own.flush()
            os.dup2(own.fileno(), 2)


def _is_descriptor(stream: Any, number: int) -> bool:
    try:
        return bool(stream.fileno() == number)
    except (AttributeError, OSError, ValueError):  # a stand-in, or closed
        return False
