"""Proposed keyframes: timeline markers of one name, which the animator may move, add and delete."""

import bpy

PROPOSAL = "Pose"
"""Name of the timeline markers; all others are the animator's own."""


def set_proposals(scene: bpy.types.Scene, frames: list[int]) -> None:
    """Replace the scene's proposals."""
    for marker in [marker for marker in scene.timeline_markers if marker.name == PROPOSAL]:
        scene.timeline_markers.remove(marker)
    for frame in frames:
        scene.timeline_markers.new(PROPOSAL, frame=frame)


def proposals(scene: bpy.types.Scene) -> list[int]:
    """The proposed scene frames, in order."""
    return sorted({marker.frame for marker in scene.timeline_markers if marker.name == PROPOSAL})
