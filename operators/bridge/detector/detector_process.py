"""One run of a detector as a process: what it says, how it ends, and an end to all that it has started."""

import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from ....core.errors import InputError
from ....core.files.control_characters import escape_control_characters

GRACE_S = 3.0
"""Time that a program has to clean up after SIGTERM."""
TAIL_BYTES = 4000
"""Kept of what a program says, for its last line."""
LONGEST_REASON = 200
"""Characters of a program's own words in a sentence."""
OWN_SETTINGS = {
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "VECLIB_MAXIMUM_THREADS": "1",
    "OPENCV_FFMPEG_LOGLEVEL": "-8",
}
"""What Keymark sets for itself, and a network shall not inherit: it would run on one processor."""


class DetectorProcess:
    """A running program, in a process group of its own, whose words go into two files.

    Files rather than pipes: they need no thread, work alike on every system, and nobody waits for a
    descendant that keeps a pipe open.
    """

    def __init__(self, words: Sequence[str], folder: Path, log_folder: Path, origin: str) -> None:
        """Start the program.

        Args:
            words: Its command.
            folder: The folder it runs in.
            log_folder: Where its words are kept.
            origin: Where the command was set, for sentences.

        Raises:
            InputError: It cannot be started.
        """
        self._logs = [log_folder / "output.txt", log_folder / "errors.txt"]
        self._read = [0, 0]
        flags = 0
        if sys.platform == "win32":
            flags = subprocess.CREATE_NEW_PROCESS_GROUP | subprocess.CREATE_NO_WINDOW
        with self._logs[0].open("wb") as output, self._logs[1].open("wb") as errors:
            try:
                self._process = subprocess.Popen(
                    list(words),
                    cwd=folder,
                    stdin=subprocess.DEVNULL,
                    stdout=output,
                    stderr=errors,
                    env=_environment(os.environ),
                    start_new_session=True,
                    creationflags=flags,
                )
            except (OSError, ValueError) as error:
                reason = error.strerror if isinstance(error, OSError) else error
                raise InputError(
                    f"{origin}: the program {words[0]} cannot be started ({reason}); it must be a "
                    "program, or a script with its interpreter before it"
                ) from error

    def ended_within(self, seconds: float) -> bool:
        """Wait at most so long for the program's end; returns whether it has ended."""
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(seconds)
        return self._process.poll() is not None

    @property
    def status(self) -> int:
        """Its exit status once it has ended, negative for the signal that killed it."""
        return self._process.returncode or 0

    @property
    def said_bytes(self) -> int:
        """How much it has said so far."""
        return sum(log.stat().st_size for log in self._logs)

    def new_text(self) -> str:
        """The end of what it has said since the last call."""
        parts = []
        for index, log in enumerate(self._logs):
            size = log.stat().st_size
            parts.append(_read(log, max(self._read[index], size - TAIL_BYTES), size))
            self._read[index] = size
        return "\n".join(parts)

    @property
    def last_words(self) -> str:
        """The last line on its standard error, else on its standard output, for a sentence."""
        for log in reversed(self._logs):
            size = log.stat().st_size
            lines = [line.strip() for line in _read(log, max(0, size - TAIL_BYTES), size).splitlines()]
            lines = [line for line in lines if line]
            if lines:
                line = escape_control_characters(lines[-1])
                return line if len(line) <= LONGEST_REASON else f"{line[: LONGEST_REASON - 3]}..."
        return ""

    @property
    def ending(self) -> str:
        """How it ended, as part of a sentence."""
        reason = f" ({self.last_words})" if self.last_words else ""
        if self.status >= 0:
            return f"ended with exit status {self.status}{reason}"
        with suppress(ValueError):
            return f"was killed by {signal.Signals(-self.status).name}{reason}"
        return f"was killed by signal {-self.status}{reason}"

    def stop(self) -> None:
        """End the program and all it has started: with SIGTERM, and after a grace period with SIGKILL."""
        try:
            if self._process.poll() is None:
                self._signal("SIGTERM")
                self.ended_within(GRACE_S)
        finally:  # also where Ctrl-C is pressed again
            self._signal("SIGKILL")
            self._process.wait()

    def _signal(self, name: str) -> None:
        if sys.platform == "win32":
            if self._process.poll() is None:
                system = os.path.join(os.environ.get("SystemRoot", r"C:\Windows"), "System32")
                words = [os.path.join(system, "taskkill.exe"), "/T", "/F", "/PID", str(self._process.pid)]
                with suppress(OSError):
                    subprocess.run(words, capture_output=True, check=False, timeout=GRACE_S)
                with suppress(OSError):
                    self._process.kill()
            return
        with suppress(ProcessLookupError, PermissionError):  # the group may have ended by itself
            os.killpg(self._process.pid, getattr(signal, name))


def _environment(own: Mapping[str, str]) -> dict[str, str]:
    """The variables that the program gets."""
    kept = {name: value for name, value in own.items() if OWN_SETTINGS.get(name) != value}
    return {**kept, "PYTHONUNBUFFERED": "1"}  # so that the progress of a Python program comes as it is made


def _read(path: Path, first: int, end: int) -> str:
    with path.open("rb") as file:
        file.seek(first)
        return file.read(end - first).decode("utf-8", "replace")
