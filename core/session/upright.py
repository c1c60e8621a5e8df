"""A picture on its side or upside down, noticed once people are detected, so that the clip can be turned."""

from dataclasses import replace

from ..detect.picture_turn import picture_turn
from ..detect.pose_network import PoseNetwork
from ..detect.standing_moments import turned_note
from ..take.clip_check import open_footage
from ..take.performer_keypoints import performer_keypoints
from .made import Sight
from .session import Session

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
