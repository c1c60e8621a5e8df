"""See: the keypoints of everybody in the clip, of files or of the pose network, held against the pictures."""

from dataclasses import dataclass, replace

from ..detect.keypoints import People
from ..detect.pose_network import PoseNetwork
from ..detect.pose_tracking import find_people
from ..errors import pluralize
from ..markers.reading import Reading
from ..progress import Job, stretch
from ..take.checked_keypoints import checked_keypoints
from ..take.clip_check import open_footage
from ..take.performer_keypoints import FEWEST_KEYFRAMES
from ..take.take import with_evidence
from .session import Inputs, Session, Stage

SEEN = 0.95
"""Share of the stage after which everybody is detected."""


@dataclass(frozen=True, eq=False)
class Sight:
    """Everybody in the clip, by each source of keypoints."""

    people: tuple[People, ...]
    """As they were read or detected."""
    checked: tuple[People, ...]
    """As the pictures say that they are meant."""


def see(session: Session) -> Job[Sight]:
    """Detect everybody where that is wanted, and check whom others have detected."""
    inputs, take = session.inputs, session.inputs.take
    if inputs.detects:
        job = find_people(open_footage(take.clip, take.fps, take.camera.resolution), PoseNetwork())
        take = replace(take, keypoints=((yield from stretch(job, 0.0, SEEN)),))
    if inputs.evidence is not None:
        take = with_evidence(take, inputs.evidence)
    checked = yield from stretch(checked_keypoints(take, session[Reading]), SEEN, 1.0)
    return Sight(take.keypoints, checked)


def _uses(inputs: Inputs) -> tuple[object, ...]:
    posed = sum(key.is_posed for key in inputs.take.keyframes) >= FEWEST_KEYFRAMES
    return inputs.detects, inputs.evidence, inputs.take.keypoints, posed


STAGE = Stage("see", see, _uses, lambda inputs: 4.0 if inputs.detects else 0.2)


def people_in_words(people: People) -> str:
    """In how many frames somebody is seen."""
    who = "somebody" if people.most_people == 1 else f"up to {people.most_people} people"
    return f"{who} in {people.seen_frames} of {pluralize(len(people.frames), 'frame')}, by {people.source}"
