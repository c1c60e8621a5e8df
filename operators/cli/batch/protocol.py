"""What a batch and its workers tell each other: JSON Lines, jobs one way and answers the other."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from ....core.shoot.shoot import ShootTake
from ....core.take.conversion_settings import ConversionSettings

LONGEST_BYTES = 2**22
"""Of a line: a list may say a megabyte of one take."""


@dataclass(frozen=True, eq=False)
class Job:
    """One take to convert."""

    take: ShootTake
    folder: Path
    """For its results."""
    farther: ConversionSettings
    """What counts where the take and its shoots say nothing."""
    again: bool = False
    """Whether to convert it even where the results are there already."""
    debug: bool = False

    def to_line(self) -> bytes:
        """The job as a line."""
        take, farther = self.take, self.farther
        value = {
            "take": [take.name, str(take.path), take.overrides, take.overrides_location],
            "folder": str(self.folder),
            "farther": {**vars(farther), "keyframes": farther.keyframes and str(farther.keyframes)},
            "again": self.again,
            "debug": self.debug,
        }
        return _line(value)

    @classmethod
    def from_line(cls, line: bytes) -> "Job":
        """The job of a line."""
        value = json.loads(line)
        name, path, overrides, location = value["take"]
        farther = value["farther"]
        keyframes = farther["keyframes"] and Path(farther["keyframes"])
        return cls(
            ShootTake(name, Path(path), overrides, location),
            Path(value["folder"]),
            ConversionSettings(**{**farther, "keyframes": keyframes}),
            value["again"],
            value["debug"],
        )


@dataclass(frozen=True)
class Ready:
    """A worker has started and waits for jobs."""

    keymark: str
    """Its version."""


@dataclass(frozen=True)
class Step:
    """How far a worker is with its job."""

    stage: str
    fraction: float


@dataclass(frozen=True)
class Done:
    """A worker has come to the end of its job."""

    result: str
    """`converted`, `unchanged`, `failed`, or `busy` where another process is at work on the take."""
    seconds: float = 0.0
    error: str | None = None
    """Why it failed, in a sentence."""
    kind: str | None = None
    """Of failure, see `core/shoot/outcomes/failures`."""
    memory_bytes: int | None = None
    """What the worker holds now; None where the system does not tell."""


CONVERTED, UNCHANGED, FAILED, BUSY = "converted", "unchanged", "failed", "busy"
Answer = Ready | Step | Done
KINDS: Mapping[str, type[Ready] | type[Step] | type[Done]] = {
    kind.__name__.lower(): kind for kind in (Ready, Step, Done)
}


def answer_line(answer: Answer) -> bytes:
    """An answer as a line."""
    return _line({type(answer).__name__.lower(): asdict(answer)})


def read_answer(line: bytes) -> Answer | None:
    """The answer of a line; None where it is none, as what a Blender says while it starts."""
    try:
        value = json.loads(line)
        ((name, said),) = value.items()
        kind = KINDS[name]
        return kind(**{field.name: said[field.name] for field in fields(kind)})
    except (ValueError, AttributeError, KeyError, TypeError):
        return None


def _line(value: Any) -> bytes:
    return json.dumps(value).encode("ascii") + b"\n"
