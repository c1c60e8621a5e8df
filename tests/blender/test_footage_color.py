"""Which pixel of the file lies under the straightened background."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from keymark.core.footage.camera import Camera
from keymark.core.take import Take
from keymark.operators.bridge.footage_color import footage_color, footage_pixel
from keymark.operators.bridge.scene_footage import show_footage


@pytest.mark.parametrize("distortion", [(0.0, 0.0, 0.0), (-0.25, 0.05, 0.0)])
def test_a_point_is_found_where_the_lens_put_it(
    tiny_take: Take, camera: Camera, distortion: tuple[float, float, float]
) -> None:
    """A point's pixel without distortion leads to its pixel with distortion."""
    lens = replace(camera, distortion=distortion, shift_x=0.05)
    show_footage(bpy.context.scene, lens, tiny_take.clip, tiny_take.fps, 1, 13)
    point = np.array([1.6, 0.0, 2.2])
    shown, _ = replace(lens, distortion=(0.0, 0.0, 0.0)).project(point)
    recorded, _ = lens.project(point)
    assert footage_pixel(bpy.context.scene, shown) == pytest.approx(recorded, abs=0.01)
    assert (np.abs(shown - recorded).max() > 0.5) == any(distortion)


def test_another_frame_has_another_colour_under_a_moving_marker(tiny_take: Take, camera: Camera) -> None:
    """The frame that the scene shows is the one that is read."""
    show_footage(bpy.context.scene, camera, tiny_take.clip, tiny_take.fps, 1, 13)
    pose = tiny_take.body.pose(tiny_take.keyframes[0].posture)
    elbow, wrist = tiny_take.body.segment_ends(pose, "forearm.L")
    pixel, _ = camera.project(0.5 * (elbow + wrist))
    bpy.context.scene.frame_set(1)
    first = np.array(footage_color(bpy.context.scene, pixel))
    bpy.context.scene.frame_set(13)
    last = np.array(footage_color(bpy.context.scene, pixel))
    red = np.array(tiny_take.markers[1].color_srgb)
    assert np.abs(first - red).max() < 40
    assert np.abs(last - red).max() > 40
