"""A closer look at the people of a clip: how heads turn, by networks that see a part of the body alone."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import cv2

from ..arrays import Image
from ..errors import InputError
from .face import FaceNetwork
from .pose_network import MOST_AT_ONCE, Pose


class CloserLook:
    """The networks, as far as they are there."""

    def __init__(self) -> None:
        try:
            self._face: FaceNetwork | None = FaceNetwork()
        except InputError:  # all else works without it
            self._face = None

    def __call__(self, looks: Sequence[tuple[Image, Pose]]) -> list[Pose]:
        """The poses of people in pictures, with their faces."""
        face = self._face
        if face is None:
            return [pose for _, pose in looks]
        with ThreadPoolExecutor(max(1, min(cv2.getNumThreads(), MOST_AT_ONCE))) as pool:
            faces = pool.map(lambda look: face(*look), looks)
            return [replace(pose, face=own) for (_, pose), own in zip(looks, faces, strict=True)]
