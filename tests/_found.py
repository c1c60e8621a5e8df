"""A found keyframe in the scene, for tests of what shows it."""

import bpy
import numpy as np
from _results import made_up_frames
from keymark.core.take.motion import Motion
from keymark.operators.keyframes.found_result import add_candidate, add_match, key_matches
from keymark.operators.shell.takes import active_take


def show_found(scene: bpy.types.Scene, motion: Motion) -> None:
    """Give the active take a doubtful keyframe of a motion with its candidates at frame 4, and show that."""
    take = active_take(scene)
    (frame,) = made_up_frames(motion, {3: 0.4})
    found = add_match(take, 4.0, "composed")
    for each in frame.candidates:
        add_candidate(found, each.posture, each.name, each.mirrored, each.confidence)
    key_matches(take, np.array([4.0]), [frame.candidates[0].posture])
    scene.frame_set(4)
