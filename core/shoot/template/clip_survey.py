"""A survey of undescribed clips: sizes, rates, keyframes and strong colors."""

from collections import Counter
from collections.abc import Generator
from dataclasses import dataclass

from ...arrays import Image
from ...errors import InputError
from ...footage.clips.clip import Clip
from ...footage.clips.spread_frames import sample_spread_frames
from ...footage.colors.strong_colors import StrongColor, strong_colors
from ...progress import run
from ...take.description import KEYFRAME_FILE, TAKE_FILE, sidecar_file
from ..shoot import Shoot, ShootTake

COLORED_CLIPS = 6
"""Clips that are sampled for colors; they share one performer."""
COLORED_FRAMES = 4
"""Sampled frames of each."""


@dataclass(frozen=True)
class SurveyedClip:
    """A clip that can be opened."""

    name: str
    size: tuple[int, int]
    """Width and height [px]."""
    fps: float | None
    """Frames per second; None for images, which have no rate."""
    frames: int
    """Number of frames that the file claims."""
    posed: bool
    """Whether it has a keyframe file."""


@dataclass(frozen=True)
class ClipSurvey:
    """The clips of a folder, their sizes and rates counted."""

    clips: tuple[SurveyedClip, ...]
    described: tuple[str, ...]
    """Names of takes that have a description of their own."""
    unreadable: tuple[str, ...]
    """A sentence on each clip that cannot be opened."""
    colors: tuple[StrongColor, ...] = ()
    """Strong colors in some of the clips."""

    @property
    def sizes(self) -> Counter[tuple[int, int]]:
        """Number of clips of each size."""
        return Counter(clip.size for clip in self.clips)

    @property
    def rates(self) -> Counter[float | None]:
        """Number of clips of each rate."""
        return Counter(clip.fps for clip in self.clips)

    @property
    def unposed(self) -> int:
        """Number of clips without keyframes."""
        return sum(not clip.posed for clip in self.clips)


def survey_clips(shoot: Shoot) -> Generator[float, None, ClipSurvey]:
    """Open every clip of a shoot, and sample the colors of some.

    Yields:
        The fraction done, from 0 to 1.
    """
    seen: list[SurveyedClip] = []
    described: list[str] = []
    unreadable: list[str] = []
    opened: list[Clip] = []
    for done, take in enumerate(shoot.takes):
        yield 0.8 * done / len(shoot.takes)
        if _is_described(take):
            described.append(take.name)
        if (take.path / TAKE_FILE).exists():
            continue
        try:
            clip = Clip.open(take.path)
        except InputError as error:
            unreadable.append(str(error))
            continue
        opened.append(clip)
        fps = round(clip.fps, 6) if clip.knows_its_rate else None
        posed = sidecar_file(take.path, KEYFRAME_FILE).exists()
        seen.append(SurveyedClip(take.name, clip.size, fps, clip.frame_count, posed))
    images: list[Image] = []
    chosen = opened[:: max(len(opened) // COLORED_CLIPS, 1)][:COLORED_CLIPS]
    for done, clip in enumerate(chosen):
        yield 0.8 + 0.2 * done / len(chosen)
        images += run(sample_spread_frames(clip, COLORED_FRAMES)).images
    yield 1.0
    return ClipSurvey(tuple(seen), tuple(described), tuple(unreadable), strong_colors(images))


def _is_described(take: ShootTake) -> bool:
    return (take.path / TAKE_FILE).exists() or sidecar_file(take.path, TAKE_FILE).exists()
