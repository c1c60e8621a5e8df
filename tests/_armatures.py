"""Armatures in Blender, made from characters of `_characters`."""

import bpy
import numpy as np
from keymark.core.retarget.character import Character
from mathutils import Matrix


def build_character(character: Character, scene: bpy.types.Scene | None = None) -> bpy.types.Object:
    """An armature object with the character's bones and scale, active in the context's view layer."""
    armature = bpy.data.armatures.new(character.name)
    armature_object = bpy.data.objects.new(character.name, armature)
    (scene or bpy.context.scene).collection.objects.link(armature_object)
    bpy.context.view_layer.objects.active = armature_object
    bpy.ops.object.mode_set(mode="EDIT")
    for bone in character.bones:
        edit_bone = armature.edit_bones.new(bone.name)
        edit_bone.tail = (0.0, float(np.linalg.norm(bone.tail - bone.head)), 0.0)
        edit_bone.matrix = Matrix(bone.rest)
        edit_bone.use_deform = bone.deforms
        if bone.parent >= 0:
            edit_bone.parent = armature.edit_bones[character.bones[bone.parent].name]
            edit_bone.use_connect = bone.connected
    bpy.ops.object.mode_set(mode="OBJECT")
    armature_object.scale = (character.scale,) * 3
    bpy.context.view_layer.update()
    return armature_object
