"""Reconstruct the motion between the keyframes from the footage."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy

from .job_operator import JobOperator, stretch
from .marker_styles import marker_styles
from .requirements import actor, all_met, footage, idle, keyframes, markers
from .takes import active_take, footage_of

if TYPE_CHECKING:
    from ..core.motion import Motion
    from ..core.progress import Job

READING_SHARE = 0.05
"""Share of the job that reading the scene and the clip's times is."""


@dataclass(frozen=True, eq=False)
class Outcome:
    """What the job hands over to the scene."""

    motion: "Motion"
    rate: float
    notes: tuple[str, ...]


class KEYMARK_OT_reconstruct(JobOperator, bpy.types.Operator):
    """Reconstruct every frame from the footage and the keyframes; the motion becomes an Action of its own"""

    bl_idname = "keymark.reconstruct"
    bl_label = "Reconstruct"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Everything a take holds must be there."""
        return all_met(cls, context, footage, actor, markers, keyframes, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[Outcome]":
        """Read the scene's take and reconstruct it."""
        from ..core.reconstruct import reconstruct
        from .bridge.scene_take import read_scene_take

        settings = active_take(scene)
        method = settings.method
        reading = read_scene_take(
            footage_of(scene, settings), settings.armature, settings.keyframe_action, marker_styles(settings)
        )
        take, notes = yield from stretch(reading, 0.0, READING_SHARE)
        result = yield from stretch(reconstruct(take, method), READING_SHARE, 1.0)
        return Outcome(result.motion, take.fps, (*notes, *result.notes))

    def finish(self, scene: bpy.types.Scene, result: Outcome) -> None:
        """Write the motion's Action and let it animate the actor; the keyframes stay in theirs."""
        from .bridge.fcurves import write_motion
        from .bridge.frame_times import scene_frames

        settings, motion = active_take(scene), result.motion
        frames = scene_frames(motion.time_s, motion.frame_start, result.rate)
        settings.motion_action = write_motion(
            settings.armature, motion, settings.motion_action, settings.keyframe_action, frames
        )
        settings.motion_action.use_fake_user = True
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
        for note in result.notes:
            self.report({"WARNING"}, note)
        self.report(
            {"INFO"}, f"Reconstructed {len(frames)} frames from {len(motion.keyframe_indices)} keyframes"
        )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_reconstruct,))
