"""Read an armature object as core's `Character`, and say why one cannot be retargeted."""

import bpy
import numpy as np
from bpy.types import Context, Object

from ....core.errors import InputError
from ....core.retarget.character import Character, CharacterBone
from ..actor_bones import object_space


def read_character(armature_object: Object | None) -> Character:
    """The rest pose of an armature object; InputError where something is in the way of a motion on it."""
    checked = require_character(armature_object)
    bones = [bone for bone in checked.data.bones if bone.parent is None]
    for bone in bones:  # parents before children
        bones += bone.children
    index = {bone.name: number for number, bone in enumerate(bones)}
    read = (
        CharacterBone(
            bone.name,
            -1 if bone.parent is None else index[bone.parent.name],
            np.array(bone.matrix_local, dtype=np.float64),
            np.array(bone.tail_local, dtype=np.float64),
            deforms=bone.use_deform,
            connected=bone.use_connect and bone.parent is not None,
        )
        for bone in bones
    )
    return Character(checked.name, tuple(read), object_space(checked).scale)


def require_character(armature_object: Object | None) -> Object:
    """The armature object; InputError where something is in the way of a motion on it."""
    if armature_object is None or armature_object.type != "ARMATURE":
        name = "nothing" if armature_object is None else f"'{armature_object.name}'"
        raise InputError(f"{name} is not an armature; select the armature of the character")
    name, data = f"armature '{armature_object.name}'", armature_object.animation_data
    if not len(armature_object.data.bones):
        raise InputError(f"{name} has no bones; select the armature of the character")
    if armature_object.mode == "EDIT":
        raise InputError(f"{name} is in Edit Mode, in which no pose shows; leave it (Tab)")
    if needs_override(armature_object):
        raise InputError(
            f"{name} is linked from {_library_name(armature_object)} and keeps no keys; make "
            "a library override of it (Object > Library Override > Make)"
        )
    if armature_object.data.pose_position == "REST":
        raise InputError(f"{name} shows its rest position; choose Pose Position in its data properties")
    matrix = np.array(armature_object.matrix_world, dtype=np.float64)
    if not np.isfinite(matrix).all():
        advice = "clear its location, rotation and scale"
        raise InputError(f"{name} has a transform that is not a number; {advice}")
    if np.linalg.norm(matrix[:3, :3], axis=0).min() < 1e-9:
        raise InputError(f"{name} has a scale of zero; give it one positive scale")
    object_space(armature_object)  # which refuses what is no similarity
    scenes = armature_object.users_scene
    if not scenes:
        raise InputError(f"{name} is in no scene; link it to one")
    layer = bpy.context.view_layer if bpy.context.scene in scenes else scenes[0].view_layers[0]
    if not armature_object.visible_get(view_layer=layer):
        raise InputError(
            f"{name} is hidden in view layer '{layer.name}', where Blender evaluates no "
            "pose; show it while the motion is made"
        )
    if data is not None and data.use_tweak_mode:
        raise InputError(
            f"{name} has an NLA strip in tweak mode, which locks its Action; leave tweak "
            "mode (Tab in the NLA editor)"
        )
    return armature_object


def needs_override(armature_object: Object) -> bool:
    """Whether an armature object is linked from another file, so that keys on it would be lost."""
    override = armature_object.override_library
    if override is not None:
        return bool(override.is_system_override)
    return armature_object.library is not None


def make_override(context: Context, armature_object: Object) -> Object:
    """Make a library override of a linked armature object and of what belongs to it; returns the override."""
    name = armature_object.name
    if not needs_override(armature_object):
        raise InputError(f"armature '{name}' is not linked; it can be keyed as it is")
    if armature_object.override_library is not None:
        armature_object.override_library.is_system_override = False
        return armature_object
    made = armature_object.override_hierarchy_create(
        context.scene, context.view_layer, do_fully_editable=True
    )
    if made is None or made.type != "ARMATURE":
        raise InputError(
            f"Blender makes no library override of armature '{name}'; append it from "
            f"{_library_name(armature_object)} instead"
        )
    return made


def _library_name(armature_object: Object) -> str:
    override = armature_object.override_library
    reference = armature_object if override is None else override.reference
    return f"'{bpy.path.basename(reference.library.filepath)}'" if reference.library else "another file"
