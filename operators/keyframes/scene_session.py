"""The scene's take as a session: Blender says what its stages start from, and keeps what they have made."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import bpy

from ...core.arrays import Array
from ...core.progress import stretch
from ..follow.evidence import scene_evidence
from ..shell.results import MADE, reading_of
from ..shell.takes import footage_of

if TYPE_CHECKING:
    from ...core.progress import Job
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

    @property
    def frames(self) -> Array:
        """(F,) scene frames of the clip's, once that was read."""
        from ...core.markers.reading import Reading
        from ..bridge.scene_frames import scene_frames

        take = self.session.inputs.take
        return scene_frames(self.session[Reading].tracks.time_s, take.frame_start, take.fps)


def read_session(
    scene: bpy.types.Scene, settings: bpy.types.PropertyGroup, matches: "Matches", **wanted: Any
) -> "Job[SceneSession]":
    """Read what the session of a take starts from; the scene stays as it is.

    Keyframes among `matches` count as found. `wanted`: further fields of core's `Inputs`.
    """
    from ...core.session.session import Inputs, Session
    from ..bridge.take_from_scene import read_scene_take

    identifier = settings.identifier
    kept, floor_m = reading_of(settings), settings.matching.known_floor_m
    source, actor, keys = footage_of(scene, settings), settings.armature, settings.keyframe_action
    take, notes = yield from read_scene_take(source, actor, keys, scene_evidence(settings), matches, kept)
    inputs = Inputs(take, **{"floor_m": floor_m, "kept": kept, **wanted})
    return SceneSession(identifier, Session(inputs), notes)


def go_on(
    made: SceneSession, last: str, keep: "Callable[[str, SceneSession], None]" = lambda _stage, _made: None
) -> "Job[SceneSession]":
    """The session after all stages up to `last`; those with the same input as before are not run again."""
    from ...core.session.stages import reach

    def kept(stage: str, session: "Session") -> None:
        keep(stage, SceneSession(made.take, session, made.notes))

    session = yield from stretch(reach(made.session, last, MADE, kept), READ, 1.0)
    return SceneSession(made.take, session, made.notes)
