"""Body mesh on the armature's bones: the shipped human skin in the actor's size, markers in their colors."""

from collections.abc import Mapping, Sequence

import bmesh
import bpy
import numpy as np
from bpy.types import Material, Mesh, Object
from numpy.typing import NDArray

from ...core.arrays import Array
from ...core.body.body_volume import marker_parts, segment_piece
from ...core.body.fingers import FINGER_BONES, finger_weights
from ...core.body.human_mesh import HumanMesh
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.body.skeleton import SIDES
from ...core.markers.region_tracks import MarkerStyle
from .armature import has_fingers, read_bones
from .character.rigify_human import skinned

SKIN = (178, 164, 150)
LIMBS = ("upper_arm", "forearm", "hand", "thigh", "shin", "foot")
SEGMENTS: dict[str, dict[str, float]] = {
    **{"hips": {"pelvis": 1.0}, "waist": {"pelvis": 1.0}, "ribs": {"chest": 1.0}, "chest": {"chest": 1.0}},
    **{"neck": {"chest": 0.5, "head": 0.5}, "head": {"head": 1.0}},
    **{f"{part}.{side}": {f"{part}.{side}": 1.0} for part in LIMBS for side in SIDES},
    **{f"shoulder.{side}": {f"girdle.{side}": 1.0} for side in SIDES},
    **{f"toe.{side}": {f"foot.{side}": 1.0} for side in SIDES},
}
"""What of each segment every part of the skin is moved by."""
NECK, CROWN = 0.43, 1.40  # where the skull begins and ends along the head's segment, in its lengths
BALL = 0.73  # where the toes begin along the foot's segment
BESIDE = 0.2 / 1.75  # faces so near to a marker's edge are cut along it, in statures


def build_body_mesh(armature_object: Object, body: Body, markers: Sequence[MarkerStyle]) -> Object:
    """Add a skin that the armature moves, with markers' colors around their segments; returns its object."""
    human, bones = HumanMesh.read(), read_bones(armature_object)
    weights = human.on_bones(SEGMENTS)
    standing = human.fitted(body_joints(body))
    pose, axes = body.pose(Posture.rest(body.skeleton)), {model.name: model.axes for model in bones.models}

    def placed(segment: str, offset: Array) -> Array:
        """Offsets (..., 3) from a segment's start, its joint's frame at the bone's rest, whatever that is."""
        rest = bones.rest[segment]
        return np.asarray(rest[:3, 3] + offset @ axes[segment] @ rest[:3, :3].T)

    vertices = sum(
        share[:, None] * placed(name, standing - body.segment_ends(pose, name)[0])
        for name, share in weights.items()
    )
    for side in SIDES if has_fingers(armature_object) else ():
        wrist, end = (human.joints[f"{part}.{side}"] for part in ("hand", "hand_end"))
        moved = finger_weights((human.vertices - wrist) / np.linalg.norm(end - wrist), side)
        hand = weights[f"hand.{side}"]
        weights |= {bone: hand * share for bone, share in moved.items()}
        weights[f"hand.{side}"] = hand * (1.0 - sum(moved.values()))
    name = f"{armature_object.name} Body"
    body_object = skinned(armature_object, name, np.asarray(vertices), human, weights)
    mesh = body_object.data
    mesh.materials.append(_material("Body", SKIN))
    ends = {}
    for part in {part for marker in markers for part in marker_parts(marker.segment)}:
        piece = segment_piece(body, part)
        ends[part] = placed(
            part, np.stack([piece.start, piece.end]) - body.local(body.skeleton.segment(part).start)
        )
    _cut(mesh, [marker_parts(marker.segment) for marker in markers], ends, body.actor.stature_m)
    segments = _face_segments(body_object)
    centers = np.array([face.center for face in mesh.polygons], dtype=np.float64)
    colors = np.zeros(len(mesh.polygons), dtype=np.int32)
    for number, marker in enumerate(markers, 1):
        mesh.materials.append(_material(marker.name, marker.color_srgb))
        parts = marker_parts(marker.segment)
        for part in parts:
            start, end = ends[part]
            share = (centers - start) @ (end - start) / float((end - start) @ (end - start))
            worn = segments == part
            if part == "chest":
                worn |= np.char.startswith(segments, "girdle")
            worn &= ((share > 0.0) | (part != parts[0])) & ((share < 1.0) | (part != parts[-1]))
            colors[worn] = number
    mesh.polygons.foreach_set("material_index", colors)
    return body_object


def body_joints(body: Body) -> dict[str, Array]:
    """(3,) the joints of a body at rest, by the names of `HumanMesh.joints` [m]."""
    pose = body.pose(Posture.rest(body.skeleton))
    ends = {segment.name: body.segment_ends(pose, segment.name) for segment in body.skeleton.segments}
    neck, along = ends["head"][0], ends["head"][1] - ends["head"][0]
    found = {"neck": neck, "head": neck + NECK * along, "crown": neck + CROWN * along}
    for side in SIDES:
        for part in LIMBS:
            found[f"{part}.{side}"] = ends[f"{part}.{side}"][0]
        found[f"hand_end.{side}"] = ends[f"hand.{side}"][1]
        ankle, tip = ends[f"foot.{side}"]
        ball = ankle + BALL * (tip - ankle)
        found[f"toe.{side}"], found[f"toe_end.{side}"] = ball, np.array([*tip[:2], ball[2]])
    return found


def _cut(mesh: Mesh, worn: Sequence[tuple[str, ...]], ends: Mapping[str, Array], stature_m: float) -> None:
    """Cut the faces straight where markers end, across their first and their last segment."""
    shape = bmesh.new()
    shape.from_mesh(mesh)
    for parts in worn:
        for part, last in ((parts[0], False), (parts[-1], True)):
            start, end = ends[part]
            place = end if last else start
            away = [np.linalg.norm(np.array(face.calc_center_median()) - place) for face in shape.faces]
            beside = [face for face, far in zip(shape.faces, away, strict=True) if far < BESIDE * stature_m]
            edges = {edge for face in beside for edge in face.edges}
            vertices = {vertex for face in beside for vertex in face.verts}
            bmesh.ops.bisect_plane(
                shape, geom=[*vertices, *edges, *beside], dist=1e-5, plane_co=place, plane_no=end - start
            )
    shape.to_mesh(mesh)
    shape.free()


def _face_segments(body_object: Object) -> NDArray[np.str_]:
    """(Q,) name of the segment that moves each face most."""
    mesh, groups = body_object.data, [group.name for group in body_object.vertex_groups]
    names = [f"hand.{name[-1]}" if name in FINGER_BONES else name for name in groups]
    weights = np.zeros((len(mesh.vertices), len(names)))
    for vertex in mesh.vertices:
        for group in vertex.groups:
            weights[vertex.index, group.group] = group.weight
    strongest = [int(weights[list(face.vertices)].sum(axis=0).argmax()) for face in mesh.polygons]
    return np.array(names)[strongest]


def _material(name: str, color_srgb: tuple[int, int, int]) -> Material:
    material = bpy.data.materials.new(name)
    level = np.array(color_srgb) / 255.0
    linear = (*np.where(level <= 0.04045, level / 12.92, ((level + 0.055) / 1.055) ** 2.4).tolist(), 1.0)
    material.diffuse_color = linear
    if material.node_tree is None:  # Blender 5 gives every material its nodes
        material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = linear
    shader.inputs["Roughness"].default_value = 0.9
    return material
