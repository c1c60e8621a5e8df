"""Fields that records of results have in common: lines, sentences, and digests of files."""

from collections.abc import Mapping
from typing import Annotated

from ..files.kinds import ByName, Items, Number, Text, Whole
from ..files.safe_path import relative_path

LONGEST_LINE, LONGEST_NOTE = 1000, 10_000
MOST_NOTES, MOST_FILES = 1000, 100
MOST_FRAMES, FARTHEST_FRAME = 10**6, 10**7

Line = Annotated[str, Text(LONGEST_LINE)]
Notes = Annotated[tuple[Annotated[str, Text(LONGEST_NOTE)], ...], Items("sentences", 0, MOST_NOTES)]
Sha256 = Annotated[str, Text(64, "a SHA-256 of 64 digits", pattern="^[0-9a-f]{64}$")]
FileDigests = Annotated[
    Mapping[str, Sha256], ByName("digests of files", MOST_FILES, key=relative_path("a file of this folder"))
]
FrameCount = Annotated[int, Whole(1, MOST_FRAMES)]
Frame = Annotated[int, Whole(-FARTHEST_FRAME, FARTHEST_FRAME)]
FrameRate = Annotated[float, Number(1e-3, 1e4)]
