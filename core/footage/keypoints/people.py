"""People: the keypoints of everyone whom a source saw, before it is known who the performer is."""

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Array


@dataclass(frozen=True, eq=False)
class SeenPeople:
    """One source's people of one frame, H of them; a person may be missing in any frame."""

    pixel: Array
    """(H, N, 2) [px] of the clip, NaN where not seen."""
    score: Array
    """(H, N) 0 to 1, 0 where not seen."""
    hint_m: Array
    """(H, N, 3) as in `Keypoints`."""


@dataclass(frozen=True, eq=False)
class People:
    """Everyone whom a source saw in F frames, with N body points each."""

    names: tuple[str, ...]
    """(N,) the body points."""
    source: str
    """What saw them: the name of the detector, or of the file."""
    size: tuple[int, int]
    """Width and height of the pictures they were seen in [px]."""
    frames: tuple[SeenPeople, ...]
    """Those of each frame of the clip, none or several."""
    file: str = ""
    """The file they were read from, for sentences; empty where there is none."""
    by_hand: bool = False
    """Whether a person placed the points: clicks and Blender's tracks, which are all the performer's."""
    notes: tuple[str, ...] = ()
    """Sentences on what was taken for granted or mended."""

    @property
    def most_people(self) -> int:
        """Largest number of people in a frame."""
        return max((len(frame.pixel) for frame in self.frames), default=0)

    @property
    def seen_frames(self) -> int:
        """Number of frames in which anybody is seen."""
        return sum(len(frame.pixel) > 0 for frame in self.frames)

    def without_hints(self) -> "People":
        """The same people without the guess of the points in space."""
        frames = tuple(replace(frame, hint_m=np.full(frame.hint_m.shape, np.nan)) for frame in self.frames)
        return replace(self, frames=frames)
