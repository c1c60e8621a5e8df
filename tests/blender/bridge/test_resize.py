"""Other lengths for an actor that is there."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.errors import InputError
from keymark.operators.bridge.actor_lengths import read_body, set_lengths
from keymark.operators.bridge.armature import build_armature
from keymark.operators.bridge.pose import read_posture, write_posture


@pytest.fixture
def other(body: Body) -> Body:
    rng = np.random.default_rng(5)
    return Body(Actor({n: v * float(rng.uniform(0.8, 1.25)) for n, v in body.actor.segments_m.items()}))


def test_the_bones_get_the_lengths(body: Body, other: Body) -> None:
    armature_object = build_armature(bpy.context.scene, body)
    set_lengths(armature_object, other)
    assert dict(read_body(armature_object, HUMAN).actor.segments_m) == pytest.approx(
        dict(other.actor.segments_m), rel=1e-5
    )


def test_the_pose_stays(body: Body, other: Body, random_posture: Callable[[int], Posture]) -> None:
    armature_object = build_armature(bpy.context.scene, body)
    armature_object.location = (0.4, -1.0, 0.2)
    armature_object.rotation_euler = (0.1, 0.2, 1.0)
    armature_object.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    posture = random_posture(3)
    write_posture(armature_object, posture)
    set_lengths(armature_object, other)
    found = read_posture(armature_object, read_body(armature_object, HUMAN))
    assert found.furthest_m < 1e-4
    np.testing.assert_allclose(found.posture.minus(posture), 0.0, atol=1e-4)
    shown = read_body(armature_object, HUMAN).actor.segments_m
    assert dict(shown) == pytest.approx(dict(other.actor.segments_m), rel=1e-4)


def test_the_mode_and_the_active_object_stay(body: Body, other: Body) -> None:
    armature_object = build_armature(bpy.context.scene, body)
    bpy.context.view_layer.objects.active = armature_object
    bpy.ops.object.mode_set(mode="POSE")
    set_lengths(armature_object, other)
    assert bpy.context.view_layer.objects.active == armature_object
    assert armature_object.mode == "POSE"


def test_bones_of_another_file_are_left_alone(body: Body, other: Body, tmp_path) -> None:  # noqa: ANN001
    armature_object = build_armature(bpy.context.scene, body)
    name = armature_object.name
    file = str(tmp_path / "rig.blend")
    bpy.data.libraries.write(file, {armature_object})
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(file, link=True) as (_, wanted):
        wanted.objects = [name]
    linked = wanted.objects[0]
    bpy.context.scene.collection.objects.link(linked)
    with pytest.raises(InputError, match="comes from another file"):
        set_lengths(linked, other)
