"""A session: what the way of a take starts from, and what its stages make of that, a class each.

A stage is a pure generator from a session to one result, of a class of its own by which later stages ask for
it. The digest of all that a result depends on tells whether it was made before.
"""

from collections.abc import Callable, Mapping, MutableMapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

import numpy as np

from ..body.posture import Posture
from ..camera.camera import Lens
from ..camera.camera_evidence import RoomView
from ..camera.camera_fit import CameraFit
from ..detect.families.network import Network
from ..detect.keypoints import People
from ..estimate.reference_evidence import NoReference, ReferenceEvidence
from ..files.digest import digest
from ..markers.reading import Reading
from ..poses.found_poses import FoundPoses
from ..prior.library import Library
from ..progress import Job, stretch
from ..take.conversion_settings import METHODS
from ..take.presence import SeenTake
from ..take.take import Take

Result = TypeVar("Result")


Bridge = Mapping[str, Callable[["Session"], Job[Any]]]
NO_BRIDGE: Bridge = MappingProxyType({})


@dataclass(frozen=True, eq=False)
class Inputs:
    """What a session starts from, read from files or from a scene."""

    take: Take
    method: str = METHODS[0]
    detects: bool = False
    """Whether the pose network is to see the performer, in place of the take's keypoints."""
    network: Network | None = None
    """One of somebody's own that looks beside it."""
    hands: bool = True
    """Whether palms face where hands are seen."""
    evidence: tuple[str, ...] | None = None
    """Kinds of evidence that are used, also of what is detected; None for all there are."""
    open_lens: Lens | None = None
    """Of a camera that is to be found; None where its place is known."""
    libraries: Sequence[Library] | None = None
    """In which poses are found; None where the take has its keyframes already."""
    floor_m: float | None = None
    """Height of the floor [m] where it is known."""
    floor_open: bool = False
    """Whether the poses tell where the floor is, and the world is moved so that it is there, else z = 0."""
    shot: tuple[int, int] | None = None
    """First and last frame of the part that is animated; None for all, or one shot of an edited clip."""
    performer: int | None = None
    """Who of several people performs, counted from the left; None for whom the take or its size shows."""
    frames: tuple[int, ...] | None = None
    """Frames to find keyframes at; None for those in which the performer rests or turns back."""
    keyframe_count: int | None = None
    """How many of these; 10 per 100 frames where None."""
    kept: Reading | None = None
    """A reading of any clip, whose parts are used that still hold."""
    bridge: Bridge = field(default_factory=dict)
    """Stages that only Blender can do, by name, and how; those left out are not done."""

    @property
    def closer(self) -> tuple[object, ...]:
        """What tells a closer look at people from another: a checksum, and whether hands are seen."""
        return None if self.network is None else self.network.file.digest, self.hands


@dataclass(frozen=True, eq=False)
class Session:
    """Inputs, and the results of stages by name, in order; `key` is the digest of all they depend on."""

    inputs: Inputs
    made: Mapping[str, object] = field(default_factory=dict)
    key: str = ""

    def __getitem__(self, kind: type[Result]) -> Result:
        """The result of a class; KeyError where no stage has made one yet."""
        for made in self.made.values():
            if isinstance(made, kind):
                return made
        raise KeyError(kind.__name__)


@dataclass(frozen=True, eq=False)
class Stage:
    """A stage on the way of a take."""

    name: str
    run: Callable[[Session], Job[object]]
    uses: Callable[[Inputs], tuple[object, ...]] | None
    """What of the inputs its result depends on beside the stage before; None where that is not known."""
    work: Callable[[Inputs], float]
    """About how much work it is: seconds of a processor for three of a clip."""


def plain(value: object) -> object:
    """A value as `digest` takes it: records as their fields."""
    if isinstance(value, Posture):  # all are of one skeleton
        return value.translation, value.rotations, value.angles
    if is_dataclass(value):
        return type(value).__name__, *(plain(getattr(value, each.name)) for each in fields(value))
    if isinstance(value, Mapping):
        return tuple((plain(name), plain(each)) for name, each in value.items())
    if isinstance(value, tuple | list):
        return tuple(map(plain, value))
    if isinstance(value, np.generic):
        return value.item()
    return str(value) if isinstance(value, Path) else value


Keep = Callable[[str, Session], Job[object] | None]


def keep_nothing(_stage: str, _session: Session) -> None:
    """Nobody keeps what the stages make."""


def advance(
    session: Session,
    stages: Sequence[Stage],
    kept: MutableMapping[str, object] | None = None,
    keep: Keep = keep_nothing,
) -> Job[Session]:
    """The session after further stages.

    `keep` gets each stage's name and the session as it is complete, and may take its time for it. `kept` has
    results by the digest of what they depend on: those are not made again, and new ones are added.
    """
    ahead = [stage for stage in stages if stage.name not in session.made]
    whole, done = max(sum(stage.work(session.inputs) for stage in ahead), 1e-9), 0.0
    for stage in ahead:
        end = min(done + stage.work(session.inputs) / whole, 1.0)
        key, result = "", None
        if kept is not None and stage.uses is not None:
            key = digest(stage.name, session.key, *map(plain, stage.uses(session.inputs)))
            result = kept.get(key)
        if result is None:
            result = yield from stretch(stage.run(session), done, end)
            if kept is not None and key:
                kept[key] = result
        session, done = replace(session, made={**session.made, stage.name: result}, key=key), end
        keeping = keep(stage.name, session)
        if keeping is not None:
            yield from stretch(keeping, done, done)
    return session


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
