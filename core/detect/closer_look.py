"""A closer look at the people of a clip: how heads turn, by networks that see a part of the body alone."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import cv2

from ..arrays import Image
from ..errors import InputError
from .face import FaceNetwork
from .families.beside import Beside
from .families.network import Network
from .pose_network import MOST_AT_ONCE, Pose


class CloserLook:
    """The networks, as far as they are there."""

    def __init__(self, network: Network | None = None) -> None:
        self.beside = None if network is None else Beside(network)
        """One of somebody's own, which looks at all of them."""
        try:
            self._face: FaceNetwork | None = FaceNetwork()
        except InputError:  # all else works without it
            self._face = None

    def __call__(self, looks: Sequence[tuple[Image, Pose]]) -> list[Pose]:
        """The poses of people in pictures with their faces, and behind their points another network's."""
        poses = [pose for _, pose in looks]
        face = self._face
        if face is not None:
            with ThreadPoolExecutor(max(1, min(cv2.getNumThreads(), MOST_AT_ONCE))) as pool:
                faces = pool.map(lambda look: face(*look), looks)
                poses = [replace(pose, face=own) for pose, own in zip(poses, faces, strict=True)]
        if self.beside is not None:
            poses = self.beside([picture for picture, _ in looks], poses)
        return poses
