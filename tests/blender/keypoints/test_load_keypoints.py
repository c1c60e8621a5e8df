"""Keypoint files of a take: loading, switching, finding again, and reconstructing with nothing else."""

from pathlib import Path

import bpy
import numpy as np
from keymark.core.take.motion import Motion
from keymark.operators.keypoints.frame_keypoints import keypoints_at
from keymark.operators.shell.takes import active_take


def test_a_plain_take_is_reconstructed(
    plain: bpy.types.Scene, keypoint_file: Path, wave_motion: Motion, shown_points
) -> None:
    assert bpy.ops.keymark.load_keypoints(filepath=str(keypoint_file)) == {"FINISHED"}
    take = active_take(plain)
    print([(k.source, k.seen_count) for k in keypoints_at(take, 5)])
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}
    errors = []
    for frame in range(1, 14):
        plain.frame_set(frame)
        errors.append(np.linalg.norm(shown_points(take.armature) - wave_motion.points[frame - 1], axis=1))
    print([n.text for n in take.notes], np.mean(errors))
    assert np.mean(errors) < 0.04


def test_proposals_without_markers(plain, keypoint_file):
    take = active_take(plain)
    bpy.ops.keymark.load_keypoints(filepath=str(keypoint_file))
    take.keyframe_count = 4
    assert bpy.ops.keymark.propose_keyframes() == {"FINISHED"}
    assert len(take.proposals) == 4
