"""Body mesh on the armature's bones: a tapered, rounded limb for each segment, markers in their colors."""

from collections.abc import Sequence

import bpy
import numpy as np
from mathutils import Matrix

from ...core.arrays import Array, IndexArray
from ...core.body.body_volume import body_pieces, marker_parts, ring_quads
from ...core.body.kinematics import Body
from ...core.footage.region_tracks import MarkerStyle
from .actor_lengths import skeleton_bones

SIDES_OF_RING = 20
RINGS_OF_CAP = 4


def build_body_mesh(
    armature_object: bpy.types.Object, body: Body, markers: Sequence[MarkerStyle]
) -> bpy.types.Object:
    """Add a mesh that the armature moves, each vertex with one bone; returns its object.

    The shaft of a marker's segment has the marker's color, without shading from lights or view transform
    beyond what the renderer adds; caps and all other segments are a plain skin. `trunk` covers pelvis and
    chest.
    """
    materials = [_material("Body", (178, 164, 150))]
    color_of: dict[str, int] = {}
    colored_caps: dict[str, set[int]] = {}
    for marker in markers:
        parts = marker_parts(marker.segment)
        for part in parts:
            color_of[part] = len(materials)
            # Where two parts of one marker meet, the joint between them is colored as well.
            colored_caps[part] = ({1} if part != parts[-1] else set()) | ({0} if part != parts[0] else set())
        materials.append(_material(marker.name, marker.color_srgb))
    axes = {model.name: model for model in skeleton_bones(armature_object, body.skeleton)}
    vertices: list[Array] = []
    faces: list[IndexArray] = []
    colors: list[int] = []
    groups: dict[str, range] = {}
    count = 0
    for piece in body_pieces(body):
        model = axes[piece.segment]
        rest = np.array(armature_object.data.bones[piece.segment].matrix_local, dtype=np.float64)
        rings = piece.rings(SIDES_OF_RING, RINGS_OF_CAP, 1)
        # The joint's frame at the bone's rest, whatever the armature's rest pose is.
        start = body.local(next(s.start for s in body.skeleton.segments if s.name == piece.segment))
        placed = rest[:3, 3] + (rings.reshape(-1, 3) - start) @ model.axes @ rest[:3, :3].T
        quads = ring_quads(len(rings), SIDES_OF_RING)
        vertices.append(placed)
        faces.append(quads.reshape(-1, 4) + count)
        caps = colored_caps.get(piece.segment, set())
        first = 0 if 0 in caps else RINGS_OF_CAP
        bands = range(first, RINGS_OF_CAP + 1 + (RINGS_OF_CAP if 1 in caps else 0))
        material = color_of.get(piece.segment, 0)
        colors += [
            material if band in bands else 0 for band in range(len(quads)) for _ in range(SIDES_OF_RING)
        ]
        groups[piece.segment] = range(count, count + len(placed))
        count += len(placed)
    mesh = _mesh(armature_object.name, np.concatenate(vertices), np.concatenate(faces), colors)
    for material_data in materials:
        mesh.materials.append(material_data)
    return _skinned(armature_object, mesh, groups)


def _mesh(name: str, vertices: Array, faces: IndexArray, colors: list[int]) -> bpy.types.Mesh:
    mesh = bpy.data.meshes.new(f"{name} Body")
    mesh.from_pydata(vertices.tolist(), [], faces.tolist())
    mesh.polygons.foreach_set("material_index", np.array(colors, np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(len(faces), bool))
    mesh.update()
    return mesh


def _skinned(
    armature_object: bpy.types.Object, mesh: bpy.types.Mesh, groups: dict[str, range]
) -> bpy.types.Object:
    body_object = bpy.data.objects.new(mesh.name, mesh)
    for collection in armature_object.users_collection:
        collection.objects.link(body_object)
    body_object.parent = armature_object
    body_object.matrix_parent_inverse = Matrix.Identity(4)
    for name, indices in groups.items():
        body_object.vertex_groups.new(name=name).add(list(indices), 1.0, "REPLACE")
    modifier = body_object.modifiers.new("Armature", "ARMATURE")
    modifier.object = armature_object
    return body_object


def _material(name: str, color_srgb: tuple[int, int, int]) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    linear = (*_linear(color_srgb), 1.0)
    material.diffuse_color = linear
    if material.node_tree is None:  # Blender 5 gives every material its nodes
        material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = linear
    shader.inputs["Roughness"].default_value = 0.9
    return material


def _linear(color_srgb: tuple[int, int, int]) -> tuple[float, ...]:
    share = np.array(color_srgb) / 255.0
    curve = ((share + 0.055) / 1.055) ** 2.4
    return tuple(float(value) for value in np.where(share <= 0.04045, share / 12.92, curve))
