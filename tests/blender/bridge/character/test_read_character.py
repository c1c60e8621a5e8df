"""Characters are read as they rest, and what cannot be retargeted is refused with a sentence."""

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from _armatures import add_rig, build_character, retargeted
from _characters import plain_character
from keymark.core.body.kinematics import SegmentMotion
from keymark.core.errors import InputError
from keymark.core.retarget.recognition.recognize import recognize
from keymark.core.take.conversion_settings import LimbKeys, RetargetOptions
from keymark.operators.bridge.character.read_character import make_override, needs_override, read_character


@pytest.fixture
def character() -> bpy.types.Object:
    """A deform skeleton."""
    return build_character(plain_character(scale=0.01, roll_rad=0.7))


def test_bones_are_read_as_they_were_built(character: bpy.types.Object) -> None:
    built, read = plain_character(scale=0.01, roll_rad=0.7), read_character(character)
    assert read.scale == pytest.approx(0.01)
    assert set(read.index) == set(built.index)
    for number, bone in enumerate(read.bones):
        other = built.bone(bone.name)
        assert bone.parent < number
        assert bone.rest == pytest.approx(other.rest, abs=1e-3)
        assert bone.tail == pytest.approx(other.tail, abs=1e-3)
        parents = [
            r.bones[b.parent].name if b.parent >= 0 else None for r, b in ((read, bone), (built, other))
        ]
        assert parents[0] == parents[1]


def no_armature() -> bpy.types.Object:
    """An empty."""
    return bpy.data.objects.new("Thing", None)


def changed(change: Callable[[bpy.types.Object], object]) -> Callable[[], bpy.types.Object]:
    """A character that something was done to."""

    def make() -> bpy.types.Object:
        made = build_character(plain_character())
        change(made)
        bpy.context.view_layer.update()
        return made

    return make


def without_bones(made: bpy.types.Object) -> None:
    """Other armature data."""
    made.data = bpy.data.armatures.new("Bare")


def edited(made: bpy.types.Object) -> None:
    """Left in Edit Mode."""
    bpy.ops.object.mode_set(mode="EDIT")


def tweaked(made: bpy.types.Object) -> None:
    """An NLA strip that is tweaked."""
    action = bpy.data.actions.new("Strip")
    slot = action.slots.new(id_type="OBJECT", name=made.name)
    data = made.animation_data_create()
    strip = data.nla_tracks.new().strips.new("Strip", 1, action)
    strip.action_slot = slot
    data.nla_tracks[0].select = strip.select = True
    data.nla_tracks.active = data.nla_tracks[0]
    data.use_tweak_mode = True


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (no_armature, "'Thing' is not an armature"),
        (lambda: None, "nothing is not an armature"),
        (changed(without_bones), "has no bones"),
        (changed(edited), "Edit Mode"),
        (changed(lambda made: setattr(made, "scale", (1.0, 2.0, 1.0))), "is scaled by 1, 2, 1 along"),
        (changed(lambda made: setattr(made, "scale", (-1.0, 1.0, 1.0))), "is mirrored by a negative"),
        (changed(lambda made: setattr(made, "scale", (0.0, 0.0, 0.0))), "scale of zero"),
        (changed(lambda made: setattr(made, "location", (np.nan, 0.0, 0.0))), "not a number"),
        (changed(lambda made: setattr(made.data, "pose_position", "REST")), "rest position"),
        (changed(lambda made: made.hide_set(True)), "is hidden"),
        (changed(lambda made: bpy.context.scene.collection.objects.unlink(made)), "in no scene"),
        (changed(tweaked), "tweak mode"),
    ],
)
def test_what_cannot_be_retargeted_is_refused(make: Callable[[], bpy.types.Object], words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_character(make())


def test_a_linked_character_is_refused_until_it_is_overridden(
    rigify_blend: Path, source: SegmentMotion
) -> None:
    linked = add_rig(rigify_blend, link=True)
    assert needs_override(linked)
    with pytest.raises(InputError, match="library override"):
        read_character(linked)
    made = make_override(bpy.context, linked)
    assert not needs_override(made)
    character = read_character(made)
    assert len(character.bones) == len(linked.data.bones)
    known = recognize(character).character_map
    done = retargeted(made, known, source, RetargetOptions(arms=LimbKeys.BOTH, legs=LimbKeys.BOTH))
    assert made.animation_data.action.name == "Steps"
    assert done.quality.ik_fk_mm is not None and done.quality.ik_fk_mm < 1.0
