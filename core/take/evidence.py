"""Kinds of evidence, and the record of the evidence that a result rests on beside its keyframes."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from .. import MOST_FRAMES
from ..detect.keypoints import BODY_POINTS
from ..errors import pluralize
from ..files.kinds import ByName, Choice, Items, Number, Text, Whole, relative_path
from ..files.records import Record

MARKERS, KEYPOINTS, DEPTH_HINTS, CONTOURS = "markers", "keypoints", "depth_hints", "contours"
EVIDENCE = (MARKERS, KEYPOINTS, DEPTH_HINTS, CONTOURS)
"""All kinds; a take's `evidence` names those that are used, by default whatever it has."""


def in_order(kinds: tuple[str, ...]) -> tuple[str, ...]:
    """The kinds in the order of `EVIDENCE`."""
    return tuple(kind for kind in EVIDENCE if kind in kinds)


LONGEST_LINE, LONGEST_NOTE = 1000, 10_000
MOST_NOTES, MOST_FILES = 1000, 100
FARTHEST_FRAME = 10**7

Line = Annotated[str, Text(LONGEST_LINE)]
Notes = Annotated[tuple[Annotated[str, Text(LONGEST_NOTE)], ...], Items("sentences", 0, MOST_NOTES)]
Sha256 = Annotated[str, Text(64, "a SHA-256 of 64 digits", pattern="^[0-9a-f]{64}$")]
FileDigests = Annotated[
    Mapping[str, Sha256], ByName("digests of files", MOST_FILES, key=relative_path("a file of this folder"))
]
FrameCount = Annotated[int, Whole(1, MOST_FRAMES)]
Frame = Annotated[int, Whole(-FARTHEST_FRAME, FARTHEST_FRAME)]
FrameRate = Annotated[float, Number(1e-3, 1e4)]


MOST_MARKERS, MOST_SOURCES = 64, 100
Share = Annotated[float, Number(0.0, 1.0, decimals=4)]


@dataclass(frozen=True)
class UsedKeypoints(Record):
    """Keypoints of one source."""

    SPARSE, REQUIRED = False, ("swapped",)

    source: Line
    """The detector, Blender's tracks, or clicks."""
    points: Annotated[
        tuple[Annotated[str, Choice(BODY_POINTS)], ...], Items("body points", 0, len(BODY_POINTS))
    ]
    """The body points it shows."""
    believed: Share
    """Share of all keypoints it saw that were followed, 0 to 1; 0 too where it saw nobody."""
    swapped: Share = 0.0
    """Share of them that it saw on the other side of the body."""


@dataclass(frozen=True)
class UsedEvidence(Record):
    """The markers, keypoints, hints of depth and contours that an estimate was held against."""

    SPARSE, REQUIRED = False, ("markers", "keypoints", "depth_hints", "contours")

    markers: Annotated[tuple[Annotated[str, Text(200)], ...], Items("names", 0, MOST_MARKERS)] = ()
    """Names of the markers."""
    keypoints: Annotated[tuple[UsedKeypoints, ...], Items("sources", 0, MOST_SOURCES)] = ()
    """The sources of keypoints."""
    depth_hints: bool = False
    """Whether a network's guess of depths counted."""
    contours: bool = False
    """Whether the contours of the body were followed."""

    @property
    def words(self) -> str:
        """The kinds that counted, in words: `5 markers, 33 keypoints, depth hints, contours`."""
        points = sum(len(source.points) for source in self.keypoints if source.believed > 0.0)
        counted = ((len(self.markers), "marker"), (points, "keypoint"))
        kinds = [pluralize(count, word) for count, word in counted if count]
        flags = ((self.depth_hints, "depth hints"), (self.contours, "contours"))
        return ", ".join([*kinds, *(word for used, word in flags if used)]) or "keyframes alone"
