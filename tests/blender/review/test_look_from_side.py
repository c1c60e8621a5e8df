"""The side view: across the camera's line of sight, and back through the camera."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from keymark.operators.review.weak_frames import look_from_side
from keymark.operators.shell.takes import active_take
from mathutils import Matrix, Quaternion, Vector


@pytest.mark.parametrize("turn", [0.0, 0.7, 2.5])
def test_the_view_is_level_with_the_camera_on_the_left(opened: bpy.types.Scene, turn: float) -> None:
    """Depth runs to the right, height upwards, and the actor is in the middle."""
    take = active_take(opened)
    take.camera.matrix_world = Matrix.Rotation(turn, 4, "Z") @ take.camera.matrix_world
    bpy.context.view_layer.update()
    view = SimpleNamespace(view_perspective="CAMERA")
    look_from_side(SimpleNamespace(region_3d=view), take.camera, take.armature)
    axes = Quaternion(view.view_rotation).to_matrix()
    away = -take.camera.matrix_world.to_3x3().col[2]
    away.z = 0.0
    assert view.view_perspective == "ORTHO"
    assert np.array(axes.col[0]) == pytest.approx(np.array(away.normalized()), abs=1e-5)
    assert np.array(axes.col[1]) == pytest.approx([0.0, 0.0, 1.0], abs=1e-5)
    assert np.array(axes.col[2]) == pytest.approx(np.array(axes.col[0].cross(axes.col[1])), abs=1e-5)
    hips = take.armature.matrix_world @ take.armature.pose.bones["pelvis"].head
    assert (Vector(view.view_location) - hips).length < 0.3
    assert 2.0 < view.view_distance < 8.0


def test_it_is_a_toggle_and_needs_an_actor(opened: bpy.types.Scene) -> None:
    """Without an editor all viewports are set; without an actor there is nothing to look at."""
    assert bpy.ops.keymark.look_from_side() == {"FINISHED"}
    bpy.data.objects.remove(active_take(opened).armature)
    with pytest.raises(RuntimeError, match="actor"):
        bpy.ops.keymark.look_from_side()
