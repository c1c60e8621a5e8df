"""The scene's take as a session: Blender says what its stages start from, and keeps what they have made."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from bpy.types import PropertyGroup, Scene

from ...core.arrays import Array
from ...core.body.actor import Actor
from ...core.body.kinematics import Body
from ...core.camera.camera import Camera
from ...core.progress import Job, stretch
from ..bridge.footage import read_camera
from ..bridge.keyframes import Matches
from ..bridge.scene_frames import scene_frames
from ..follow.evidence import scene_evidence
from ..shell.results import MADE, reading_of
from ..shell.take_state import digest_of
from ..shell.takes import footage_of

if TYPE_CHECKING:
    from ...core.session.session import Session

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


def read_session(
    scene: Scene,
    settings: PropertyGroup,
    matches: Matches | None = None,
    camera: Camera | None = None,
    **wanted: Any,
) -> Job[SceneSession]:
    """The session of a take; keyframes among `matches` count as found, `wanted` are fields of `Inputs`.

    Without matches it is as before there is an actor: the performer is of average proportions, and `camera`
    may be another than the scene's.
    """
    from ...core.session.session import Inputs, Session
    from ..bridge.take_from_scene import clip_frames, read_scene_take, scene_take

    identifier, digest = settings.identifier, ""
    notes: tuple[str, ...] = ()
    footage, evidence, kept = footage_of(scene, settings), scene_evidence(settings), reading_of(settings)
    if matches is None:
        body = Body(Actor.from_stature(settings.stature))
        frames = yield from clip_frames(footage, evidence, kept)
        take = scene_take(footage, evidence, frames, body, camera or read_camera(footage, frames))
    else:
        actor, keys = settings.armature, settings.keyframe_action
        digest, wanted = digest_of(keys), {"floor_m": settings.matching.known_floor_m, **wanted}
        take, notes = yield from read_scene_take(footage, actor, keys, evidence, matches, kept)
    hands = bool(settings.follow.use_hands)
    inputs = Inputs(take, **{"kept": kept, "hands": hands, **settings.part.inputs, **wanted})
    return SceneSession(identifier, Session(inputs), notes, digest)


def go_on(
    made: SceneSession, last: str, keep: Callable[[str, SceneSession], None] = lambda _stage, _made: None
) -> Job[SceneSession]:
    """The session after all stages up to `last`; those with the same input as before are not run again."""
    from ...core.session.stages import reach

    reached = reach(made.session, last, MADE, lambda stage, now: keep(stage, replace(made, session=now)))
    session = yield from stretch(reached, READ, 1.0)
    return replace(made, session=session)
