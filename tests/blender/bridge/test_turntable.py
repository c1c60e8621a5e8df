"""Front, side and turning views of the actor, and removing them."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from keymark.core.body.kinematics import Body
from keymark.core.errors import InputError
from keymark.core.take.motion import Motion
from keymark.operators.bridge.actions import assign_action, channelbag_for
from keymark.operators.bridge.armature import build_armature
from keymark.operators.bridge.fcurves import write_motion
from keymark.operators.bridge.keys import add_generated_keys
from keymark.operators.bridge.turntable import (
    Turntable,
    add_turntable,
    remove_turntable,
    show_reference,
    survey,
)
from mathutils import Matrix, Vector

DATA = ("objects", "cameras", "actions", "collections", "movieclips")
TURN = 0.6


@pytest.fixture
def actor(body: Body, wave_motion: Motion) -> bpy.types.Object:
    """An actor that waves, turned by TURN from facing -Y, away from the world's origin."""
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, len(wave_motion.time_s)
    armature_object = build_armature(scene, body)
    write_motion(armature_object, wave_motion)
    armature_object.matrix_world = (
        Matrix.LocRotScale(Vector((2.0, 1.0, 0.0)), Matrix.Rotation(TURN, 3, "Z").to_quaternion(), None)
        @ armature_object.matrix_world
    )
    return armature_object


def views(actor: bpy.types.Object, **options: object) -> Turntable:
    """Survey and views, as the operator has them made."""
    scene = bpy.context.scene
    stage = survey(scene, actor, None, bool(options.get("follow", True)))
    return add_turntable(scene, actor, stage, "Take Views", **options)


def seen(camera: bpy.types.Object, actor: bpy.types.Object, bone: str) -> Vector:
    """Position of a bone's head in a camera's picture, 0 to 1, and its distance [m]."""
    scene = bpy.context.scene
    scene.view_layers[0].update()
    place = actor.matrix_world @ actor.pose.bones[bone].head
    return world_to_camera_view(scene, camera, place)


def test_the_front_view_sees_the_actors_face(actor: bpy.types.Object) -> None:
    """Its left side is on the picture's right; the whole of it is in the picture in every frame."""
    made = views(actor)
    assert made.front.parent.hide_get()  # or lines to it would lie over the actor
    for frame in (1, 7, 13):
        bpy.context.scene.frame_set(frame)
        left, right = (seen(made.front, actor, f"forearm.{side}") for side in "LR")
        assert left.x > right.x + 0.1
        assert left.z == pytest.approx(right.z, abs=0.35)
        for bone in actor.pose.bones:
            for camera in (made.front, made.side, made.turning):
                place = seen(camera, actor, bone.name)
                assert 0.0 < place.x < 1.0 and 0.0 < place.y < 1.0


@pytest.mark.parametrize("side", ["LEFT", "RIGHT"])
def test_the_side_view_sees_the_side_asked_for(actor: bpy.types.Object, side: str) -> None:
    """That arm is the nearer one."""
    made = views(actor, side=side)
    left, right = (seen(made.side, actor, f"upper_arm.{name}") for name in "LR")
    assert (left.z < right.z) == (side == "LEFT")
    assert left.x == pytest.approx(right.x, abs=0.03)


def test_the_turning_view_goes_round_once(actor: bpy.types.Object) -> None:
    """From the front by the back and round again, at one speed, to begin anew after the last frame."""
    scene = bpy.context.scene
    scene.frame_end = 12
    made = views(actor)
    angles = []
    for frame in (1, 4, 7, 10, 13):
        scene.frame_set(frame)
        away = made.turning.matrix_world.translation - made.front.parent.matrix_world.translation
        angles.append(np.arctan2(away.y, away.x))
    turned = np.unwrap(angles) - angles[0]
    assert turned[1:] == pytest.approx(np.pi * np.array([0.5, 1.0, 1.5, 2.0]), abs=1e-4)
    scene.frame_set(1)
    first = tuple(made.front.matrix_world.translation)
    assert tuple(made.turning.matrix_world.translation) == pytest.approx(first, abs=1e-4)


@pytest.mark.parametrize("follow", [True, False])
def test_the_views_follow_the_hips_over_the_floor_only(
    actor: bpy.types.Object, follow: bool, body: Body
) -> None:
    """A walk is followed, a jump is not; nothing is followed where that is not wanted."""
    made = views(actor, follow=follow)
    scene = bpy.context.scene
    scene.frame_set(5)
    before = made.front.matrix_world.translation.copy()
    actor.location += Vector((0.7, -0.4, 0.5))
    scene.view_layers[0].update()
    moved = made.front.matrix_world.translation - before
    assert tuple(moved) == pytest.approx((0.7, -0.4, 0.0) if follow else (0.0, 0.0, 0.0), abs=1e-5)


def test_an_actor_that_turns_all_around_is_seen_from_the_footages_camera(body: Body) -> None:
    """It has no front of its own."""
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 24
    actor = build_armature(scene, body)
    action = bpy.data.actions.new("Spin")
    frames, angles = np.array([1.0, 25.0]), np.array([0.0, 2.0 * np.pi])
    add_generated_keys(channelbag_for(action, actor), "rotation_euler", 2, "Spin", frames, angles)
    assign_action(actor, action)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    camera.location = (3.0, 3.0, 1.0)
    assert survey(scene, actor, camera, True).heading_rad == pytest.approx(np.pi / 4.0, abs=0.01)
    assert survey(scene, actor, None, True).heading_rad == pytest.approx(-np.pi / 2.0, abs=0.01)


def test_nothing_stays_behind(actor: bpy.types.Object) -> None:
    """Counts of everything are as before, renamed or not; what the animator put into the collection stays."""
    scene = bpy.context.scene
    before = {kind: len(getattr(bpy.data, kind)) for kind in DATA}
    scene.frame_set(5)
    made = views(actor)
    assert scene.frame_current == 5
    made.side.name = "Mine"
    own = bpy.data.objects.new("Lamp", None)
    made.collection.objects.link(own)
    remove_turntable(scene, made.collection)
    assert own.name in scene.objects
    bpy.data.objects.remove(own)
    assert {kind: len(getattr(bpy.data, kind)) for kind in DATA} == before


def test_a_reference_clip_lies_behind_a_view_in_its_own_time(
    actor: bpy.types.Object, tiny_take: object
) -> None:
    """Its first frame is shown where asked; without a clip there is none."""
    made = views(actor)
    clip = bpy.data.movieclips.load(str(Path(tiny_take.clip)))
    clip.frame_offset = 2
    show_reference(made.side, clip, -3)
    show_reference(made.side, clip, 4)
    (background,) = made.side.data.background_images
    assert background.clip == clip
    assert clip.frame_start - clip.frame_offset == 4
    assert made.side.data.show_background_images
    show_reference(made.side, None, 4)
    assert len(made.side.data.background_images) == 0


def test_another_armature_is_refused() -> None:
    """The error names the missing bones."""
    stranger = bpy.data.objects.new("Stranger", bpy.data.armatures.new("Stranger"))
    bpy.context.scene.collection.objects.link(stranger)
    with pytest.raises(InputError, match="lacks the bones"):
        survey(bpy.context.scene, stranger, None, True)
