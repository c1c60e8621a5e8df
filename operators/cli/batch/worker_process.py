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
from dataclasses import asdict, dataclass
from pathlib import Path
from queue import SimpleQueue

from ....core.shoot.discovery import ShootTake
from ....core.take.conversion_settings import ConversionSettings
from ..console import program_name

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
        return json.dumps(asdict(self), default=str).encode("ascii") + b"\n"

    @classmethod
    def from_line(cls, line: bytes) -> "Job":
        """Decode a job, which a batch has encoded."""
        value = json.loads(line)
        take, defaults = value["take"], value["defaults"]
        for name in ("keyframes", "network"):
            defaults[name] = defaults[name] and Path(defaults[name])
        defaults["keypoints"] = defaults["keypoints"] and tuple(map(Path, defaults["keypoints"]))
        defaults["evidence"] = defaults["evidence"] and tuple(defaults["evidence"])
        made = ShootTake(**{**take, "path": Path(take["path"])}), ConversionSettings(**defaults)
        return cls(made[0], Path(value["folder"]), made[1], value["again"], value["debug"])


@dataclass(frozen=True)
class Step:
    """The progress of a job, by which a worker shows that it is alive; the first one, that it has started."""

    stage: str = ""
    fraction: float = 0.0


@dataclass(frozen=True)
class Done:
    """A job has ended."""

    result: str
    """`converted`, `unchanged`, `failed`, or `busy` where another process holds the lock of the results."""
    error: str | None = None
    kind: str | None = None
    """Kind of failure, see `core/shoot/outcomes`."""
    seconds: float = 0.0
    memory_bytes: int | None = None
    """Resident memory of the worker after the job; None where the system does not tell."""


Message = Step | Done
MESSAGES: dict[str, type[Step] | type[Done]] = {"step": Step, "done": Done}


def message_line(message: Message) -> bytes:
    """Encode a message as a line."""
    return json.dumps({type(message).__name__.lower(): vars(message)}).encode("ascii") + b"\n"


def read_message(line: bytes) -> Message | None:
    """Decode a message; None for any other line, as those that Blender prints while it starts."""
    try:
        ((name, fields),) = json.loads(line).items()
        return MESSAGES[name](**fields)
    except (ValueError, AttributeError, KeyError, TypeError):
        return None


START_TIMEOUT_S, HEARTBEAT_TIMEOUT_S = 300.0, 1800.0
"""A worker that sends no message for so long will never start, or end: its decoder or its disk hangs."""
TERMINATION_GRACE_S = 10.0
"""Time that a worker has to clean up after SIGTERM."""


def worker_command_line() -> list[str]:
    """The command that starts a worker in the same kind of process as this one: Python or Blender."""
    blender = sys.modules.get("bpy")
    program = blender.app.binary_path if blender is not None else ""
    if not program:
        return [sys.executable, "-P", str(Path(__file__).with_name("machine_resources.py"))]
    words = sys.argv[1:]
    own = next((index for index, word in enumerate(words) if word in ("--command", "-c")), len(words))
    return [program, *words[:own], "--command", "keymark", "worker"]


class WorkerProcess:
    """A running worker; a thread of its own reads its messages."""

    def __init__(self, words: Sequence[str], debug: bool, events: "Events") -> None:
        self.started = self._asked_to_end = False
        self.deadline = time.monotonic() + START_TIMEOUT_S
        """When it is lost unless it sends a message before."""
        self._stderr = tempfile.TemporaryFile()
        stderr = None if debug else self._stderr
        try:
            self.process = subprocess.Popen(
                words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=stderr
            )
        except OSError:
            self._stderr.close()
            raise
        self._reader = threading.Thread(target=self._read, args=(events,), daemon=True)
        self._reader.start()

    def _read(self, events: "Events") -> None:
        assert self.process.stdout is not None
        with self.process.stdout as stream:
            while line := stream.readline(2**22):  # a list of takes may hold a megabyte on one of them
                message = read_message(line)
                if message is not None:
                    events.put((self, message))
        events.put((self, None))

    def send(self, job: Job) -> None:
        """Let the worker run a job; where it has ended, its end follows as an event."""
        assert self.process.stdin is not None
        with suppress(OSError):
            self.process.stdin.write(job.to_line())
            self.process.stdin.flush()

    def close(self) -> None:
        """Close its input, at whose end an idle worker exits."""
        assert self.process.stdin is not None
        with suppress(OSError):
            self.process.stdin.close()

    def terminate(self) -> None:
        """Ask the worker to clean up and end."""
        self._asked_to_end = True
        self.close()
        self.process.terminate()

    def wait(self) -> None:
        """Wait until it has ended; after a grace period it is asked to, after another one killed."""
        for end in [self.process.kill] if self._asked_to_end else [self.terminate, self.process.kill]:
            if self._has_ended():
                break
            end()
        self.process.wait()
        self._reader.join(TERMINATION_GRACE_S)
        self._stderr.close()

    def exit_description(self) -> str:
        """How the worker ended, as part of a sentence."""
        if not self._has_ended():
            return "fell silent"
        status, last_line = self.process.returncode, self.last_line()
        if status >= 0:
            return f"ended with exit status {status}{f' ({last_line})' if last_line else ''}"
        with suppress(ValueError):
            return f"was killed by {signal.Signals(-status).name}"
        return f"was killed by signal {-status}"

    def last_line(self) -> str:
        """The last line on standard error, without the program's name."""
        self._stderr.seek(max(0, self._stderr.seek(0, 2) - 2000))
        lines = self._stderr.read().decode("utf-8", "replace").strip().splitlines()
        return lines[-1].removeprefix(f"{program_name()}: ") if lines else ""

    def _has_ended(self) -> bool:
        with suppress(subprocess.TimeoutExpired):
            self.process.wait(TERMINATION_GRACE_S)
        return self.process.returncode is not None


Events = SimpleQueue[tuple[WorkerProcess, Message | None] | None]
"""Messages of workers, None for the end of one; None alone where a signal asks the batch to end."""
