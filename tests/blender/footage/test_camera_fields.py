"""The camera's height, tilt and roll as fields, and when they count as a guess."""

import bpy
import numpy as np
import pytest
from keymark.core.camera.camera_fields import CameraPlacement, heading_rad
from keymark.operators.bridge.footage import fixed_reason
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take
from mathutils import Euler

pytestmark = pytest.mark.usefixtures("registered")
ASKED = "say where the camera stood"


def matrix(camera: bpy.types.Object) -> np.ndarray:
    bpy.context.view_layer.update()
    return np.array(camera.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world)


def test_fields_are_the_cameras_own(loaded: bpy.types.PropertyGroup) -> None:
    camera = loaded.camera
    camera.location, camera.rotation_euler = (2.0, -3.0, 1.7), Euler((1.4, 0.0, 0.6))
    camera.scale = (2.0, 2.0, 2.0)
    assert loaded.camera_height == pytest.approx(1.7)
    assert loaded.camera_tilt == pytest.approx(1.4 - np.pi / 2, abs=1e-5) and loaded.camera_roll == 0.0
    loaded.camera_tilt, loaded.camera_roll, loaded.camera_height = -0.2, 0.05, 1.1
    assert (loaded.camera_height, loaded.camera_tilt, loaded.camera_roll) == pytest.approx((1.1, -0.2, 0.05))
    pose = matrix(camera)
    assert pose[:3, 3] == pytest.approx((2.0, -3.0, 1.1)) and tuple(camera.scale) == pytest.approx((2, 2, 2))
    pose[:3, :3] /= 2.0
    assert heading_rad(pose) == pytest.approx(0.6, abs=1e-5)
    found = CameraPlacement.of(pose)
    assert (found.tilt_rad, found.roll_rad) == pytest.approx((-0.2, 0.05), abs=1e-5)


def test_a_camera_with_a_parent_keeps_its_parent(loaded: bpy.types.PropertyGroup) -> None:
    parent = bpy.data.objects.new("Tripod", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.location = (1.0, 1.0, 0.5)
    loaded.camera.parent = parent
    bpy.context.view_layer.update()
    assert loaded.camera_height == pytest.approx(1.9)
    loaded.camera_height = 1.2
    assert matrix(loaded.camera)[2, 3] == pytest.approx(1.2) and loaded.camera.parent == parent


def test_a_new_camera_is_asked_about_until_somebody_says_where_it_stood(
    loaded: bpy.types.PropertyGroup,
) -> None:
    assert TakeState(loaded).placement_is_guess and TakeState(loaded).next[1] == ASKED
    loaded.camera.location.z = 1.0
    assert not TakeState(loaded).placement_is_guess and TakeState(loaded).next[1] != ASKED
    loaded.camera.location.z = 1.4
    assert TakeState(loaded).next[1] == ASKED
    bpy.ops.keymark.add_performer()
    second = active_take(bpy.context.scene)
    assert TakeState(second).placement_is_guess
    second.camera_height = 1.4  # entered, though the same
    first = bpy.context.scene.keymark.takes[0]
    assert not TakeState(second).placement_is_guess and not TakeState(first).placement_is_guess
    with pytest.raises(RuntimeError, match="The camera's place is not a guess"):
        bpy.ops.keymark.keep_camera()


def test_the_tick_confirms_the_place_and_not_the_lens(loaded: bpy.types.PropertyGroup) -> None:
    before = loaded.guessed_lens_mm
    assert bpy.ops.keymark.keep_camera() == {"FINISHED"}
    assert not TakeState(loaded).placement_is_guess and loaded.guessed_lens_mm == before > 0.0


def test_a_take_that_is_opened_knows_its_camera(opened: bpy.types.Scene) -> None:
    assert not TakeState(active_take(opened)).placement_is_guess


def test_a_camera_that_moves_is_read_only_with_a_reason(loaded: bpy.types.PropertyGroup) -> None:
    loaded.camera.keyframe_insert("location", frame=1)
    assert "animated" in (fixed_reason(loaded.camera) or "") and not TakeState(loaded).placement_is_guess
    loaded.camera_height = 3.0
    assert loaded.camera_height == pytest.approx(1.4)
    with pytest.raises(RuntimeError, match="animated or constrained"):
        bpy.ops.keymark.camera_from_lines()
    assert fixed_reason(None) is not None
