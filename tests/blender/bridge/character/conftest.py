"""What the tests of characters in Blender share: Rigify's basic human, generated once a run."""

from collections.abc import Callable
from pathlib import Path

import bpy
import pytest
from _armatures import add_rig, rigify_file
from _performances import performance, stepping
from keymark.core.body.kinematics import SegmentMotion


@pytest.fixture(scope="session")
def source() -> SegmentMotion:
    """The demonstration's first steps, forty frames of them."""
    body, posture = stepping()
    return performance(body, posture[:40])


@pytest.fixture(scope="session")
def rigify_blend(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The .blend with Rigify's basic human."""
    return rigify_file(tmp_path_factory.getbasetemp())


@pytest.fixture
def rigify(rigify_blend: Path) -> bpy.types.Object:
    """Rigify's basic human in the scene."""
    return add_rig(rigify_blend)


@pytest.fixture
def state() -> Callable[[bpy.types.Object], object]:
    """A function to all that probing and measuring may not change about a character."""

    def read(character: bpy.types.Object) -> object:
        data, scene = character.animation_data, bpy.context.scene
        pose = [
            (
                bone.name,
                *(tuple(getattr(bone, name)) for name in ("location", "rotation_quaternion", "scale")),
                tuple(bone.rotation_euler),
                tuple(bone.rotation_axis_angle),
                bone.rotation_mode,
                sorted((key, repr(bone[key])) for key in bone.keys()),  # noqa: SIM118
                tuple(tuple(row) for row in bone.matrix),
            )
            for bone in character.pose.bones
        ]
        transform = tuple(tuple(row) for row in character.matrix_world)
        animation = data and (data.action, data.action_slot, data.use_nla, len(data.drivers))
        return pose, transform, animation, scene.frame_current, scene.frame_subframe, len(bpy.data.actions)

    return read
