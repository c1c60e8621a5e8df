"""A survey of undescribed clips: sizes, rates, keyframes, keypoints and strong colors."""

from collections import Counter
from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace

from ...arrays import Image
from ...errors import InputError
from ...footage.clips.clip import Clip
from ...footage.clips.spread_frames import sample_spread_frames
from ...footage.colors.strong_colors import StrongColor, strong_colors
from ...progress import run
from ...take.description import KEYFRAME_FILE, KEYPOINT_FILE, TAKE_FILE, sidecar_file
from ...take.evidence_kinds import KEYPOINTS, MARKERS
from ..shoot import Shoot, ShootTake

COLORED_CLIPS = 48
"""Clips that are sampled for colors at most: a few of every day, of all performers."""
COLORED_FRAMES = 4
"""Sampled frames of each."""
LISTED_CLIPS = 6
"""Clips whose colors are listed together."""
GARMENT_HUES = 4
"""Strong hues that five garments show at least; plain clothes, skin and a room seldom have as many."""


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
    detected: bool = False
    """Whether it has a file of keypoints."""
    hues: int | None = None
    """Number of hues of its strong colors; None where it was not sampled."""

    @property
    def evidence(self) -> tuple[str, ...]:
        """The kinds of evidence that it seems to have, but for contours, which every clip has."""
        colored = self.hues is not None and self.hues >= GARMENT_HUES
        return (MARKERS,) * colored + (KEYPOINTS,) * self.detected


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
    def colored(self) -> bool:
        """Whether strongly colored garments seem to be worn in any clip."""
        return any(MARKERS in clip.evidence for clip in self.clips)

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
        posed, detected = (
            sidecar_file(take.path, ending).exists() for ending in (KEYFRAME_FILE, KEYPOINT_FILE)
        )
        seen.append(SurveyedClip(take.name, clip.size, fps, clip.frame_count, posed, detected))
    images: dict[int, Sequence[Image]] = {}
    chosen = _spread(len(opened), COLORED_CLIPS)
    for done, index in enumerate(chosen):
        yield 0.8 + 0.2 * done / len(chosen)
        images[index] = run(sample_spread_frames(opened[index], COLORED_FRAMES)).images
        seen[index] = replace(seen[index], hues=len({one.hue for one in strong_colors(images[index])}))
    yield 1.0
    # Of the clips that show garments, where there are any.
    shown = [index for index in chosen if MARKERS in seen[index].evidence] or chosen
    listed = [image for one in _spread(len(shown), LISTED_CLIPS) for image in images[shown[one]]]
    return ClipSurvey(tuple(seen), tuple(described), tuple(unreadable), strong_colors(listed))


def _spread(count: int, most: int) -> list[int]:
    """At most so many indices, spread evenly over all."""
    return list(range(count))[:: max(-(-count // most), 1)]


def _is_described(take: ShootTake) -> bool:
    return (take.path / TAKE_FILE).exists() or sidecar_file(take.path, TAKE_FILE).exists()
