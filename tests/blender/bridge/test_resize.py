"""Other lengths for an actor that is there."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.errors import InputError
from keymark.operators.bridge.armature import read_body, set_lengths
from keymark.operators.bridge.pose import read_posture, write_posture


@pytest.fixture
def other(body: Body) -> Body:
    rng = np.random.default_rng(5)
    return Body(Actor({n: v * float(rng.uniform(0.8, 1.25)) for n, v in body.actor.segments_m.items()}))


def test_the_bones_get_the_lengths_and_the_pose_stays(
    actor: bpy.types.Object, other: Body, random_posture: Callable[[int], Posture]
) -> None:
    actor.location, actor.rotation_euler, actor.scale = (0.4, -1.0, 0.2), (0.1, 0.2, 1.0), (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    posture = random_posture(3)
    write_posture(actor, posture)
    set_lengths(actor, other)
    found = read_posture(actor, read_body(actor))
    assert found.furthest_m < 1e-4
    np.testing.assert_allclose(found.posture.minus(posture), 0.0, atol=1e-4)
    shown = read_body(actor).actor.segments_m
    assert dict(shown) == pytest.approx(dict(other.actor.segments_m), rel=1e-4)


def test_the_mode_and_the_active_object_stay(actor: bpy.types.Object, other: Body) -> None:
    bpy.context.view_layer.objects.active = actor
    bpy.ops.object.mode_set(mode="POSE")
    set_lengths(actor, other)
    assert bpy.context.view_layer.objects.active == actor
    assert actor.mode == "POSE"


def test_bones_of_another_file_are_left_alone(actor: bpy.types.Object, other: Body, tmp_path) -> None:  # noqa: ANN001
    name = actor.name
    file = str(tmp_path / "rig.blend")
    bpy.data.libraries.write(file, {actor})
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(file, link=True) as (_, wanted):
        wanted.objects = [name]
    linked = wanted.objects[0]
    bpy.context.scene.collection.objects.link(linked)
    with pytest.raises(InputError, match="comes from another file"):
        set_lengths(linked, other)
