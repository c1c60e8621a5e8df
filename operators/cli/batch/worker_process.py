"""A worker as its batch sees it, and the JSON Lines between them: jobs one way, messages the other."""

import json
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, fields
from math import inf
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from ....core.shoot.discovery import ShootTake
from ....core.take.conversion_settings import ConversionSettings
from ..command import program_name

LONGEST_BYTES = 2**22
"""Of a line: a list of takes may hold a megabyte on one of them."""
CONVERTED, UNCHANGED, FAILED, BUSY = "converted", "unchanged", "failed", "busy"


@dataclass(frozen=True, eq=False)
class Job:
    """One take to convert."""

    take: ShootTake
    folder: Path
    defaults: ConversionSettings
    """Settings where the take and its shoots give none."""
    again: bool = False
    debug: bool = False

    def to_line(self) -> bytes:
        """Encode the job as a line."""
        return _line(asdict(self))

    @classmethod
    def from_line(cls, line: bytes) -> "Job":
        """Decode a job, which a batch has encoded."""
        value = json.loads(line)
        take, defaults = value["take"], value["defaults"]
        defaults["keyframes"] = defaults["keyframes"] and Path(defaults["keyframes"])
        defaults["keypoints"] = defaults["keypoints"] and tuple(map(Path, defaults["keypoints"]))
        defaults["network"] = defaults["network"] and Path(defaults["network"])
        defaults["evidence"] = defaults["evidence"] and tuple(defaults["evidence"])
        return cls(
            take=ShootTake(**{**take, "path": Path(take["path"])}),
            folder=Path(value["folder"]),
            defaults=ConversionSettings(**defaults),
            again=value["again"],
            debug=value["debug"],
        )


@dataclass(frozen=True)
class Ready:
    """A worker has started and accepts jobs."""


@dataclass(frozen=True)
class Step:
    """The progress of a job; also the heartbeat by which a worker shows that it is alive."""

    stage: str
    fraction: float


@dataclass(frozen=True)
class Done:
    """A job has ended."""

    result: str
    """`converted`, `unchanged`, `failed`, or `busy` where another process holds the lock of the results."""
    seconds: float = 0.0
    error: str | None = None
    kind: str | None = None
    """Kind of failure, see `core/shoot/outcomes`."""
    memory_bytes: int | None = None
    """Resident memory of the worker after the job; None where the system does not tell."""


Message = Ready | Step | Done
MESSAGES: dict[str, type[Ready] | type[Step] | type[Done]] = {"ready": Ready, "step": Step, "done": Done}


def message_line(message: Message) -> bytes:
    """Encode a message as a line."""
    return _line({type(message).__name__.lower(): asdict(message)})


def read_message(line: bytes) -> Message | None:
    """Decode a message; None for any other line, as those that Blender prints while it starts."""
    try:
        ((name, said),) = json.loads(line).items()
        kind = MESSAGES[name]
        return kind(**{field.name: said[field.name] for field in fields(kind)})
    except (ValueError, AttributeError, KeyError, TypeError):
        return None


def _line(value: Any) -> bytes:
    return json.dumps(value, default=str).encode("ascii") + b"\n"


SCRIPT = Path(__file__).with_name("machine_resources.py")
START_TIMEOUT_S = 300.0
HEARTBEAT_TIMEOUT_S = 1800.0
"""A worker that sends no message for so long will never end: its decoder or its disk hangs."""
TERMINATION_GRACE_S = 10.0
"""Time that a worker has to clean up after SIGTERM."""
STDERR_TAIL_BYTES = 2000
"""Read of what a worker has written on standard error, to say why it ended."""


def worker_command_line() -> list[str]:
    """The command that starts a worker in the same kind of process as this one: Python or Blender."""
    blender = sys.modules.get("bpy")
    program = blender.app.binary_path if blender is not None else ""
    if not program:
        return [sys.executable, "-P", str(SCRIPT)]
    words = sys.argv[1:]
    own = next((index for index, word in enumerate(words) if word in ("--command", "-c")), len(words))
    return [program, *words[:own], "--command", "keymark", "worker"]


class WorkerProcess:
    """A running worker; a thread of its own reads its messages."""

    def __init__(self, words: Sequence[str], debug: bool, events: "Events") -> None:
        self.ready = self._asked_to_end = False
        self.deadline = time.monotonic() + START_TIMEOUT_S
        """When it is lost unless it sends a message before."""
        self._stderr = tempfile.TemporaryFile()
        try:
            self._process = subprocess.Popen(
                words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=None if debug else self._stderr
            )
        except OSError:
            self._stderr.close()
            raise
        self._reader = threading.Thread(target=self._read, args=(events,), daemon=True)
        self._reader.start()

    def _read(self, events: "Events") -> None:
        stream = self._process.stdout
        assert stream is not None
        with stream:
            while line := stream.readline(LONGEST_BYTES):
                message = read_message(line)
                if message is not None:
                    events.put((self, message))
        events.put((self, None))

    def send(self, job: Job) -> None:
        """Let the worker run a job; where it has ended, its end follows as an event."""
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.write(job.to_line())
            self._process.stdin.flush()

    def rest(self) -> None:
        """Expect no message until the next job."""
        self.ready, self.deadline = True, inf

    def close(self) -> None:
        """Close its input, at whose end an idle worker exits."""
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.close()

    def terminate(self) -> None:
        """Ask the worker to clean up and end."""
        self._asked_to_end = True
        self.close()
        self._process.terminate()

    def kill(self) -> None:
        """End the worker at once, without a clean-up."""
        self._process.kill()

    def wait(self) -> None:
        """Wait until it has ended; after a grace period it is asked to, after another one killed."""
        for end in [self.kill] if self._asked_to_end else [self.terminate, self.kill]:
            if self._has_ended_within(TERMINATION_GRACE_S):
                break
            end()
        self._process.wait()
        self._reader.join(TERMINATION_GRACE_S)
        self._stderr.close()

    def exit_description(self) -> str:
        """How the worker ended, as part of a sentence."""
        if not self._has_ended_within(TERMINATION_GRACE_S):
            return "fell silent"
        status = self._process.returncode
        if status >= 0:
            return f"ended with exit status {status}{f' ({self.last_line})' if self.last_line else ''}"
        with suppress(ValueError):
            return f"was killed by {signal.Signals(-status).name}"
        return f"was killed by signal {-status}"

    @property
    def last_line(self) -> str:
        """The last line on standard error, without the program's name."""
        self._stderr.seek(max(0, self._stderr.seek(0, 2) - STDERR_TAIL_BYTES))
        lines = self._stderr.read().decode("utf-8", "replace").strip().splitlines()
        return lines[-1].removeprefix(f"{program_name()}: ") if lines else ""

    def _has_ended_within(self, timeout_s: float) -> bool:
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(timeout_s)
        return self._process.returncode is not None


Events = SimpleQueue[tuple[WorkerProcess, Message | None] | None]
"""Messages of workers, None for the end of one; None alone where a signal asks the batch to end."""
