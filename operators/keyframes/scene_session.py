"""The scene's take as a session: Blender says what its stages start from, and keeps what they have made."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from bpy.types import PropertyGroup, Scene

from ...core.arrays import Array
from ...core.body.actor import Actor
from ...core.camera.camera import Camera
from ...core.progress import Job, stretch
from ..bridge.footage import read_camera
from ..bridge.scene_frames import scene_frames
from ..follow.evidence import scene_evidence
from ..shell.results import MADE, reading_of
from ..shell.take_state import digest_of
from ..shell.takes import footage_of

if TYPE_CHECKING:
    from ...core.session.session import Session
    from ..bridge.keyframes import Matches

READ = 0.1
"""Share of a job after which the scene is read."""


@dataclass(frozen=True, eq=False)
class SceneSession:
    """A session of a scene's take."""

    take: str  # The take's identifier
    session: "Session"
    notes: tuple[str, ...] = ()  # Sentences for the animator
    keyframes: str = ""  # Digest of those it was read with; of those that are there later where empty

    @property
    def frames(self) -> Array:
        """(F,) scene frames of the clip's, once that was read."""
        from ...core.markers.reading import Reading

        take = self.session.inputs.take
        return scene_frames(self.session[Reading].tracks.time_s, take.frame_start, take.fps)


def clip_session(
    scene: Scene, settings: PropertyGroup, camera: Camera | None = None, **wanted: Any
) -> Job[SceneSession]:
    """Read what the session of a take starts from before there is an actor: it is of average proportions.

    `camera` is the scene's where None. `wanted`: further fields of core's `Inputs`.
    """
    from ...core.body.kinematics import Body
    from ...core.session.session import Inputs, Session
    from ..bridge.take_from_scene import clip_frames, scene_take

    identifier, body = settings.identifier, Body(Actor.from_stature(settings.stature))
    footage, evidence, kept = footage_of(scene, settings), scene_evidence(settings), reading_of(settings)
    frames = yield from clip_frames(footage, evidence, kept)
    take = scene_take(footage, evidence, frames, body, camera or read_camera(footage, frames))
    hands = bool(settings.follow.use_hands)
    inputs = Inputs(take, **{"kept": kept, "hands": hands, **settings.part.inputs, **wanted})
    return SceneSession(identifier, Session(inputs))


def read_session(
    scene: Scene, settings: PropertyGroup, matches: "Matches", **wanted: Any
) -> Job[SceneSession]:
    """Read what the session of a take starts from; the scene stays as it is.

    Keyframes among `matches` count as found. `wanted`: further fields of core's `Inputs`.
    """
    from ...core.session.session import Inputs, Session
    from ..bridge.take_from_scene import read_scene_take

    identifier = settings.identifier
    kept, floor_m = reading_of(settings), settings.matching.known_floor_m
    source, actor, keys = footage_of(scene, settings), settings.armature, settings.keyframe_action
    digest = digest_of(keys)
    take, notes = yield from read_scene_take(source, actor, keys, scene_evidence(settings), matches, kept)
    hands = bool(settings.follow.use_hands)
    part = settings.part.inputs
    inputs = Inputs(take, **{"floor_m": floor_m, "kept": kept, "hands": hands, **part, **wanted})
    return SceneSession(identifier, Session(inputs), notes, digest)


def go_on(
    made: SceneSession, last: str, keep: "Callable[[str, SceneSession], None]" = lambda _stage, _made: None
) -> Job[SceneSession]:
    """The session after all stages up to `last`; those with the same input as before are not run again."""
    from ...core.session.stages import reach

    reached = reach(made.session, last, MADE, lambda stage, now: keep(stage, replace(made, session=now)))
    session = yield from stretch(reached, READ, 1.0)
    return replace(made, session=session)
