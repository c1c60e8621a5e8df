"""The protocol between a batch and its workers: JSON Lines, jobs one way and messages the other."""

import json
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from ....core.shoot.shoot import ShootTake
from ....core.take.conversion_settings import ConversionSettings

LONGEST_BYTES = 2**22
"""Of a line: a list of takes may hold a megabyte on one of them."""
CONVERTED, UNCHANGED, FAILED, BUSY = "converted", "unchanged", "failed", "busy"


@dataclass(frozen=True, eq=False)
class Job:
    """One take to convert."""

    take: ShootTake
    folder: Path
    """Folder for the results."""
    defaults: ConversionSettings
    """Settings where the take and its shoots give none."""
    again: bool = False
    """Whether to convert the take even where its results are there already."""
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
    """From 0 to 1."""


@dataclass(frozen=True)
class Done:
    """A job has ended."""

    result: str
    """`converted`, `unchanged`, `failed`, or `busy` where another process holds the lock of the results."""
    seconds: float = 0.0
    error: str | None = None
    """Why the job failed, in a sentence."""
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
