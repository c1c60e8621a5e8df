"""Reconstruct: the motion between the keyframes, by the footage."""

from dataclasses import replace

import numpy as np

from ..body.fingers import SURE, Hands
from ..estimate.reconstruct import Reconstruction, reconstruct
from ..feet.palms import seen_hands
from ..progress import Job
from .made import Posed
from .session import Session, Stage


def make_motion(session: Session) -> Job[Reconstruction]:
    """Reconstruct the motion from all that is seen and posed."""
    inputs, posed = session.inputs, session[Posed]
    made = yield from reconstruct(posed.seen, inputs.method, posed.referred, floor_m=posed.floor_m)
    if not inputs.hands:
        return made
    motion, take = made.motion, posed.seen.take
    own = [key.index for key in take.keyframes if key.is_posed]
    posture, hands = seen_hands(motion.body, motion.posture, motion.time_s, made.keypoints, take.camera, own)
    notes = made.notes if hands is None else (*made.notes, hands_in_words(hands))
    return replace(made, motion=replace(motion, posture=posture, hands=hands), notes=notes)


def hands_in_words(hands: Hands) -> str:
    """In how many frames hands are surely seen."""
    left, right = np.round(100.0 * (hands.sure > SURE).mean(axis=0))
    return f"The left hand is surely seen in {left:.0f} % of the frames, the right in {right:.0f} %"


STAGE = Stage("reconstruct", make_motion, lambda inputs: (inputs.method, inputs.hands), lambda _inputs: 2.0)
