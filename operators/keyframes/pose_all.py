"""Pose all proposed frames at once, from what all libraries know of postures, or one of them."""

from dataclasses import replace
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core.errors import InputError
from ...core.progress import stretch
from ..bridge.scene_frames import shown_index
from ..shell.base_operator import warn
from ..shell.fields import Text
from ..shell.job_operator import JobOperator
from ..shell.requirements import actor, all_colors, camera, footage, idle, points_to_follow
from ..shell.take_state import TakeState
from ..shell.takes import active_take
from .found_keyframes import undecided_matches
from .found_properties import FloorSettings
from .scene_session import READ, SceneSession, go_on, read_session

if TYPE_CHECKING:
    from ...core.progress import Job


def find_poses(scene: bpy.types.Scene, library: str, floor_m: float | None) -> "Job[SceneSession]":
    """Go on with the active take until its poses are found; the scene stays as it is.

    `library` is the only one that is used, the panel's where empty. Frames that are proposed are posed, or
    else those that are found to be the best.
    """
    from ..library.registry_files import named_libraries

    settings = active_take(scene)
    libraries = named_libraries(library or settings.matching.library_name)
    count, proposed = settings.keyframe_count or None, TakeState(settings).proposed
    is_open = TakeState(settings).placement_is_guess and not TakeState(settings).posed
    reading = read_session(
        scene,
        settings,
        undecided_matches(settings),
        method="map",
        libraries=libraries,
        floor_m=floor_m,
        keyframe_count=count,
        floor_open=is_open,
    )
    made = yield from stretch(reading, 0.0, READ)
    inputs = made.session.inputs
    posed = tuple(key for key in inputs.take.keyframes if key.matched is None)
    inputs = replace(inputs, take=replace(inputs.take, keyframes=posed, reference=None))
    if proposed:
        made = yield from go_on(replace(made, session=replace(made.session, inputs=inputs)), "read")
        shown = shown_index(made.frames, np.array(proposed, dtype=np.float64))
        wanted = {int(index) for index in shown if index >= 0} - {key.index for key in posed}
        if not wanted:
            raise InputError("every proposed frame is posed; propose more, or remove keyframes first")
        inputs = replace(inputs, frames=tuple(sorted(wanted)))
    return (yield from go_on(replace(made, session=replace(made.session, inputs=inputs)), "pose"))


def keep_poses(scene: bpy.types.Scene, made: "SceneSession") -> tuple[str, bool]:
    """Key the found postures; returns a sentence on them, and whether any is doubtful."""
    from .found_result import write_poses

    take = write_poses(scene, made)
    scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
    state = TakeState(take)
    count, doubtful = state.found_count, state.doubtful
    if not doubtful:
        return f"{count} keyframes found, none of them doubtful", False
    take.matching.shown_match = doubtful[0]
    return f"{count} keyframes found, {len(doubtful)} of them doubtful; the most doubtful one is shown", True


class KEYMARK_OT_pose_all(FloorSettings, JobOperator, bpy.types.Operator):
    """Find the actor's pose in every proposed frame, and key it as found; what you posed or chose stays"""

    bl_label = "Pose All"
    requirements = (footage, camera, actor, points_to_follow, all_colors, idle)

    library: Text(
        "Library",
        "Identifier, title or file of the only library to use, auto for all of them; the panel's where empty",
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        matching = active_take(context.scene).matching
        self.floor, self.floor_height = matching.floor, matching.floor_height
        return super().invoke(context, event)

    def start(self, scene: bpy.types.Scene) -> "Job[SceneSession]":
        floor_m = float(self.floor_height) if self.floor == "HEIGHT" else None
        return (yield from find_poses(scene, self.library, floor_m))

    def finish(self, scene: bpy.types.Scene, result: "SceneSession") -> None:
        said, doubtful = keep_poses(scene, result)
        for note in result.notes:
            warn(self, note)
        self.report({"INFO"}, active_take(scene).matching.reason)
        self.report({"WARNING" if doubtful else "INFO"}, said)
