"""The result of a conversion, and the record of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..estimate.reconstruct import Reconstruction
from ..files.digest import content_digest
from ..posing.found_poses import FoundPoses, contradiction_notes
from ..prior.library import Library, library_digest
from ..progress import run
from ..review.frame_evidence import used_evidence
from ..review.review import review
from ..take.conversion_record import ConversionRecord
from ..take.take import Take

WEAKEST_PERCENTILE = 5.0
"""Percentile of the frames' confidence that is recorded as the weakest."""


@dataclass(frozen=True, eq=False)
class Conversion:
    """The result of a conversion."""

    take: Take
    reconstruction: Reconstruction
    files: tuple[Path, ...]
    """In the order of `RESULT_FILES`, then keyframes and record."""
    found: FoundPoses | None = None
    """What was found of keyframes, if that was asked for, and how well it fits."""
    libraries: tuple[Library, ...] = ()
    conversion_notes: tuple[str, ...] = ()
    """Sentences on unused keyframes and on files that are kept."""

    @property
    def notes(self) -> tuple[str, ...]:
        """Everything a person should know of the result, one sentence each."""
        about: tuple[str, ...] = ()
        if self.found is not None:
            about = (self.found.reason.rstrip("."), *contradiction_notes(self.take, self.found))
        return (*self.conversion_notes, *about, *self.reconstruction.notes)


def conversion_record(
    conversion: Conversion,
    version: str,
    digest: str,
    folder: Path,
    names: Sequence[str],
    stable_digests: Mapping[str, str],
) -> ConversionRecord:
    """The record of a conversion."""
    take, motion = conversion.take, conversion.reconstruction.motion
    frames = np.arange(len(motion.time_s), dtype=np.float64) + motion.frame_start
    reviewed = run(review(take, conversion.reconstruction, frames))
    confidence = reviewed.confidence[np.isfinite(reviewed.confidence)]
    found = {keyframe.index: keyframe.matched for keyframe in take.keyframes if keyframe.matched is not None}
    return ConversionRecord(
        digest=digest,
        keymark=version,
        take=take.name,
        method=motion.method,
        library=None if conversion.found is None else conversion.found.library,
        frames=len(motion.time_s),
        frame_start=motion.frame_start,
        fps=motion.fps,
        keyframes=tuple(index + motion.frame_start for index in motion.keyframe_indices),
        matched=tuple(i + motion.frame_start for i in motion.keyframe_indices if i in found),
        confidence=round(float(confidence.mean()), 4) if len(confidence) else None,
        weakest=round(float(np.percentile(confidence, WEAKEST_PERCENTILE)), 4) if len(confidence) else None,
        weak_frames=tuple(frame.index + motion.frame_start for frame in reviewed.weak_frames),
        notes=conversion.notes,
        files={name: stable_digests.get(name) or content_digest(folder / name) for name in names},
        evidence=used_evidence(conversion.reconstruction),
        libraries={library.identifier: library_digest(library) for library in conversion.libraries},
        doubtful=tuple(
            index + motion.frame_start for index, said in sorted(found.items()) if said.is_doubtful
        ),
    )
