"""The way that was found through a library, as postures in the world."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...body.posture import Posture
from ...body.rotations import exponential
from ..interpolation import interpolate
from ..keyframes import Keyframe
from .chains import Chains
from .sights import Sight
from .sweep import Fit, Turned, places

Array = NDArray[np.float64]
Whole = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Path:
    """The best state of each of T frames."""

    chains: Chains
    states: Turned
    sights: list[Sight]
    fits: list[Fit]
    best: Whole
    """(T,) state."""

    def postures(self, row: int, states: Whole) -> Posture:
        """The postures of some states in one of the T frames, in the world."""
        posture, heading = np.divmod(states, len(self.states.heading_rad))
        place = places(self.sights[row], self.states, self.fits[row])[:, states].T
        return placed(self.chains.posture[posture], self.states.heading_rad[heading], place)


def placed(posture: Posture, heading_rad: Array, hips: Array) -> Posture:
    """Postures (N,) turned about the vertical by angles (N,) and put with their hips to places (N, 3) [m]."""
    turn = exponential(np.asarray(heading_rad)[:, None] * np.array([0.0, 0.0, 1.0]))
    rotations = np.array(posture.rotations)
    rotations[:, 0] = turn @ rotations[:, 0]
    return Posture(posture.skeleton, hips, rotations, posture.angles)


def path_postures(path: Path, frames: Whole, frame_count: int) -> Posture:
    """(F,) postures of the whole clip, from the path at its T frames."""
    keyframes = [
        Keyframe(int(frame), path.postures(row, path.best[row : row + 1])[0])
        for row, frame in enumerate(frames)
    ]
    return interpolate(keyframes, frame_count)
