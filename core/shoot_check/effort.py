"""How long converting a take takes and how much it writes: rough, from what was measured once.

One processor of 2023 took so long; the sizes hold for 320 x 240 to 1920 x 1080.
"""

from dataclasses import dataclass

SECONDS_A_TAKE = 1.5
"""Writing Blender's files and drawing pictures."""
SECONDS_A_FRAME = {"map": 0.025, "ekf": 0.02, "interpolation": 0.006}
"""Beyond reading it."""
SECONDS_A_MEGAPIXEL = 0.015
"""Decoding and following the markers."""
SECONDS_TO_MATCH = 0.05
"""A frame with a library."""
BYTES_A_TAKE = 2_500_000
BYTES_A_FRAME = 5_000


@dataclass(frozen=True)
class Effort:
    """What a take asks for."""

    seconds: float
    """Of one processor."""
    size_bytes: int
    """Of what is written."""


def effort(frames: int, size: tuple[int, int], method: str, matched: bool) -> Effort:
    """Estimate what converting a take asks for."""
    a_frame = SECONDS_A_FRAME[method] + SECONDS_A_MEGAPIXEL * size[0] * size[1] / 1e6
    if matched:
        a_frame += SECONDS_TO_MATCH
    return Effort(SECONDS_A_TAKE + frames * a_frame, BYTES_A_TAKE + frames * BYTES_A_FRAME)
