"""Propose frames worth posing, from how fast the markers move."""

from typing import TYPE_CHECKING

import bpy

from .job_operator import JobOperator
from .marker_styles import marker_styles
from .requirements import all_met, footage, idle, markers
from .takes import active_take, footage_of

if TYPE_CHECKING:
    from ..core.progress import Job


class KEYMARK_OT_propose_keyframes(JobOperator, bpy.types.Operator):
    """Follow the markers through the footage and propose the frames that are best posed"""

    bl_idname = "keymark.propose_keyframes"
    bl_label = "Propose Keyframes"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The markers are followed through the footage."""
        return all_met(cls, context, footage, markers, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[list[int]]":
        """Find the frames."""
        from ..core.footage.markers import track_markers
        from ..core.prior.speed import marker_speed, propose_keyframes
        from ..core.progress import within
        from .bridge.frame_times import scene_frames

        take = active_take(scene)
        footage, styles = footage_of(scene, take), marker_styles(take)
        tracks = yield from within("Following the markers", track_markers(footage.open(), styles), 0.0, 1.0)
        chosen = propose_keyframes(marker_speed(tracks), take.keyframe_count or None)
        frames = scene_frames(tracks.time_s, footage.first_frame, footage.rate)[chosen]
        return [round(float(frame)) for frame in frames]

    def finish(self, scene: bpy.types.Scene, result: list[int]) -> None:
        """Keep them with the take."""
        proposals = active_take(scene).proposals
        proposals.clear()
        for frame in result:
            proposals.add().frame = frame
        self.report({"INFO"}, f"{len(result)} keyframes proposed")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_propose_keyframes,))
