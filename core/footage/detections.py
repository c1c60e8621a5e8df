"""Detections: all regions of the markers' colors in a clip, before they are assigned to markers.

The markers' expected regions decide the assignment, and also limit the pixels that the colors are learned
from. Detections therefore keep the images of the learning: they are reused with other expected regions if the
same colors would be learned with those, as exactly the same regions would be detected again.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from ..arrays import Array, Image
from .segmentation.regions import Regions


@dataclass(frozen=True)
class LearningRound:
    """One round of color learning."""

    frames: tuple[int, ...]
    """Indices of the frames learned from."""
    model_digest: str
    """Digest of the color model that was learned."""


@dataclass(frozen=True, eq=False)
class Detections:
    """All regions of the markers' colors in a clip of F frames."""

    regions: tuple[Regions, ...]
    """Regions of each frame, in pixels of the measuring grid."""
    time_s: Array
    """(F,) time stamps of the frames in seconds."""
    size: tuple[int, int]
    """Width and height of the clip's images in px."""
    learning_rounds: tuple[LearningRound, ...]
    """Rounds in which the colors were learned, in order."""
    samples: Mapping[int, Image]
    """The images (rows, columns, 3) that were learned from, by frame."""
