"""Evidence that a result rests on beside its keyframes, for the record of a conversion and for people."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ..errors import InputError
from ..files.fields import Fields, listed
from ..files.json_file import shown
from ..footage.keypoints.body_points import BODY_POINTS
from ..text import pluralize
from .record_fields import record_line, record_list

MOST_MARKERS, MOST_SOURCES = 64, 100
LONGEST_NAME = 200


@dataclass(frozen=True)
class UsedKeypoints:
    """Keypoints of one source."""

    source: str
    """The detector, Blender's tracks, or clicks."""
    points: tuple[str, ...]
    """The body points it shows."""
    believed: float
    """Share of all keypoints it saw that were followed, 0 to 1; 0 too where it saw nobody."""
    swapped: float = 0.0
    """Share of them that it saw on the other side of the body."""


@dataclass(frozen=True)
class UsedEvidence:
    """The markers, keypoints, hints of depth and contours that an estimate was held against."""

    markers: tuple[str, ...] = ()
    """Names of the markers."""
    keypoints: tuple[UsedKeypoints, ...] = ()
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

    def to_json(self) -> dict[str, Any]:
        """The evidence as a JSON object."""
        return {
            "markers": list(self.markers),
            "keypoints": [
                {
                    "source": said.source,
                    "points": list(said.points),
                    "believed": round(said.believed, 4),
                    "swapped": round(said.swapped, 4),
                }
                for said in self.keypoints
            ],
            "depth_hints": self.depth_hints,
            "contours": self.contours,
        }


def read_used_evidence(fields: Fields) -> UsedEvidence:
    """Read the object of `to_json`.

    Raises:
        InputError: A field is unusable.
    """
    valid = f"a list of at most {MOST_MARKERS} names of {LONGEST_NAME} characters"
    markers = record_list(fields, "markers", str, MOST_MARKERS, valid)
    if not all(name.strip() and len(name) <= LONGEST_NAME for name in markers):
        raise InputError(f"{fields.where}: markers is {shown(markers)}; it must be {valid}")
    sources = record_list(
        fields, "keypoints", dict, MOST_SOURCES, f"a list of at most {MOST_SOURCES} sources"
    )
    return UsedEvidence(
        markers=tuple(markers),
        keypoints=tuple(
            _used_keypoints(value, f"{fields.where}: keypoints[{index}]")
            for index, value in enumerate(sources)
        ),
        depth_hints=_flag(fields, "depth_hints"),
        contours=_flag(fields, "contours"),
    )


def _used_keypoints(value: Mapping[str, Any], where: str) -> UsedKeypoints:
    fields = Fields.of(value, where)
    valid = f"a list of body points, each one of {listed(BODY_POINTS, 5)}"
    points = record_list(fields, "points", str, len(BODY_POINTS), valid)
    if not set(points) <= set(BODY_POINTS):
        raise InputError(f"{where}: points is {shown(points)}; it must be {valid}")
    believed, swapped = (fields.number(name, 0.0, 1.0) for name in ("believed", "swapped"))
    return UsedKeypoints(record_line(fields, "source"), tuple(points), believed, swapped)


def _flag(fields: Fields, name: str) -> bool:
    value = fields.required(name, "true or false")
    if not isinstance(value, bool):
        raise InputError(f"{fields.where}: {name} is {shown(value)}; it must be true or false")
    return value
