"""The color of a pixel of the frame that the scene shows."""

import bpy
import numpy as np
from keymark.core.camera.camera import Camera
from keymark.core.take.take import Take
from keymark.operators.bridge.footage import Footage, footage_color
from keymark.operators.bridge.footage_to_scene import show_footage


def test_another_frame_has_another_color_under_a_moving_marker(tiny_take: Take, camera: Camera) -> None:
    times, fps = np.arange(13) / tiny_take.fps, tiny_take.fps
    shown, _ = show_footage(bpy.context.scene, camera, tiny_take.clip, fps, 1, times)
    footage = Footage(bpy.context.scene, bpy.context.scene.active_clip, shown)
    pose = tiny_take.body.pose(tiny_take.keyframes[0].posture)
    elbow, wrist = tiny_take.body.segment_ends(pose, "forearm.L")
    pixel, _ = camera.project(0.5 * (elbow + wrist))
    bpy.context.scene.frame_set(1)
    first = np.array(footage_color(footage, pixel))
    bpy.context.scene.frame_set(13)
    last = np.array(footage_color(footage, pixel))
    red = np.array(tiny_take.markers[1].color_srgb)
    assert np.abs(first - red).max() < 40
    assert np.abs(last - red).max() > 40
