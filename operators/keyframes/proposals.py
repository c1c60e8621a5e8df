"""Propose frames to pose, from the speed of the performer in the footage."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
from bpy.types import Context, OperatorProperties, Scene

from ...core.progress import stretch, within
from ..shell.base_operator import BaseOperator, Unchanged, warn
from ..shell.fields import Choice, Switch
from ..shell.job_operator import JobOperator
from ..shell.notices import give_notices
from ..shell.requirements import all_colors, camera, footage, idle, of_take
from ..shell.results import keep_reading, keep_speed
from ..shell.take_state import TakeState
from ..shell.takes import active_take, find_take, take_by_identifier
from .scene_session import READ, clip_session, go_on

if TYPE_CHECKING:
    from ...core.arrays import Array
    from ...core.markers.reading import Reading
    from ...core.progress import Job


@dataclass(frozen=True, eq=False)
class Outcome:
    """Result of the job."""

    take: str  # The take's identifier
    reading: "Reading"
    frames: tuple[int, ...]  # Proposed scene frames
    speed: "Array"  # (F,) the speed in the footage that they were chosen by [px per frame], ..
    scene_frames: "Array"  # ... at scene frames (F,).
    note: str
    """What the speed was made from where neither markers nor keypoints tell it, for people; else empty."""


class KEYMARK_OT_propose_keyframes(JobOperator, bpy.types.Operator):
    """Follow the performer through the footage and propose the frames that are best posed"""

    bl_label = "Propose Keyframes"
    requirements = (footage, camera, all_colors, idle)

    def start(self, scene: Scene) -> "Job[Outcome]":
        """Return the job; a clip that was read for these markers before is not read again."""
        from ...core.markers.reading import Reading
        from ...core.prior.keyframe_proposals import evidence_speed, propose_keyframes
        from ...core.take.performer_keypoints import performer_keypoints

        take = active_take(scene)
        count = take.keyframe_count or None
        made = yield from stretch(clip_session(scene, take), 0.0, READ)
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


proposals = of_take(lambda state: state.proposed, "Propose keyframes first")


class KEYMARK_OT_jump_to_proposal(BaseOperator, bpy.types.Operator):
    """Go to the next or the previous proposed keyframe"""

    bl_label = "Jump to Proposed Keyframe"
    requirements = (proposals,)

    direction: Choice(
        "Direction",
        "Direction from the current frame",
        items=[
            ("NEXT", "Next", "Go to the next proposed keyframe"),
            ("PREVIOUS", "Previous", "Go to the previous proposed keyframe"),
        ],
    )
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
        ahead = [frame for frame in frames if frame > scene.frame_current]
        behind = [frame for frame in frames if frame < scene.frame_current]
        if self.skip_posed:  # wraps around the ends
            ahead, behind = ahead or frames, behind or frames
        is_next = self.direction == "NEXT"
        if not (ahead if is_next else behind):
            side = "after" if is_next else "before"
            raise Unchanged(f"there is no proposed keyframe {side} this frame")
        scene.frame_set(ahead[0] if is_next else behind[-1])
