"""A rough estimate of what a conversion costs in processor time and disk space.

Measured on one processor of 2023 with clips of 320 x 240 to 1280 x 720; another may take half or twice.
"""

from collections.abc import Collection
from dataclasses import dataclass

from ...library.several_libraries import EVERY_LIBRARY
from ...take.evidence_kinds import CONTOURS, KEYPOINTS, MARKERS

SECONDS_A_TAKE = 0.9
"""Writing Blender's files and drawing pictures."""
SECONDS_A_FRAME = {"map": 0.004, "ekf": 0.004, "interpolation": 0.002}
"""By method, without reading the frame and without what follows."""
SECONDS_FOR_KEYPOINTS = 0.001
"""A frame."""
SECONDS_FOR_CONTOURS, SECONDS_FOR_WIDE_CONTOURS = 0.006, 0.009
"""A frame, with markers and without, where contours are searched far and wide."""
SECONDS_A_MEGAPIXEL = 0.012
"""Decoding and following the markers."""
SECONDS_TO_MATCH = 0.02
"""A frame, with one library."""
SECONDS_TO_POSE = 0.1
"""A frame, with all libraries."""
BYTES_A_TAKE = 1_800_000
BYTES_A_FRAME = 5_000


@dataclass(frozen=True)
class CostEstimate:
    """Cost of one conversion."""

    seconds: float
    """Time of one processor."""
    size_bytes: int
    """Size of the files written."""


def estimate_cost(
    frames: int,
    size: tuple[int, int],
    method: str,
    library: str | None,
    evidence: Collection[str] = (MARKERS, CONTOURS),
) -> CostEstimate:
    """Estimate the cost of converting a take.

    Args:
        frames: Number of frames of its clip.
        size: Width and height of the clip [px].
        method: One of `METHODS`.
        library: The library that keyframes are found with, `EVERY_LIBRARY` for all of them, or None.
        evidence: Kinds of evidence that it is held against.
    """
    a_frame = SECONDS_A_FRAME[method] + SECONDS_A_MEGAPIXEL * size[0] * size[1] / 1e6
    if method == "map":
        a_frame += SECONDS_FOR_KEYPOINTS * (KEYPOINTS in evidence)
    if method == "map" and CONTOURS in evidence:
        a_frame += SECONDS_FOR_CONTOURS if MARKERS in evidence else SECONDS_FOR_WIDE_CONTOURS
    if library is not None:
        a_frame += SECONDS_TO_POSE if library == EVERY_LIBRARY else SECONDS_TO_MATCH
    return CostEstimate(SECONDS_A_TAKE + frames * a_frame, BYTES_A_TAKE + frames * BYTES_A_FRAME)
