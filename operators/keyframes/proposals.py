"""Propose frames to pose, from the speed of the performer in the footage."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
from bpy.types import Context, OperatorProperties, Scene

from ...core.progress import within
from ..bridge.scene_frames import scene_frames
from ..follow.evidence import scene_evidence
from ..shell.base_operator import BaseOperator, Unchanged, warn
from ..shell.fields import Choice, Switch
from ..shell.job_operator import JobOperator
from ..shell.keyed_frames import proposed_frames, unposed_proposals
from ..shell.notices import give_notices
from ..shell.requirements import all_colors, footage, idle, of_take
from ..shell.results import keep_reading, keep_speed, reading_of
from ..shell.takes import active_take, find_take, footage_of, take_by_identifier

if TYPE_CHECKING:
    from ...core.arrays import Array
    from ...core.markers.reading import Reading
    from ...core.progress import Job


READ = 0.9  # Share of the job at which the clip is read


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
    requirements = (footage, all_colors, idle)

    def start(self, scene: Scene) -> "Job[Outcome]":
        """Return the job; a clip that was read for these markers before is not read again."""
        from ...core.markers.reading import of_same_footage, read_clip, reading_key
        from ...core.prior.keyframe_proposals import evidence_speed, propose_keyframes
        from ..bridge.take_from_scene import keypoints_without_keyframes

        take = active_take(scene)
        identifier, count, stature = take.identifier, take.keyframe_count or None, take.stature
        footage, evidence, reading = footage_of(scene, take), scene_evidence(take), reading_of(take)
        styles, ignored = evidence.markers, evidence.ignored_regions
        clip, first, rate = footage.open(), footage.first_frame, footage.rate
        key = reading_key(clip.path, clip.fps, styles, None, ignored)
        if reading is None or not of_same_footage(reading.key, key):
            job = read_clip(clip, styles, ignored=ignored)
            reading = yield from within("Following the performer", job, 0.0, READ)
        segments = tuple(style.segment for style in styles)
        keypoints = keypoints_without_keyframes(footage, evidence, reading.tracks, stature)
        moved = evidence_speed(reading.tracks, segments, keypoints, reading.album)
        speed = yield from within("Measuring the speed", moved, READ, 1.0)
        chosen = propose_keyframes(speed.values, count)
        frames = scene_frames(reading.tracks.time_s, first, rate)
        proposed = tuple(round(float(frame)) for frame in frames[chosen])
        return Outcome(identifier, reading, proposed, speed.values, frames, speed.note)

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


proposals = of_take(proposed_frames, "Propose keyframes first")


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
        frames = unposed_proposals(take) if self.skip_posed else proposed_frames(take)
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
