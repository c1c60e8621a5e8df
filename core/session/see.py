"""See: the keypoints of everybody in the clip, of files or of the pose network, held against the pictures."""

from dataclasses import replace
from functools import lru_cache

from ..detect.closer_look import CloserLook
from ..detect.keypoints import People, SeenPeople
from ..detect.picture_check import applied, check_by_pictures
from ..detect.pose_network import NAME, PoseNetwork
from ..detect.pose_tracking import find_people
from ..errors import InputError, pluralize
from ..markers.reading import Reading
from ..progress import Job, stretch, within
from ..take.clip_check import open_footage
from ..take.performer_keypoints import FEWEST_KEYFRAMES, people_of
from ..take.take import Take, with_evidence
from ..video.frame_checks import FrameFindings
from .made import Sight, WatchedReading
from .session import Inputs, Session, Stage

SEEN = 0.95
"""Share of the stage after which everybody is detected."""


def see(session: Session) -> Job[Sight]:
    """Detect everybody where that is wanted, and check whom others have detected."""
    inputs, take, reading = session.inputs, session.inputs.take, session[Reading]
    if inputs.detects:
        people = reading.people if isinstance(reading, WatchedReading) else None
        if people is None:
            clip = open_footage(take.clip, take.fps, take.camera.resolution)
            job = find_people(clip, PoseNetwork(), CloserLook(inputs.network, inputs.hands))
            people = yield from stretch(job, 0.0, SEEN)
        take = replace(take, keypoints=(people,))
    if inputs.evidence is not None:
        take = with_evidence(take, inputs.evidence)
    checked = yield from stretch(checked_keypoints(take, reading), SEEN, 1.0)
    if inputs.performer is not None:
        checked = tuple(people_of(people, inputs.performer, take.fps) for people in checked)
    return Sight(take.keypoints, checked)


def _uses(inputs: Inputs) -> tuple[object, ...]:
    posed = sum(key.is_posed for key in inputs.take.keyframes) >= FEWEST_KEYFRAMES
    sees = inputs.performer, inputs.detects, *inputs.closer
    return (*sees, inputs.evidence, inputs.take.keypoints, posed)


STAGE = Stage("see", see, _uses, lambda inputs: 4.5 if inputs.detects and inputs.kept is not None else 0.1)


def people_in_words(people: People) -> str:
    """In how many frames somebody is seen."""
    who = "somebody" if people.most_people == 1 else f"up to {people.most_people} people"
    by = " and ".join(dict.fromkeys(people.sources))
    return f"{who} in {people.seen_frames} of {pluralize(len(people.frames), 'frame')}, by {by}"


# --- Keypoints held against the pictures of their clip, before anything is made of them


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
