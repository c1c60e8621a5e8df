"""What stages make, a class each, by which later stages and those who show it ask for it."""

from dataclasses import dataclass, replace

from ..camera.camera_evidence import RoomView
from ..camera.camera_fit import CameraFit
from ..detect.keypoints import People
from ..estimate.reference_evidence import NoReference, ReferenceEvidence
from ..markers.reading import Reading
from ..poses.found_poses import FoundPoses
from ..take.seen_take import SeenTake
from .lens import Lens
from .session import Session


@dataclass(frozen=True, eq=False)
class WatchedReading(Reading):
    """A reading, and everybody whom the pose network saw in the same pass."""

    people: People | None = None


@dataclass(frozen=True, eq=False)
class Sight:
    """Everybody in the clip, by each source of keypoints."""

    people: tuple[People, ...]
    """As they were read or detected."""
    checked: tuple[People, ...]
    """As the pictures say that they are meant."""


@dataclass(frozen=True, eq=False)
class FoundCamera:
    """What a camera was found by."""

    fit: CameraFit | None
    """None where nothing tells it."""
    lens: Lens
    moments: int
    """In which the performer is upright."""
    room: RoomView | None = None
    """None where too few straight lines are seen."""


@dataclass(frozen=True, eq=False)
class Placed:
    """A take that is seen from where its camera stands."""

    seen: SeenTake
    camera: FoundCamera | None = None
    """None where the camera's place was known."""


@dataclass(frozen=True, eq=False)
class Posed:
    """A take with all its keyframes."""

    seen: SeenTake
    floor_m: float | None
    """Height of the floor [m]; None where it is not known."""
    found: FoundPoses | None = None
    """What was found; None where that was not wanted."""
    referred: ReferenceEvidence | NoReference | None = None
    """What the take's reference motion tells; None without one."""


def placed_take(session: Session) -> SeenTake:
    """The session's take as it was placed: what it is to be posed with may have changed since."""
    seen, take = session[Placed].seen, session.inputs.take
    take = replace(take, camera=seen.take.camera, keypoints=seen.take.keypoints)
    return replace(seen, take=replace(take, reference=take.reference or seen.take.reference))
