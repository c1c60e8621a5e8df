"""Reconstruct: the motion between the keyframes, by the footage."""

from dataclasses import replace

from ..estimate.reconstruct import Reconstruction, reconstruct
from ..feet.palms import seen_hands
from ..progress import Job
from .pose import Posed
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
    return replace(made, motion=replace(motion, posture=posture, hands=hands))


STAGE = Stage("reconstruct", make_motion, lambda inputs: (inputs.method, inputs.hands), lambda _inputs: 2.0)
