"""Find the camera from the performer's walk, as keypoints and markers show it over the clip."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ..footage.camera_fields import still_camera
from ..footage.found_camera import fit_take, values, write_fit
from ..shell.job_operator import JobOperator
from ..shell.messages import say
from ..shell.redraw import redraw_footage
from ..shell.requirements import camera, footage, idle
from ..shell.results import reading_of
from ..shell.takes import active_take, footage_of, take_by_identifier
from .evidence import scene_evidence
from .requirements import points_to_follow

if TYPE_CHECKING:
    from ...core.footage.camera_evidence import Uprights
    from ...core.progress import Job

FEWEST = 2
"""Moments without which a walk says nothing."""


@dataclass(frozen=True, eq=False)
class Walked:
    """Result of the job."""

    take: str
    """The take's identifier."""
    uprights: "Uprights"


class KEYMARK_OT_camera_from_walk(JobOperator, bpy.types.Operator):
    """Find the camera from the keypoints or markers of a performer of this height who walks about upright"""

    bl_idname = "keymark.camera_from_walk"
    bl_label = "Camera from the Walk"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, camera, still_camera, points_to_follow, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[Walked]":
        """Return the job that looks for moments in which the performer is upright."""
        from ...core.body.actor import Actor
        from ...core.body.kinematics import Body
        from ...core.footage.region_tracks import RegionTracks
        from ...core.footage.standing_moments import standing_keypoints, standing_regions
        from ..bridge.scene_performer import performers_keypoints
        from ..bridge.take_from_scene import clip_frames

        take = active_take(scene)
        source, evidence, reading = footage_of(scene, take), scene_evidence(take), reading_of(take)
        identifier, body = take.identifier, Body(Actor.from_stature(take.stature))
        frames = yield from clip_frames(source, evidence, reading)
        size = (source.clip.size[0], source.clip.size[1])
        tracks = RegionTracks.unmarked((frames - frames[0]) / source.rate, size)
        if reading is not None and evidence.markers and reading.tracks.frame_count == len(frames):
            tracks = reading.tracks
        keypoints = performers_keypoints(source, evidence, frames, body, (), tracks)
        segments = tuple(style.segment for style in evidence.markers) if tracks.names else ()
        found = standing_keypoints(keypoints, body, source.rate)
        if len(found) < FEWEST and segments:
            found = standing_regions(tracks, segments, body, source.rate)
        if len(found) < FEWEST:
            raise InputError(
                "take '{take}' shows the performer upright in too few frames, from head to feet; click on "
                "the performer with From the Performer instead",
                take=take_by_identifier(scene, identifier).name,
            )
        return Walked(identifier, found)

    def finish(self, scene: bpy.types.Scene, result: Walked) -> None:
        """Set the camera, and say how sure it is.

        Raises:
            InputError: The take is gone, or the walk says nothing of the camera.
        """
        from ...core.footage.camera_evidence import CameraEvidence

        take = take_by_identifier(scene, result.take)
        fit = fit_take(take, CameraEvidence(uprights=result.uprights))
        write_fit(take, fit)
        say(self, "INFO", "{values}", values=values(fit))
        redraw_footage(bpy.context)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_camera_from_walk,))
