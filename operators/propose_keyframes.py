"""Propose frames worth posing, from how fast the markers move."""

from typing import TYPE_CHECKING

import bpy

from .job_operator import JobOperator
from .marker_styles import marker_styles
from .proposals import set_proposals
from .requirements import all_met, footage, idle, markers

if TYPE_CHECKING:
    from ..core.progress import Job


class KEYMARK_OT_propose_keyframes(JobOperator, bpy.types.Operator):
    """Follow the markers through the footage and mark the frames that are best posed on the timeline"""

    bl_idname = "keymark.propose_keyframes"
    bl_label = "Propose Keyframes"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The markers are followed through the footage."""
        return all_met(cls, context, footage, markers, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[list[int]]":
        """Find the frames."""
        from ..core.footage.clip import Clip
        from ..core.footage.markers import track_markers
        from ..core.prior.speed import marker_speed, propose_keyframes
        from ..core.progress import within
        from .bridge.frame_times import scene_frames
        from .bridge.scene_footage import clip_rate
        from .bridge.scene_take import clip_path

        styles = marker_styles(scene)
        clip, count = scene.active_clip, scene.keymark.keyframe_count or None
        rate = clip_rate(clip, scene.render.fps / scene.render.fps_base)
        first = clip.frame_start - clip.frame_offset
        source = Clip.open(clip_path(clip), fps=rate)
        tracks = yield from within("Following the markers", track_markers(source, styles), 0.0, 1.0)
        chosen = propose_keyframes(marker_speed(tracks), count)
        return [round(float(frame)) for frame in scene_frames(tracks.time_s, first, rate)[chosen]]

    def finish(self, scene: bpy.types.Scene, result: list[int]) -> None:
        """Mark them on the timeline."""
        set_proposals(scene, result)
        self.report({"INFO"}, f"{len(result)} keyframes proposed, marked on the timeline")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_propose_keyframes,))
