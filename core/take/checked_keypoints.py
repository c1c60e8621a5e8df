"""A take's keypoints held against the pictures of its clip, before anything is made of them."""

from dataclasses import replace
from functools import lru_cache

from ..detect.keypoints import People, SeenPeople
from ..detect.picture_check import PictureFinding, applied, check_by_pictures
from ..detect.pose_network import NAME, PoseNetwork
from ..errors import InputError
from ..files.digest import digest
from ..markers.reading import Reading
from ..progress import Job, within
from ..video.frame_checks import FrameFindings
from .performer_keypoints import FEWEST_KEYFRAMES
from .take import Take

CHECKING = "Checking the keypoints"
MOST_KNOWN = 8  # findings that are remembered: those of the takes at hand
_known: dict[str, PictureFinding] = {}


def with_checked_keypoints(take: Take, reading: Reading, done: float = 0.0) -> Job[Take]:
    """The take with its keypoints as the pictures say that they are meant, each picture's once.

    `done` is the fraction done before; looking takes a second or two.

    Pictures are not asked where posed keyframes tell (see `estimate/keypoint_trust`), of points that a person
    has placed or that the pose network has just found in them, and without the network.

    Raises:
        InputError: Keypoints are not of this clip.
    """
    checked = []
    posed = sum(keyframe.is_posed for keyframe in take.keyframes)
    if reading.steady is not None:  # places are no longer the clip's own, and were checked before
        return take
    is_asked = [not (each.by_hand or each.looked or _is_own(each)) for each in take.keypoints]
    network = _network() if any(is_asked) and posed < FEWEST_KEYFRAMES else None
    for people, asked in zip(take.keypoints, is_asked, strict=True):
        if network is not None and reading.glimpses is not None and asked:
            key = digest(reading.key, people.names, *_arrays(people))
            if key not in _known or not reading.key:
                job = check_by_pictures(people, reading.glimpses, network, take.fps)
                _known[key] = yield from within(CHECKING, job, done, done)
                for oldest in list(_known)[:-MOST_KNOWN]:
                    del _known[oldest]
            people = applied(people, _known[key])
        checked.append(_each_once(people, reading.frame_findings))
    return replace(take, keypoints=tuple(checked))


def _is_own(people: People) -> bool:
    return people.source == NAME and not people.file


@lru_cache(maxsize=1)
def _network() -> PoseNetwork | None:
    try:
        return PoseNetwork()
    except InputError:  # detecting says what is wrong with it
        return None


def _arrays(people: People) -> list[object]:
    return [array for frame in people.frames for array in (frame.pixel, frame.score)]


def _each_once(people: People, findings: FrameFindings) -> People:
    """The people without those of repeated pictures, which show no other moment."""
    again = {index for index in findings.repeated if index < len(people.frames)}
    if not again or people.by_hand:
        return people
    nobody = SeenPeople.nobody(len(people.names))
    frames = tuple(nobody if index in again else frame for index, frame in enumerate(people.frames))
    return replace(people, frames=frames)
