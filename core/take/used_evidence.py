"""Evidence that a result rests on beside its keyframes, for the record of a conversion and for people."""

from dataclasses import dataclass
from typing import Annotated

from ..files.kinds import Choice, Items, Number, Text
from ..files.records import Record
from ..footage.keypoints.body_points import BODY_POINTS
from ..text import pluralize
from .record_fields import Line

MOST_MARKERS, MOST_SOURCES = 64, 100
LONGEST_NAME = 200
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

    markers: Annotated[tuple[Annotated[str, Text(LONGEST_NAME)], ...], Items("names", 0, MOST_MARKERS)] = ()
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
