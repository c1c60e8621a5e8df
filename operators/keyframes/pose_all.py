"""Frames to pose, proposed by the speed of the performer, and posed all at once by what libraries know."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import bpy
import numpy as np
from bpy.types import Context, Event, OperatorProperties, Scene

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.progress import Job, stretch, within
from ..bridge.scene_frames import shown_index
from ..library.registry import named_libraries
from ..shell import need
from ..shell.base_operator import BaseOperator, Unchanged, warn
from ..shell.fields import Switch, Text
from ..shell.job_operator import JobOperator
from ..shell.notes import give_notices
from ..shell.results import keep_reading, keep_speed
from ..shell.take_state import TakeState
from ..shell.takes import active_take, find_take, take_by_identifier
from .found_properties import FloorSettings, directions, known_matches, neighbor
from .scene_session import READ, SceneSession, go_on, read_session

if TYPE_CHECKING:
    from ...core.markers.reading import Reading


@dataclass(frozen=True, eq=False)
class Outcome:
    """Result of the job."""

    take: str  # The take's identifier
    reading: "Reading"
    frames: tuple[int, ...]  # Proposed scene frames
    speed: Array  # (F,) the speed in the footage that they were chosen by [px per frame] ..
    scene_frames: Array  # .. at scene frames (F,)
    note: str  # what the speed was made from where neither markers nor keypoints tell it; else empty


class KEYMARK_OT_propose_keyframes(JobOperator, bpy.types.Operator):
    """Follow the performer through the footage and propose the frames that are best posed"""

    bl_label = "Propose Keyframes"
    requirements = (need.footage, need.camera, need.all_colors, need.idle)

    def start(self, scene: Scene) -> Job[Outcome]:
        from ...core.markers.reading import Reading
        from ...core.prior.keyframe_proposals import evidence_speed, propose_keyframes
        from ...core.take.performer_keypoints import performer_keypoints

        take = active_take(scene)
        count = take.keyframe_count or None
        made = yield from stretch(read_session(scene, take), 0.0, READ)
        made = yield from stretch(go_on(made, "read"), 0.0, 0.9)
        known, reading = made.session.inputs.take, made.session[Reading]
        keypoints = performer_keypoints(known, reading.tracks)
        segments = tuple(style.segment for style in known.markers)
        moved = evidence_speed(reading.tracks, segments, keypoints, reading.album)
        speed = yield from within("Measuring the speed", moved, 0.9, 1.0)
        chosen = made.frames[propose_keyframes(speed.values, count)]
        proposed = tuple(round(float(frame)) for frame in chosen)
        return Outcome(made.take, reading, proposed, speed.values, made.frames, speed.note)

    def finish(self, scene: Scene, result: Outcome) -> None:
        take = take_by_identifier(scene, result.take)
        keep_reading(take, result.reading)
        keep_speed(take, result.scene_frames, result.speed)
        take.proposals.clear()
        for frame in result.frames:
            take.proposals.add().frame = frame
        self.report({"INFO"}, f"{len(result.frames)} keyframes proposed")
        notes = [warn(self, result.note)] if result.note else []
        give_notices(take, "keyframes", "proposals", notes)


proposals = need.of_take(lambda state: state.proposed, "Propose keyframes first")


class KEYMARK_OT_jump_to_proposal(BaseOperator, bpy.types.Operator):
    """Go to the next or the previous proposed keyframe"""

    bl_label = "Jump to Proposed Keyframe"
    requirements = (proposals,)

    direction: directions("proposed keyframe", "Direction from the current frame")
    skip_posed: Switch(
        "Skip Posed",
        "Skip proposed keyframes that are posed; after the last one comes the first",
        default=False,
    )

    @classmethod
    def description(cls, context: Context, properties: OperatorProperties) -> str:
        if properties.skip_posed:
            return "Go to the next proposed keyframe that is not posed yet"
        return f"Go to the {properties.direction.lower()} proposed keyframe"

    def run(self, context: Context) -> None:
        scene, take = context.scene, find_take(context.scene)
        frames = TakeState(take).unposed if self.skip_posed else TakeState(take).proposed
        if not frames:
            raise Unchanged("all proposed keyframes are posed")
        wanted = neighbor(frames, scene.frame_current, self.direction)
        is_next = self.direction == "NEXT"
        if wanted is None and self.skip_posed:  # around the ends
            wanted = frames[0 if is_next else -1]
        if wanted is None:
            raise Unchanged(f"there is no proposed keyframe {'after' if is_next else 'before'} this frame")
        scene.frame_set(round(wanted))


def keep_poses(scene: Scene, made: SceneSession) -> tuple[str, bool]:
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
    requirements = (need.footage, need.camera, need.actor, need.points_to_follow, need.all_colors, need.idle)

    library: Text(
        "Library",
        "Identifier, title or file of the only library to use, auto for all of them; the panel's where empty",
    )

    def invoke(self, context: Context, event: Event) -> set[str]:
        matching = active_take(context.scene).matching
        self.floor, self.floor_height = matching.floor, matching.floor_height
        return super().invoke(context, event)

    def start(self, scene: Scene) -> Job[SceneSession]:
        """Go on with the active take until its poses are found: in proposed frames, or else the best ones."""
        take = active_take(scene)
        state = TakeState(take)
        reading = read_session(
            scene,
            take,
            known_matches(take, by_hand=False),
            method="map",
            libraries=named_libraries(self.library or take.matching.library_name),
            floor_m=float(self.floor_height) if self.floor == "HEIGHT" else None,
            keyframe_count=take.keyframe_count or None,
            floor_open=state.placement_is_guess and not state.posed,
        )
        made = yield from stretch(reading, 0.0, READ)
        inputs = made.session.inputs
        posed = tuple(key for key in inputs.take.keyframes if key.matched is None)
        inputs = replace(inputs, take=replace(inputs.take, keyframes=posed, reference=None))
        if state.proposed:
            made = yield from go_on(replace(made, session=replace(made.session, inputs=inputs)), "read")
            shown = shown_index(made.frames, np.array(state.proposed, dtype=np.float64))
            wanted = {int(index) for index in shown if index >= 0} - {key.index for key in posed}
            if not wanted:
                raise InputError("every proposed frame is posed; propose more, or remove keyframes first")
            inputs = replace(inputs, frames=tuple(sorted(wanted)))
        return (yield from go_on(replace(made, session=replace(made.session, inputs=inputs)), "pose"))

    def finish(self, scene: Scene, result: SceneSession) -> None:
        sentence, doubtful = keep_poses(scene, result)
        for note in result.notes:
            warn(self, note)
        self.report({"INFO"}, active_take(scene).matching.reason)
        self.report({"WARNING" if doubtful else "INFO"}, sentence)
