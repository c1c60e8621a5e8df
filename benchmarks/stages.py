"""The stages of a conversion, and a clock that the command line tells of them."""

import time
from collections.abc import Callable
from typing import Any

STAGES = {
    "Reading the take": "read",
    "Opening the clip": "extract",
    "Following the markers": "extract",
    "Estimating the motion": "estimate",
    "Writing the motion": "write",
    "Writing Blender's files": "blend, bvh",
    "Drawing the pictures": "pictures",
}
COLUMNS = ("start-up", "read", "extract", "estimate", "write", "blend, bvh", "pictures")


class StageClock:
    """Stand-in for the command line's console that records the start of each stage, by a given clock."""

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        self.began: list[tuple[str, float]] = []
        self._clock = clock

    def stage(self, name: str) -> None:
        """Record a new stage."""
        self.began.append((name, self._clock()))

    def progress(self, progress: Any) -> None:
        """Record a new stage where a job's progress has one."""
        if not self.began or self.began[-1][0] != progress.stage:
            self.stage(progress.stage)

    def seconds(self) -> dict[str, float]:
        """Duration of each column's stages."""
        ends = [*(moment for _, moment in self.began[1:]), self._clock()]
        durations = dict.fromkeys(COLUMNS, 0.0)
        for (name, moment), end in zip(self.began, ends, strict=True):
            if name in STAGES:
                durations[STAGES[name]] += end - moment
        return durations
