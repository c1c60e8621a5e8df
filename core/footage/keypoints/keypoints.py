"""Keypoints of the performer: where in the image points of the body are seen, frame by frame."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Array, BoolArray
from .body_points import BODY_POINTS


@dataclass(frozen=True, eq=False)
class Keypoints:
    """N keypoints of one person in F frames; NaN where one is not seen."""

    names: tuple[str, ...]
    """(N,) the body point each shows; two sources may show the same one."""
    sources: tuple[str, ...]
    """(N,) what saw each: a detector, Blender's tracks, a person."""
    pixel: Array
    """(F, N, 2) [px] of the clip, origin at the outer corner of the top left pixel."""
    score: Array
    """(F, N) the source's confidence, 0 to 1; 0 where not seen."""
    hint_m: Array
    """(F, N, 3) a network's guess of the points in space [m]: x right, y down, z away from the camera, origin
    between the hips; NaN where there is none."""
    notes: tuple[str, ...] = ()
    """Sentences on who of several people was taken, and on what the sources' files leave open."""

    def __post_init__(self) -> None:
        """Check names and shapes and keep own, read-only copies.

        Raises:
            ValueError: A name is unknown, or shapes disagree.
        """
        unknown = set(self.names) - set(BODY_POINTS)
        if unknown:
            raise ValueError(f"unknown body points {sorted(unknown)}")
        if len(self.sources) != len(self.names):
            raise ValueError(f"{len(self.sources)} sources for {len(self.names)} keypoints")
        frames, count = len(self.pixel), len(self.names)
        shapes = {"pixel": (frames, count, 2), "score": (frames, count), "hint_m": (frames, count, 3)}
        for name, shape in shapes.items():
            array = np.array(getattr(self, name), dtype=np.float64)
            if array.shape != shape:
                raise ValueError(f"{name} has the shape {array.shape}, not {shape}")
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    @classmethod
    def none(cls, frames: int) -> "Keypoints":
        """No keypoint at all, N = 0."""
        empty = np.zeros((frames, 0))
        return cls((), (), np.zeros((frames, 0, 2)), empty, np.zeros((frames, 0, 3)))

    @classmethod
    def side_by_side(cls, parts: Sequence["Keypoints"], frames: int) -> "Keypoints":
        """All keypoints of several sources of the same clip, in order."""
        if not parts:
            return cls.none(frames)
        return cls(
            tuple(name for part in parts for name in part.names),
            tuple(source for part in parts for source in part.sources),
            np.concatenate([part.pixel for part in parts], axis=1),
            np.concatenate([part.score for part in parts], axis=1),
            np.concatenate([part.hint_m for part in parts], axis=1),
            tuple(note for part in parts for note in part.notes),
        )

    def frame(self, index: int) -> "Keypoints":
        """The keypoints of one frame."""
        own = slice(index, index + 1)
        return replace(self, pixel=self.pixel[own], score=self.score[own], hint_m=self.hint_m[own])

    @property
    def frame_count(self) -> int:
        """Number of frames F."""
        return len(self.pixel)

    @property
    def seen(self) -> BoolArray:
        """(F, N) whether each keypoint is seen in each frame."""
        return np.asarray(np.isfinite(self.pixel).all(axis=-1))

    @property
    def has_hints(self) -> bool:
        """Whether any depth is guessed."""
        return bool(np.isfinite(self.hint_m).any())

    def without_hints(self) -> "Keypoints":
        """The same keypoints without the guess of the points in space."""
        return replace(self, hint_m=np.full(self.hint_m.shape, np.nan))
