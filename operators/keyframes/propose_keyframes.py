"""Propose frames to pose, from the speed of the performer in the footage."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy

from ...core.progress import within
from ..bridge.scene_frames import scene_frames
from ..keypoints.evidence import scene_evidence
from ..shell.job_operator import JobOperator
from ..shell.messages import warn
from ..shell.notices import give_notices
from ..shell.requirements import all_colors, footage, idle
from ..shell.results import keep_reading, keep_speed, reading_of
from ..shell.takes import active_take, footage_of, take_by_identifier

READ = 0.9
"""Share of the job at which the clip is read."""

if TYPE_CHECKING:
    from ...core.arrays import Array
    from ...core.footage.reading import Reading
    from ...core.progress import Job


@dataclass(frozen=True, eq=False)
class Outcome:
    """Result of the job."""

    take: str
    """The take's identifier."""
    reading: "Reading"
    frames: tuple[int, ...]
    """Proposed scene frames."""
    speed: "Array"
    """(F,) the speed in the footage that they were chosen by [px per frame], ..."""
    scene_frames: "Array"
    """... at scene frames (F,)."""
    note: str
    """What the speed was made from where neither markers nor keypoints tell it, for people; else empty."""


class KEYMARK_OT_propose_keyframes(JobOperator, bpy.types.Operator):
    """Follow the performer through the footage and propose the frames that are best posed"""

    bl_idname = "keymark.propose_keyframes"
    bl_label = "Propose Keyframes"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, all_colors, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[Outcome]":
        """Return the job; a clip that was read for these markers before is not read again."""
        from ...core.footage.read_clip import read_clip
        from ...core.footage.reading_key import of_same_footage, reading_key
        from ...core.prior.evidence_speed import evidence_speed
        from ...core.prior.keyframe_proposals import propose_keyframes
        from ..bridge.scene_performer import keypoints_without_keyframes

        take = active_take(scene)
        identifier, count, stature = take.identifier, take.keyframe_count or None, take.stature
        footage, evidence, reading = footage_of(scene, take), scene_evidence(take), reading_of(take)
        styles = evidence.markers
        clip, first, rate = footage.open(), footage.first_frame, footage.rate
        ignored = evidence.ignored_regions
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

    def finish(self, scene: bpy.types.Scene, result: Outcome) -> None:
        """Store the proposals with the take, and cache the reading for the reconstruction."""
        take = take_by_identifier(scene, result.take)
        keep_reading(take, result.reading)
        keep_speed(take, result.scene_frames, result.speed)
        take.proposals.clear()
        for frame in result.frames:
            take.proposals.add().frame = frame
        self.report({"INFO"}, f"{len(result.frames)} keyframes proposed")
        notes = [warn(self, result.note)] if result.note else []
        give_notices(take, "keyframes", "proposals", notes)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_propose_keyframes,))
