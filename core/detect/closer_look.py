"""A closer look at the people of a clip: how heads and hands turn, by networks that see these alone."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TypeVar

from ..arrays import Image
from ..errors import InputError
from .face import FaceNetwork
from .families.beside import Beside
from .families.network import Network
from .hands import HandNetwork
from .keypoints import no_hands
from .pose_network import Pose, in_parallel

Part = TypeVar("Part")


class CloserLook:
    """The networks, as far as they are there."""

    def __init__(self, network: Network | None = None, hands: bool = True) -> None:
        self.beside = None if network is None else Beside(network)
        """One of somebody's own, which looks at all of them."""
        self._face = _there(FaceNetwork)
        self._hands = _there(HandNetwork) if hands else None
        self._looks_at_hands = hands

    def __call__(self, looks: Sequence[tuple[Image, Pose, bool]]) -> list[Pose]:
        """The poses of people in pictures with their faces, where it is wanted with their hands.

        Behind their points are another network's.
        """
        poses = in_parallel(lambda look: self._seen(*look), looks)
        if self.beside is not None:
            poses = self.beside([picture for picture, *_ in looks], poses)
            wanted = [self._looks_at_hands and hands for *_, hands in looks]
            pairs = zip(poses, wanted, strict=True)
            poses = [pose if hands else replace(pose, hands=no_hands()) for pose, hands in pairs]
        return poses

    def _seen(self, picture: Image, pose: Pose, wanted: bool) -> Pose:
        if self._face is not None:
            pose = replace(pose, face=self._face(picture, pose))
        if self._hands is not None and wanted:
            pose = replace(pose, hands=self._hands(picture, pose))
        return pose


def _there(network: Callable[[], Part]) -> Part | None:
    """A network; None where it cannot be had, and all else works."""
    try:
        return network()
    except InputError:
        return None
