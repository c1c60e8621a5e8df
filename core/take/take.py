"""A take: one recorded performance, validated, with notes on what looks wrong."""

from dataclasses import dataclass
from pathlib import Path

from ..body.kinematics import Body
from ..footage.camera import Camera
from ..footage.ignored_regions import IgnoredRegion
from ..footage.keypoints.keypoints import People
from ..footage.region_tracks import MarkerStyle
from ..prior.keyframes import Keyframe
from .description import TAKE_FILE

POORLY_FITTED_M = 0.06
"""Hand-posed points fit an actor of the right size within two or three centimeters."""


@dataclass(frozen=True, eq=False)
class Take:
    """One recorded performance, validated."""

    folder: Path
    clip: Path
    """The footage: a video, a folder of images, or a pattern of numbered images."""
    fps: float
    frame_start: int
    """Scene frame of the clip's first decoded frame."""
    frame_count: int | None
    """Number of frames of the clip; None where it is not given."""
    camera: Camera
    body: Body
    markers: tuple[MarkerStyle, ...]
    """The colored garments that are followed; none where the performer wears any clothes."""
    keyframes: tuple[Keyframe, ...]
    described_in: Path | None = None
    """The nearest file that describes it; None for the `take.json` of its folder."""
    title: str = ""
    """Its name; empty for the folder's name."""
    keypoints: tuple[People, ...] = ()
    """People seen by each source of keypoints: detectors, Blender's tracks, clicks."""
    contours: bool = True
    """Whether the contours of the body are followed, where the camera stands still."""
    ignored_regions: tuple[IgnoredRegion, ...] = ()
    """Regions of the picture that are never a marker."""

    @property
    def file(self) -> Path:
        """The nearest file that describes it, for sentences."""
        return self.described_in or self.folder / TAKE_FILE

    @property
    def name(self) -> str:
        """Its title, or the name of its folder."""
        return self.title or self.folder.absolute().name

    @property
    def marker_segments(self) -> tuple[str, ...]:
        """The segment each marker is bound to."""
        return tuple(style.segment for style in self.markers)

    @property
    def keyframe_indices(self) -> tuple[int, ...]:
        """Frame indices of the keyframes."""
        return tuple(keyframe.index for keyframe in self.keyframes)

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on keyframes that are usable but look wrong."""
        return tuple(
            (
                f"keyframe {keyframe.index + self.frame_start}: its points are "
                f"{100 * keyframe.residual_m:.0f} cm on average from any posture of this actor; check "
                "them and the actor's lengths"
            )
            for keyframe in self.keyframes
            if keyframe.residual_m > POORLY_FITTED_M
        )
