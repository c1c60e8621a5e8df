"""The meshes of a character."""

import bpy


def skins(armature_object: bpy.types.Object) -> list[bpy.types.Object]:
    """The rendered meshes that the armature deforms or carries, in its first scene."""
    found = []
    for scene in armature_object.users_scene[:1]:
        for one in scene.objects:
            if one.type == "MESH" and not one.hide_render:
                if is_deformed(one, armature_object) or one.parent == armature_object:
                    found.append(one)
    return found


def is_deformed(mesh_object: bpy.types.Object, armature_object: bpy.types.Object) -> bool:
    """Whether an armature deforms a mesh."""
    by_modifier = any(
        modifier.type == "ARMATURE" and modifier.object == armature_object
        for modifier in mesh_object.modifiers
    )
    return by_modifier or (mesh_object.parent == armature_object and mesh_object.parent_type == "ARMATURE")
