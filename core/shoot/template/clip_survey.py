"""What a folder of clips tells of itself, before anybody has described it."""

from collections import Counter
from collections.abc import Generator
from dataclasses import dataclass
from pathlib import Path

from ...arrays import Image
from ...errors import InputError
from ...footage.clips.clip import Clip
from ...footage.clips.spread_frames import sample_spread_frames
from ...footage.colors.strong_colors import StrongColor, strong_colors
from ...progress import run
from ...take.description import KEYFRAMES, OWN, beside
from ..shoot import Shoot, ShootTake

COLORED_CLIPS = 6
"""Clips whose colors are looked at; they share one performer."""
COLORED_FRAMES = 4
"""Frames of each."""


@dataclass(frozen=True)
class SeenClip:
    """A clip that can be opened."""

    name: str
    size: tuple[int, int]
    """Width and height [px]."""
    fps: float | None
    """Frames per second; None of images, which know of none."""
    frames: int
    """As many as the file claims."""
    posed: bool
    """Whether it has keyframes already."""


@dataclass(frozen=True)
class ClipSurvey:
    """What the clips of a folder tell."""

    clips: tuple[SeenClip, ...]
    described: tuple[str, ...]
    """Names of takes that have a description of their own."""
    unreadable: tuple[str, ...]
    """A sentence on each clip that cannot be opened."""
    colors: tuple[StrongColor, ...] = ()
    """The strong colors that some of the clips show."""

    @property
    def sizes(self) -> Counter[tuple[int, int]]:
        """Clips of each size."""
        return Counter(clip.size for clip in self.clips)

    @property
    def rates(self) -> Counter[float | None]:
        """Clips of each rate."""
        return Counter(clip.fps for clip in self.clips)

    @property
    def unposed(self) -> int:
        """Clips without keyframes."""
        return sum(not clip.posed for clip in self.clips)


def survey_clips(shoot: Shoot) -> Generator[float, None, ClipSurvey]:
    """Open every clip of a shoot, and look at some of them.

    Yields:
        The fraction done, from 0 to 1.
    """
    seen: list[SeenClip] = []
    described: list[str] = []
    unreadable: list[str] = []
    opened: list[Clip] = []
    for done, take in enumerate(shoot.takes):
        yield 0.8 * done / len(shoot.takes)
        if _is_described(take):
            described.append(take.name)
        if (take.place / OWN).exists():
            continue
        try:
            clip = Clip.open(take.place)
        except InputError as error:
            unreadable.append(str(error))
            continue
        opened.append(clip)
        fps = round(clip.fps, 6) if clip.knows_its_rate else None
        posed = beside(take.place, KEYFRAMES).exists()
        seen.append(SeenClip(take.name, clip.size, fps, clip.frame_count, posed))
    images: list[Image] = []
    chosen = opened[:: max(len(opened) // COLORED_CLIPS, 1)][:COLORED_CLIPS]
    for done, clip in enumerate(chosen):
        yield 0.8 + 0.2 * done / len(chosen)
        images += run(sample_spread_frames(clip, COLORED_FRAMES)).images
    yield 1.0
    return ClipSurvey(tuple(seen), tuple(described), tuple(unreadable), strong_colors(images))


def _is_described(take: ShootTake) -> bool:
    return (take.place / OWN).exists() or beside(Path(take.place), OWN).exists()
