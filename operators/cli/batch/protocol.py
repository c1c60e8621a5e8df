"""The protocol between a batch and its workers: JSON Lines, jobs one way and messages the other."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from ....core.shoot.shoot import ShootTake
from ....core.take.conversion_settings import ConversionSettings

LONGEST_BYTES = 2**22
"""Of a line: a list of takes may hold a megabyte on one of them."""


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
        take, defaults = self.take, self.defaults
        value = {
            "take": [take.name, str(take.path), take.overrides, take.overrides_location],
            "folder": str(self.folder),
            "defaults": {
                **vars(defaults),
                "keyframes": defaults.keyframes and str(defaults.keyframes),
                "keypoints": defaults.keypoints and [str(file) for file in defaults.keypoints],
            },
            "again": self.again,
            "debug": self.debug,
        }
        return _line(value)

    @classmethod
    def from_line(cls, line: bytes) -> "Job":
        """Decode a job.

        Raises:
            ValueError: The line is no JSON.
            KeyError: A field is missing.
        """
        value = json.loads(line)
        name, place, nearest, said_in = value["take"]
        defaults = value["defaults"]
        keyframes = defaults["keyframes"] and Path(defaults["keyframes"])
        keypoints = defaults["keypoints"] and tuple(map(Path, defaults["keypoints"]))
        evidence = defaults["evidence"] and tuple(defaults["evidence"])
        return cls(
            ShootTake(name, Path(place), nearest, said_in),
            Path(value["folder"]),
            ConversionSettings(
                **{**defaults, "keyframes": keyframes, "keypoints": keypoints, "evidence": evidence}
            ),
            value["again"],
            value["debug"],
        )


@dataclass(frozen=True)
class Ready:
    """A worker has started and accepts jobs."""

    keymark: str
    """Its version."""


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
    """Kind of failure, see `core/shoot/outcomes/failures`."""
    memory_bytes: int | None = None
    """Resident memory of the worker after the job; None where the system does not tell."""


CONVERTED, UNCHANGED, FAILED, BUSY = "converted", "unchanged", "failed", "busy"
Message = Ready | Step | Done
MESSAGES: Mapping[str, type[Ready] | type[Step] | type[Done]] = {
    kind.__name__.lower(): kind for kind in (Ready, Step, Done)
}


def message_line(message: Message) -> bytes:
    """Encode a message as a line."""
    return _line({type(message).__name__.lower(): asdict(message)})


def read_message(line: bytes) -> Message | None:
    """Decode a message; None for any other line, as those that Blender prints while it starts."""
    try:
        value = json.loads(line)
        ((name, said),) = value.items()
        kind = MESSAGES[name]
        return kind(**{field.name: said[field.name] for field in fields(kind)})
    except (ValueError, AttributeError, KeyError, TypeError):
        return None


def _line(value: Any) -> bytes:
    return json.dumps(value).encode("ascii") + b"\n"
