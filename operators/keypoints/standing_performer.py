"""Moments in which a take's keypoints show the performer upright, to find the camera by."""

from contextlib import suppress
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core.errors import InputError
from ..shell.takes import footage_of
from .evidence import has_keypoints, scene_evidence

if TYPE_CHECKING:
    from ...core.footage.camera_evidence import Uprights

FEWEST = 2
"""Moments without which nothing is told."""


def standing_performer(take: bpy.types.PropertyGroup, stature_m: float) -> "Uprights":
    """Moments in which somebody of that stature is upright; none without keypoints of this clip."""
    from ...core.body.actor import Actor
    from ...core.body.kinematics import Body
    from ...core.footage.camera_evidence import Uprights
    from ...core.footage.region_tracks import RegionTracks
    from ...core.footage.standing_moments import standing_keypoints
    from ..bridge.scene_performer import keypoints_without_keyframes

    if not has_keypoints(take):
        return Uprights.none()
    with suppress(InputError):
        source = footage_of(take.id_data, take)
        time_s = np.arange(source.clip.frame_duration) / source.rate
        tracks = RegionTracks.unmarked(time_s, (source.clip.size[0], source.clip.size[1]))
        keypoints = keypoints_without_keyframes(source, scene_evidence(take), tracks, stature_m)
        found = standing_keypoints(keypoints, Body(Actor.from_stature(stature_m)), source.rate)
        if len(found) >= FEWEST:
            return found
    return Uprights.none()
