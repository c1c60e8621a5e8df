"""Which frame of a take's clip a scene frame shows, as panels and overlays need it: nothing is decoded."""

import bpy
import numpy as np

from ..bridge.scene_frames import scene_frames, shown_index
from .results import reading_of
from .takes import footage_of


def clip_index(take: bpy.types.PropertyGroup, scene_frame: int | None = None) -> int:
    """Index of the clip's frame that is shown in a scene frame, the current one by default; -1 for none.

    Where the rate varies and the clip was not read yet, the frame is a guess.
    """
    scene, footage = take.id_data, footage_of(take.id_data, take)
    reading = reading_of(take)
    if reading is not None:
        frames = scene_frames(reading.tracks.time_s, footage.first_frame, footage.rate)
    else:
        frames = footage.first_frame + np.arange(max(1, take.clip.frame_duration), dtype=np.float64)
    return int(shown_index(frames, scene.frame_current if scene_frame is None else scene_frame))
