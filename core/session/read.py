"""Read: one pass over the clip for all later stages, in which the pose network may look at it, too."""

from ..detect.closer_look import CloserLook
from ..detect.pose_network import PoseNetwork
from ..detect.pose_tracking import DETECTING, PeopleFinder
from ..estimate.reconstruct import check_method
from ..markers.reading import Reading, reading_key
from ..progress import Job
from ..take.clip_check import open_footage
from ..take.read_footage import read_footage
from .made import WatchedReading
from .session import Inputs, Session, Stage


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


def _uses(inputs: Inputs) -> tuple[object, ...]:
    take = inputs.take
    expected = (take.keyframes, take.body.actor.segments_m, take.camera) if take.markers else ()
    key = reading_key(take.clip, take.fps, take.markers, None, take.ignored_regions)
    clip = take.fps, take.frame_start, take.frame_count, take.camera.resolution, take.camera.is_moving
    return key, clip, take.contours, expected, *inputs.closer


STAGE = Stage("read", read, _uses, lambda inputs: 5.5 if inputs.detects and inputs.kept is None else 1.5)
