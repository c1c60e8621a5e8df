"""What a conversion made, and what is recorded of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....core.estimate.reconstruct import Reconstruction
from ....core.files.digest import content_digest
from ....core.matching.match_take import LibraryChoice
from ....core.progress import run
from ....core.review.review import review
from ....core.take.conversion_record import ConversionRecord
from ....core.take.take import Take
from ..version import version

WEAKEST = 5.0
"""Percent of the frames that are less certain than what is recorded as the weakest."""


@dataclass(frozen=True, eq=False)
class Conversion:
    """What a conversion made."""

    take: Take
    reconstruction: Reconstruction
    files: tuple[Path, ...]
    """In the order of `BELONGINGS`, keyframes last."""
    choice: LibraryChoice | None = None
    """Which library was matched, and how well, where one was."""
    left_aside: tuple[str, ...] = ()
    """A sentence about what of the take was not used."""

    @property
    def notes(self) -> tuple[str, ...]:
        """What a person should know of the result, one sentence each."""
        reason = () if self.choice is None else (self.choice.reason.rstrip("."),)
        return (*self.left_aside, *reason, *self.reconstruction.notes)


def conversion_record(
    conversion: Conversion, digest: str, place: Path, names: Sequence[str], same: Mapping[str, str]
) -> ConversionRecord:
    """What is recorded of a conversion.

    Args:
        conversion: What was made.
        digest: Of what it was made from.
        place: Where its files lie.
        names: Their paths from there.
        same: Digests of files that differ from run to run, of that in them which does not.
    """
    take, motion = conversion.take, conversion.reconstruction.motion
    frames = np.arange(len(motion.time_s), dtype=np.float64) + motion.frame_start
    judged = run(review(take, conversion.reconstruction, frames))
    believed = judged.confidence[np.isfinite(judged.confidence)]
    match = None if conversion.choice is None else conversion.choice.match
    matched = {keyframe.index for keyframe in take.keyframes if keyframe.matched is not None}
    return ConversionRecord(
        digest=digest,
        keymark=version(),
        take=take.name,
        method=motion.method,
        library=None if match is None else match.library.identifier,
        frames=len(motion.time_s),
        frame_start=motion.frame_start,
        fps=motion.fps,
        keyframes=tuple(index + motion.frame_start for index in motion.keyframe_indices),
        matched=tuple(i + motion.frame_start for i in motion.keyframe_indices if i in matched),
        confidence=round(float(believed.mean()), 4) if len(believed) else None,
        weakest=round(float(np.percentile(believed, WEAKEST)), 4) if len(believed) else None,
        weak_frames=tuple(frame.index + motion.frame_start for frame in judged.weak_frames),
        notes=conversion.notes,
        files={name: same.get(name) or content_digest(place / name) for name in names},
    )
