"""Rows of the legend that explain keypoints."""

from typing import TYPE_CHECKING

from ..keypoints.frame_keypoints import FrameKeypoints
from .keypoint_marks import all_sources
from .legend import SOURCE_SAMPLES, Row, Sample

if TYPE_CHECKING:
    from ...core.review.compared_keypoints import ComparedKeypoints


def keypoint_rows(
    keypoints: "ComparedKeypoints", index: int, seen: tuple[FrameKeypoints, ...]
) -> tuple[Row, ...]:
    """Rows for what a frame shows of keypoints: those of a motion, and others that a take's sources see."""
    rows = list(source_rows(all_sources(keypoints, seen)))
    if keypoints.names:
        rows.append((Sample.EXPECTED, "Where the motion puts it"))
    if keypoints.thrown_out[index].any():
        rows.append((Sample.THROWN_OUT, "Keypoint not believed"))
    if keypoints.swapped[index].any():
        rows.append((Sample.SWAPPED, "Left and right exchanged"))
    return tuple(rows)


def source_rows(sources: tuple[str, ...]) -> tuple[Row, ...]:
    """A row for each source of keypoints, as far as their colors differ."""
    return tuple(
        (sample, f"Keypoint of {source}") for sample, source in zip(SOURCE_SAMPLES, sources, strict=False)
    )
