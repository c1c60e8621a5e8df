"""Outcomes of imaginary takes, for tests of the pages that show them."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from keymark.core.shoot.outcomes import Outcome, Status
from keymark.core.take.conversion_record import ConversionRecord
from keymark.core.take.evidence import UsedEvidence, UsedKeypoints

FILES = ("motion.json", "motion.blend", "motion.bvh", "report/overlay.png")
RECORD = ConversionRecord(
    digest="00",
    keymark="0.0.0",
    take="walk",
    method="map",
    library=None,
    frames=120,
    frame_start=1,
    fps=30.0,
    keyframes=(1, 60, 120),
    matched=(),
    confidence=0.9,
    weakest=0.8,
    weak_frames=(87, 31),
    notes=("the frames are unevenly spaced in time",),
    files=dict.fromkeys(FILES, 64 * "0"),
    evidence=UsedEvidence(("trunk", "shin.L"), (UsedKeypoints("a detector", ("nose", "wrist.L"), 1.0),)),
)


def converted(output: Path, name: str, **changed: Any) -> Outcome:
    """A take that converted, with a record in which fields are changed."""
    return Outcome(name, output / name, Status.CONVERTED, replace(RECORD, **changed), None, 12.0)


def failed(output: Path, name: str, error: str, record: ConversionRecord | None = None) -> Outcome:
    """A take that failed."""
    return Outcome(name, output / name, Status.FAILED, record, error, 1.0)


def waiting(output: Path, name: str) -> Outcome:
    """A take that is not converted yet."""
    return Outcome(name, output / name, Status.WAITING)
