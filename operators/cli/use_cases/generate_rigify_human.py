"""Script that lets Blender's own Rigify generate its basic human, with a simple body on it, into a .blend.

Usage: generate_rigify_human.py FILE, in a Python that has Blender as a module; or in Blender after `--`.
Run it in a process of its own: one that has used Rigify may hang when it ends as usual (seen with Blender 4.5
as a module), so this one ends at once.
"""

import os
import sys
import traceback

import bpy
from mathutils import Matrix, Vector

WIDTHS = {
    "thigh": 0.075,
    "shin": 0.055,
    "foot": 0.045,
    "toe": 0.035,
    "upper_arm": 0.05,
    "forearm": 0.04,
    "hand": 0.04,
}
"""Half the width of the body around a bone [m]; trunk and head by `TRUNK`."""
TRUNK = {
    "spine": 0.13,
    "spine.001": 0.12,
    "spine.002": 0.13,
    "spine.003": 0.14,
    "spine.004": 0.06,
    "spine.006": 0.09,
}
OTHERS = 0.05
COLORS = {"L": (0.0, 0.17, 0.45, 1.0), "R": (0.66, 0.11, 0.0, 1.0), "": (0.5, 0.47, 0.45, 1.0)}
SEGMENTS = 16


def generate() -> bpy.types.Object:
    """Add Rigify's basic human to an empty file and generate its rig."""
    import addon_utils  # can be found once bpy is loaded

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    # Without default_set Rigify finds no preferences of its own and cannot generate.
    addon_utils.enable("rigify", default_set=True)
    bpy.ops.object.armature_basic_human_metarig_add()
    metarig = bpy.context.object
    bpy.ops.pose.rigify_generate()
    rig = next(one for one in bpy.data.objects if one.type == "ARMATURE" and one != metarig)
    bpy.data.objects.remove(metarig)
    rig.name = rig.data.name = "Human"
    return rig


def add_body(rig: bpy.types.Object) -> None:
    """Give the rig a mesh: an ellipsoid around each deform bone, which it moves rigidly."""
    import bmesh

    mesh = bpy.data.meshes.new("Human Body")
    body = bpy.data.objects.new("Human Body", mesh)
    rig.users_collection[0].objects.link(body)
    body.parent = rig
    for side, color in COLORS.items():
        material = bpy.data.materials.new(f"Human {side or 'Middle'}")
        material.diffuse_color = color
        mesh.materials.append(material)
    shape = bmesh.new()
    groups = shape.verts.layers.deform.new()
    for bone in (bone for bone in rig.data.bones if bone.use_deform):
        group = body.vertex_groups.new(name=bone.name)
        part, _, side = bone.name.removeprefix("DEF-").partition(".")
        width = TRUNK.get(bone.name.removeprefix("DEF-")) or WIDTHS.get(part, OTHERS)
        along = bone.tail_local - bone.head_local
        axes = bone.matrix_local.to_3x3()
        turn = Matrix.LocRotScale(
            0.5 * (bone.head_local + bone.tail_local),
            axes.to_quaternion(),
            Vector((width, 0.62 * along.length, width)),
        )
        made = bmesh.ops.create_uvsphere(
            shape, u_segments=SEGMENTS, v_segments=SEGMENTS // 2, radius=1.0, matrix=turn
        )
        letter = side[:1] if side[:1] in COLORS else ""
        for vertex in made["verts"]:
            vertex[groups][group.index] = 1.0
        for face in {face for vertex in made["verts"] for face in vertex.link_faces}:
            face.smooth = True
            face.material_index = list(COLORS).index(letter)
    shape.to_mesh(mesh)
    shape.free()
    modifier = body.modifiers.new("Armature", "ARMATURE")
    modifier.object = rig


def main(path: str) -> int:
    """Generate and save; returns the exit status."""
    try:
        add_body(generate())
        bpy.ops.wm.save_as_mainfile(filepath=path, compress=True)
    except Exception:
        traceback.print_exc()
        return 1
    return 0


if __name__ == "__main__":
    status = main(sys.argv[-1])
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
