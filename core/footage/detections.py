"""What one look at every frame finds, before anything says which region is which marker's.

Where the markers are expected decides which regions are theirs, and has a say in what their colors are
learned from. Sightings remember what was learned from, so that they serve other expectations too, wherever
the same would be learned with those: exactly the same regions would be found again.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from ..arrays import Array, Image
from .segmentation.regions import Regions


@dataclass(frozen=True)
class LearningRound:
    """Once that the colors were learned."""

    frames: tuple[int, ...]
    """The frames learned from."""
    model_digest: str
    """Digest of the color model that was learned."""


@dataclass(frozen=True, eq=False)
class Detections:
    """All regions of the markers' colors in a clip of F frames."""

    regions: tuple[Regions, ...]
    """Of each frame, what was found in it, in pixels of the measuring grid."""
    time_s: Array
    """(F,) time stamps of the frames in seconds."""
    size: tuple[int, int]
    """Width and height of the clip's images in px."""
    learning_rounds: tuple[LearningRound, ...]
    """How the colors were learned, in order."""
    samples: Mapping[int, Image]
    """The images that were learned from, (rows, columns, 3), by their frames."""
