"""An actor that was deleted or replaced: keyframes and motion stay, and animate the next one."""

import bpy
import numpy as np
import pytest
from _results import posture_of
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body
from keymark.operators.bridge.armature import build_armature, read_body
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")
FRAME = 7
NEAR = 1e-4


def delete(armature_object: bpy.types.Object) -> None:
    with bpy.context.temp_override(selected_objects=[armature_object], active_object=armature_object):
        assert bpy.ops.object.delete() == {"FINISHED"}


@pytest.mark.parametrize("again", ["apply_lengths", "build_actor"])
@pytest.mark.parametrize("how", ["in the viewport", "from the file"])
def test_a_deleted_actor_comes_back_with_its_keyframes(opened: bpy.types.Scene, how: str, again: str) -> None:
    take = active_take(opened)
    bpy.ops.keymark.apply_lengths()
    opened.frame_set(FRAME)
    before, frames, action = posture_of(opened), TakeState(take).keyed.all, take.keyframe_action
    lengths = read_body(take.armature).actor.segments_m
    stature = read_body(take.armature).actor.stature_m
    if how == "in the viewport":
        delete(take.armature)
    else:
        bpy.data.objects.remove(take.armature)
    assert TakeState(take).actor is None and TakeState(take).has_lost_actor
    assert take.keyframe_action == action and TakeState(take).next[1] == "bring the actor back"
    with pytest.raises(RuntimeError, match="Bring the deleted actor back"):
        bpy.ops.keymark.store_keyframe()

    if again == "apply_lengths":
        assert bpy.ops.keymark.apply_lengths() == {"FINISHED"}
        assert read_body(take.armature).actor.segments_m == pytest.approx(lengths, rel=1e-4)
    else:
        assert bpy.ops.keymark.build_actor(stature=stature) == {"FINISHED"}
    assert TakeState(take).actor is take.armature is not None and not TakeState(take).has_lost_actor
    assert take.armature.animation_data.action == take.keyframe_action == action
    assert TakeState(take).keyed.all == frames
    opened.frame_set(FRAME + 1)
    opened.frame_set(FRAME)
    np.testing.assert_allclose(posture_of(opened).minus(before), 0.0, atol=NEAR)


def test_an_actor_that_stood_higher_at_rest_is_built_where_its_keys_put_it(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    bpy.ops.keymark.build_actor(stature=1.95)  # longer legs, the hips at rest stay
    opened.frame_set(FRAME)
    before = posture_of(opened)
    bpy.data.objects.remove(take.armature)
    bpy.ops.keymark.apply_lengths()
    opened.frame_set(FRAME)
    np.testing.assert_allclose(posture_of(opened).minus(before), 0.0, atol=NEAR)


def test_another_actor_that_is_chosen_is_animated_by_the_takes_keyframes(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    frames = TakeState(take).keyed.all
    first, other = take.armature, build_armature(opened, Body(Actor.from_stature(1.7)))
    take.armature = other
    assert other.animation_data.action == take.keyframe_action and TakeState(take).keyed.all == frames
    own = bpy.data.actions.new("Own")
    first.animation_data.action = own
    take.armature = first
    assert first.animation_data.action == own


def test_a_field_that_was_emptied_gets_the_actor_of_the_scene_back(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    actor, count = take.armature, len(bpy.data.objects)
    take.armature = None
    assert bpy.ops.keymark.apply_lengths() == {"FINISHED"}
    assert take.armature == actor and len(bpy.data.objects) == count


def test_the_field_offers_actors_of_the_scene_alone(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    is_offered = type(take).__annotations__["armature"].keywords["poll"]
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    opened.collection.objects.link(rig)
    assert is_offered(take, take.armature) and not is_offered(take, rig)
    delete(take.armature)
    assert not is_offered(take, take.armature)
