"""Pose all proposed frames at once, from what every library knows of postures."""

from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core.errors import InputError
from ...core.progress import stretch, within
from ..bridge.scene_frames import shown_index
from ..shell.keyed_frames import proposed_frames
from ..shell.takes import active_take
from .find_operator import READ, FindOperator
from .scene_clip import SceneClip, read_scene_clip

if TYPE_CHECKING:
    from ...core.progress import Job
    from .found_result import FoundResult, Proposals

MEASURED = 0.55
"""Share of the job at which the performer's speed is measured, where no frames are proposed yet."""


class KEYMARK_OT_pose_all(FindOperator, bpy.types.Operator):
    """Find the actor's pose in every proposed frame, and key it as found; what you posed or chose stays"""

    bl_idname = "keymark.pose_all"
    bl_label = "Pose All"
    bl_options = {"REGISTER", "UNDO"}

    def start(self, scene: bpy.types.Scene) -> "Job[FoundResult]":
        """Read the scene's take, propose frames where none are proposed, and find their postures."""
        from ...core.posing.pose_clip import pose_clip
        from ..library.registry_files import all_libraries
        from .found_result import FoundResult, found_keyframes

        settings = active_take(scene)
        identifier, count, floor_m = settings.identifier, settings.keyframe_count or None, self.floor_m
        proposed, libraries = proposed_frames(settings), all_libraries()
        clip = yield from stretch(read_scene_clip(scene, settings), 0.0, READ)
        proposals = None if proposed else (yield from stretch(_propose(clip, count), READ, MEASURED))
        if proposals is None:
            shown = shown_index(clip.frames, np.array(proposed, dtype=np.float64))
            wanted = {int(index) for index in shown if index >= 0}
        else:
            wanted = set(proposals.indices)
        decided = {keyframe.index for keyframe in clip.take.keyframes}
        if wanted <= decided:
            raise InputError("every proposed frame is posed; propose more, or remove keyframes first")
        job = pose_clip(clip.take, clip.reading, libraries, floor_m, frames=sorted(wanted - decided))
        found = yield from stretch(job, MEASURED, 1.0)
        return FoundResult(identifier, clip, found, found_keyframes(clip.take, found), proposals)


def _propose(clip: SceneClip, count: int | None) -> "Job[Proposals]":
    """Propose frames of a clip that was read, as *Propose Keyframes* does."""
    from ...core.prior.evidence_speed import evidence_speed
    from ...core.prior.keyframe_proposals import propose_keyframes
    from ...core.take.performer_keypoints import performer_keypoints
    from .found_result import Proposals

    take, tracks = clip.take, clip.reading.tracks
    moved = evidence_speed(
        tracks, take.marker_segments, performer_keypoints(take, None, tracks), clip.reading.album
    )
    speed = yield from within("Measuring the speed", moved, 0.0, 1.0)
    return Proposals(tuple(map(int, propose_keyframes(speed.values, count))), speed.values)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_pose_all,))
