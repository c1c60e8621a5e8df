"""Reconstruct: the motion between the keyframes, by the footage."""

from ..estimate.reconstruct import Reconstruction, reconstruct
from ..progress import Job
from .pose import Posed
from .session import Session, Stage


def make_motion(session: Session) -> Job[Reconstruction]:
    """Reconstruct the motion from all that is seen and posed."""
    inputs, posed = session.inputs, session[Posed]
    return (yield from reconstruct(posed.seen, inputs.method, posed.referred, floor_m=posed.floor_m))


STAGE = Stage("reconstruct", make_motion, lambda inputs: (inputs.method,), lambda _inputs: 2.5)
