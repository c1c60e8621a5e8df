"""The lens of a camera that nobody has placed: as it is described, as the clip states it, or a guess."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..camera.camera import Camera, default_camera_pose, guess_lens, lens_of_equivalent
from ..video.header import stated_lens_mm


@dataclass(frozen=True)
class Lens:
    """A lens before anything is found."""

    lens_mm: float
    sensor_width_mm: float
    source: str
    """Who says so, in brackets after its number."""
    is_known: bool

    def put(self, size: tuple[int, int]) -> Camera:
        """A camera with this lens where cameras usually stand, for a picture of this size [px]."""
        pose = default_camera_pose(self.lens_mm, self.sensor_width_mm, size)
        return Camera(self.lens_mm, self.sensor_width_mm, size, pose)


def lens_of(path: Path, size: tuple[int, int], said: object = None, where: str = "") -> Lens:
    """The lens that a description says, else the one that the clip states, else a guess by its size [px]."""
    if isinstance(said, Mapping) and said.get("lens_mm") is not None:
        pose = np.eye(4).tolist()
        given = Camera.from_dict({**said, "resolution": list(size), "matrix_world": pose}, f"{where}: camera")
        return Lens(given.lens_mm, given.sensor_width_mm, "as described", True)
    stated_mm = stated_lens_mm(path)
    if stated_mm is not None:
        return Lens(*lens_of_equivalent(stated_mm, size), f"the clip states {stated_mm:g} mm", True)
    guess = guess_lens(size)
    return Lens(guess.lens_mm, guess.sensor_width_mm, f"a guess, as of {guess.reason}", False)
