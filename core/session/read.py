"""Read: one pass over the clip, for all later stages."""

from ..estimate.reconstruct import check_method
from ..markers.reading import Reading, reading_key
from ..progress import Job
from ..take.read_footage import read_footage
from .session import Inputs, Session, Stage


def read(session: Session) -> Job[Reading]:
    """Read the clip, or what is still known of it; the method is checked before this takes its time."""
    check_method(session.inputs.take, session.inputs.method)
    return (yield from read_footage(session.inputs.take, session.inputs.kept))


def _uses(inputs: Inputs) -> tuple[object, ...]:
    take = inputs.take
    expected = (take.keyframes, take.body.actor.segments_m, take.camera) if take.markers else ()
    key = reading_key(take.clip, take.fps, take.markers, None, take.ignored_regions)
    clip = take.fps, take.frame_start, take.frame_count, take.camera.resolution, take.camera.is_moving
    return key, clip, take.contours, expected


STAGE = Stage("read", read, _uses, lambda _inputs: 2.0)
