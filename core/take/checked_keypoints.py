"""A take's keypoints held against the pictures of its clip, before anything is made of them."""

from dataclasses import replace
from functools import lru_cache

from ..detect.keypoints import People, SeenPeople
from ..detect.picture_check import applied, check_by_pictures
from ..detect.pose_network import NAME, PoseNetwork
from ..errors import InputError
from ..markers.reading import Reading
from ..progress import Job, within
from ..video.frame_checks import FrameFindings
from .performer_keypoints import FEWEST_KEYFRAMES
from .take import Take


def checked_keypoints(take: Take, reading: Reading) -> Job[tuple[People, ...]]:
    """A take's keypoints as the pictures say that they are meant, each picture's once.

    Pictures are not asked where posed keyframes tell (see `estimate/keypoint_trust`), of points that a person
    has placed or that the pose network has just found in them, and without the network.

    Raises:
        InputError: Keypoints are not of this clip.
    """
    checked = []
    posed = sum(keyframe.is_posed for keyframe in take.keyframes)
    is_asked = [not (each.by_hand or each.looked or _is_own(each)) for each in take.keypoints]
    network = _network() if any(is_asked) and posed < FEWEST_KEYFRAMES else None
    for people, asked in zip(take.keypoints, is_asked, strict=True):
        if network is not None and reading.glimpses is not None and asked:
            job = check_by_pictures(people, reading.glimpses, network, take.fps)
            people = applied(people, (yield from within("Checking the keypoints", job, 0.0, 1.0)))
        checked.append(_each_once(people, reading.frame_findings))
    return tuple(checked)


def _is_own(people: People) -> bool:
    return people.source == NAME and not people.file


@lru_cache(maxsize=1)
def _network() -> PoseNetwork | None:
    try:
        return PoseNetwork()
    except InputError:  # detecting says what is wrong with it
        return None


def _each_once(people: People, findings: FrameFindings) -> People:
    """The people without those of repeated pictures, which show no other moment."""
    again = {index for index in findings.repeated if index < len(people.frames)}
    if not again or people.by_hand:
        return people
    nobody = SeenPeople.nobody(len(people.names))
    frames = tuple(nobody if index in again else frame for index, frame in enumerate(people.frames))
    return replace(people, frames=frames)
