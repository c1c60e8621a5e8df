"""Read and see: one pass over the clip, and the keypoints of everybody in it, held against the pictures."""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ..detect.closer_look import CloserLook
from ..detect.keypoints import People, SeenPeople
from ..detect.picture_check import applied, check_by_pictures
from ..detect.pose_network import NAME, PoseNetwork
from ..detect.pose_tracking import DETECTING, PeopleFinder, find_people
from ..detect.standing_moments import picture_turn, turned_note
from ..errors import InputError, pluralize
from ..markers.reading import Reading, reading_key
from ..progress import Job, stretch, within
from ..take.performer_keypoints import FEWEST_KEYFRAMES, people_of, performer_keypoints
from ..take.read_footage import open_footage, read_footage
from ..take.take import Take, check_method, with_evidence
from .session import Inputs, Session, Sight, Stage, WatchedReading


def read(session: Session) -> Job[Reading]:
    """Read the clip, or what is still known of it; the method is checked before this takes its time."""
    inputs = session.inputs
    take, kept = inputs.take, inputs.kept
    check_method(take, inputs.method)
    if not inputs.detects:
        return (yield from read_footage(take, kept))
    clip = open_footage(take.clip, take.fps, take.camera.resolution)
    with PeopleFinder(clip, lambda: (PoseNetwork(), CloserLook(inputs.network, inputs.hands))) as finder:
        reading = yield from read_footage(take, kept, finder.add, DETECTING)
        if not finder.count:  # it is known already, and was not decoded
            return reading
        return WatchedReading(**vars(reading), people=finder.people())


def _reads(inputs: Inputs) -> tuple[object, ...]:
    take = inputs.take
    expected = (take.keyframes, take.body.actor.segments_m, take.camera) if take.markers else ()
    key = reading_key(take.clip, take.fps, take.markers, None, take.ignored_regions)
    clip = take.fps, take.frame_start, take.frame_count, take.camera.resolution, take.camera.is_moving
    return key, clip, take.contours, expected, *inputs.closer


def _pass_work(inputs: Inputs, looks: bool) -> float:
    """Work of a pass over the clip, and of looking at its people meanwhile."""
    megapixels = float(np.prod(inputs.take.camera.resolution)) / 1e6
    return 1.6 + megapixels if looks else 0.2 + 0.5 * megapixels


READ = Stage("read", read, _reads, lambda inputs: _pass_work(inputs, inputs.detects and inputs.kept is None))

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


def _sees(inputs: Inputs) -> tuple[object, ...]:
    posed = sum(key.is_posed for key in inputs.take.keyframes) >= FEWEST_KEYFRAMES
    sees = inputs.performer, inputs.detects, *inputs.closer
    return (*sees, inputs.evidence, inputs.take.keypoints, posed)


def _see_work(inputs: Inputs) -> float:
    return _pass_work(inputs, True) if inputs.detects and inputs.kept is not None else 0.05


SEE = Stage("see", see, _sees, _see_work)


def people_in_words(people: People) -> str:
    """In how many frames somebody is seen."""
    who = "somebody" if people.most_people == 1 else f"up to {people.most_people} people"
    by = " and ".join(dict.fromkeys(people.sources))
    return f"{who} in {people.seen_frames} of {pluralize(len(people.frames), 'frame')}, by {by}"


# --- Keypoints held against the pictures of their clip, before anything is made of them


def checked_keypoints(take: Take, reading: Reading) -> Job[tuple[People, ...]]:
    """A take's keypoints as the pictures say that they are meant, each picture's once.

    Pictures are not asked of points that a person has placed or that the pose network has just found in them,
    and without the network. Where enough is posed, that tells what is of another clip (`keypoint_trust`).

    Raises:
        InputError: Keypoints are not of this clip, and too little is posed.
    """
    checked = []
    posed = sum(keyframe.is_posed for keyframe in take.keyframes) >= FEWEST_KEYFRAMES
    is_own = [each.source == NAME and not each.file for each in take.keypoints]
    is_asked = [
        not (each.by_hand or each.looked or own) for each, own in zip(take.keypoints, is_own, strict=True)
    ]
    network = _network() if any(is_asked) else None
    for people, asked in zip(take.keypoints, is_asked, strict=True):
        if network is not None and reading.glimpses is not None and asked:
            job = check_by_pictures(people, reading.glimpses, network, take.fps)
            finding = yield from within("Checking the keypoints", job, 0.0, 1.0)
            people = people if finding.refusal and posed else applied(people, finding)
        again = {index for index in reading.frame_findings.repeated if index < len(people.frames)}
        if again and not people.by_hand:  # repeated pictures show no other moment
            nobody, frames = SeenPeople.nobody(len(people.names)), enumerate(people.frames)
            people = replace(people, frames=tuple(nobody if i in again else frame for i, frame in frames))
        checked.append(people)
    return tuple(checked)


@lru_cache(maxsize=1)
def _network() -> PoseNetwork | None:
    try:
        return PoseNetwork()
    except InputError:  # detecting says what is wrong with it
        return None


# --- A picture on its side or upside down, noticed once people are detected, so that the clip can be turned


SELDOM = 0.7  # share of the frames below which so few show somebody that the picture may be turned


class PictureTurnedError(Exception):
    """People are upright in a clip only once it is turned."""

    def __init__(self, turn_deg: int) -> None:
        super().__init__(turn_deg)
        self.turn_deg = turn_deg  # clockwise


def require_upright(stage: str, session: Session) -> None:
    """Stop the way of a take whose picture is turned: a `Keep` for stages.

    Raises:
        PictureTurnedError: It is.
    """
    take = session.inputs.take
    if stage != "see" or not session.inputs.detects or not session[Sight].people:
        return
    people = session[Sight].people[0]
    own = performer_keypoints(replace(take, keyframes=(), keypoints=(people,)))
    if people.seen_frames >= SELDOM * len(people.frames) and turned_note(own) is None:
        return
    turn_deg = picture_turn(open_footage(take.clip, take.fps, take.camera.resolution), PoseNetwork())
    if turn_deg:
        raise PictureTurnedError(turn_deg)
