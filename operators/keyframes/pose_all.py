"""Pose all proposed frames at once, from what all libraries know of postures, or one of them."""

from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core.errors import InputError
from ...core.progress import stretch, within
from ..bridge.scene_frames import shown_index
from ..follow.evidence import points_to_follow
from ..shell.base_operator import warn
from ..shell.fields import Text
from ..shell.job_operator import JobOperator
from ..shell.keyed_frames import count_found, doubtful_matches, proposed_frames
from ..shell.requirements import actor, all_colors, camera, footage, idle
from ..shell.takes import active_take
from .found_keyframes import SceneClip, read_scene_clip
from .found_properties import FloorSettings

if TYPE_CHECKING:
    from ...core.progress import Job
    from .found_result import FoundResult, Proposals


READ, MEASURED = 0.5, 0.55
"""Shares of the job at which the clip is read, and the speed measured where no frames are proposed yet."""


def find_poses(scene: bpy.types.Scene, library: str, floor_m: float | None) -> "Job[FoundResult]":
    """Read the active take, propose frames where none are proposed, and find their postures.

    `library` is the only one that is used, the panel's where empty; the scene stays as it is.
    """
    from ...core.posing.pose_clip import pose_clip
    from ...core.session.stages import seen_in
    from ..library.registry_files import named_libraries
    from .found_result import FoundResult, found_keyframes

    settings = active_take(scene)
    identifier, count = settings.identifier, settings.keyframe_count or None
    libraries = named_libraries(library or settings.matching.library_name)
    proposed = proposed_frames(settings)
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
    job = pose_clip(seen_in(clip.take, clip.reading), libraries, floor_m, frames=sorted(wanted - decided))
    found = yield from stretch(job, MEASURED, 1.0)
    return FoundResult(identifier, clip, found, found_keyframes(clip.take, found), proposals)


def keep_poses(scene: bpy.types.Scene, result: "FoundResult") -> tuple[str, bool]:
    """Key the found postures; returns a sentence on them, and whether any is doubtful."""
    take = result.write(scene)
    scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
    count, doubtful = count_found(take)
    if not doubtful:
        return f"{count} keyframes found, none of them doubtful", False
    take.matching.shown_match = doubtful_matches(take)[0]
    return f"{count} keyframes found, {doubtful} of them doubtful; the most doubtful one is shown", True


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

    def start(self, scene: bpy.types.Scene) -> "Job[FoundResult]":
        floor_m = float(self.floor_height) if self.floor == "HEIGHT" else None
        return (yield from find_poses(scene, self.library, floor_m))

    def finish(self, scene: bpy.types.Scene, result: "FoundResult") -> None:
        said, doubtful = keep_poses(scene, result)
        for note in result.clip.notes:
            warn(self, note)
        self.report({"INFO"}, active_take(scene).matching.reason)
        self.report({"WARNING" if doubtful else "INFO"}, said)


def _propose(clip: SceneClip, count: int | None) -> "Job[Proposals]":
    """Propose frames of a clip that was read, as *Propose Keyframes* does."""
    from ...core.prior.keyframe_proposals import evidence_speed, propose_keyframes
    from ...core.take.performer_keypoints import performer_keypoints
    from .found_result import Proposals

    take, tracks = clip.take, clip.reading.tracks
    keypoints = performer_keypoints(take, None, tracks)
    moved = evidence_speed(tracks, take.marker_segments, keypoints, clip.reading.album)
    speed = yield from within("Measuring the speed", moved, 0.0, 1.0)
    return Proposals(tuple(map(int, propose_keyframes(speed.values, count))), speed.values)
