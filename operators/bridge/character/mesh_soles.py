"""The soles of a character's feet, from the meshes that its armature deforms."""

from collections.abc import Mapping

import bpy
import numpy as np

from ....core.arrays import Array
from ....core.body.skeleton import SIDES
from ....core.retarget.character import LEG, LONG_BONES, Character
from ....core.retarget.character_motion import find_stance
from ....core.retarget.maps.character_map import CharacterMap, Point
from .controls import active_constraints, constraint_bones
from .import_character import is_deformed, skins

PARTS = LEG[2:]
NEAR = 0.35  # largest distance of a sole's vertex from ankle or toe, in lengths of the leg
SOLE = 0.02  # height of the band above the lowest vertex of a foot that is its sole, in lengths of the leg
LOWEST, HIGHEST = 0.01, 0.3  # height of an ankle over its sole, in lengths of the leg; others are not feet
HEEL = 0.01  # least length of a foot's sole on either side of the ankle, in lengths of the leg
DIRECTIONS = 8  # directions along the ground in which a sole's outermost vertices are kept
MOST_VERTICES = 400_000  # vertices of a mesh that is looked at


def mesh_soles(
    armature_object: bpy.types.Object, character: Character, character_map: CharacterMap
) -> dict[str, tuple[Point, ...]]:
    """Points of the soles by role, in the armature's space; nothing where no mesh shows a foot."""
    stance, leading = find_stance(character, character_map), _leading_roles(armature_object, character_map)
    joints: dict[str, Array] = {}
    for role in (f"{part}.{side}" for part in LEG for side in SIDES):
        bone = character_map.bone(role)
        if bone is not None:
            joints[role] = character.bone(bone).head
    legs = {
        side: sum(float(np.linalg.norm(joints[b] - joints[a])) for a, b in LONG_BONES[f"leg.{side}"])
        for side in SIDES
    }
    found: dict[str, list[Array]] = {}
    for mesh_object in skins(armature_object):
        mesh = mesh_object.data
        if not is_deformed(mesh_object, armature_object) or len(mesh.vertices) > MOST_VERTICES:
            continue
        places = _places(armature_object, mesh_object)
        near = np.zeros(len(places), dtype=bool)
        for role in (role for role in joints if role.partition(".")[0] in PARTS):
            near |= np.linalg.norm(places - joints[role], axis=-1) < NEAR * legs[role[-1]]
        groups = mesh_object.vertex_groups
        roles = {group.index: leading[group.name] for group in groups if group.name in leading}
        for index in map(int, np.flatnonzero(near)):
            weights = [(group.weight, group.group) for group in mesh.vertices[index].groups]
            role = roles.get(max(weights)[1], "") if weights else ""
            if role.partition(".")[0] in PARTS:
                found.setdefault(role, []).append(places[index])
    soles: dict[str, tuple[Point, ...]] = {}
    for side in SIDES:
        own = {role: np.array(points) for role, points in found.items() if role.endswith(f".{side}")}
        if f"foot.{side}" in own:
            soles |= _soles_of(own, joints[f"foot.{side}"], legs[side], stance)
    return soles


def _places(armature_object: bpy.types.Object, mesh_object: bpy.types.Object) -> Array:
    """(N, 3) vertices of a mesh in the armature's space."""
    flat = np.empty(3 * len(mesh_object.data.vertices), dtype=np.float32)
    mesh_object.data.vertices.foreach_get("co", flat)
    to_armature = np.array(armature_object.matrix_world.inverted_safe() @ mesh_object.matrix_world)
    return flat.reshape(-1, 3).astype(np.float64) @ to_armature[:3, :3].T + to_armature[:3, 3]


def _leading_roles(armature_object: bpy.types.Object, character_map: CharacterMap) -> dict[str, str]:
    """By bone the role of the bone that it follows: its own, or the nearest one above."""
    role_of = {bone: role for role in character_map.roles for bone in character_map.bones(role)}
    found: dict[str, str] = {}
    for bone in armature_object.pose.bones:
        at: bpy.types.PoseBone | None = bone
        for _ in range(64):
            if at is None or at.name in role_of:
                break
            copied = [
                name
                for constraint in active_constraints(at)
                if constraint.type in ("COPY_TRANSFORMS", "ARMATURE")
                for name in constraint_bones(armature_object, constraint)
            ]
            at = armature_object.pose.bones.get(copied[0]) if copied else at.parent
        if at is not None and at.name in role_of:
            found[bone.name] = role_of[at.name]
    return found


def _soles_of(
    vertices: Mapping[str, Array], ankle: Array, leg: float, stance: Array
) -> dict[str, tuple[Point, ...]]:
    """The outermost points of a foot's sole by role; none where these are no feet."""
    heights = {role: points @ stance[2] for role, points in vertices.items()}
    low = min(float(height.min()) for height in heights.values())
    if not LOWEST * leg < float(ankle @ stance[2]) - low < HIGHEST * leg:
        return {}
    soles: dict[str, tuple[Point, ...]] = {}
    ahead = np.zeros(0)
    for role, points in vertices.items():
        sole = points[heights[role] < low + SOLE * leg]
        if not len(sole):
            continue
        kept = _outermost(sole, stance)
        soles[role] = tuple((float(x), float(y), float(z)) for x, y, z in kept)
        if role.startswith("foot"):
            ahead = -((kept - ankle) @ stance[1])
    both = len(ahead) > 0 and ahead.min() < -HEEL * leg and ahead.max() > HEEL * leg
    return soles if both else {}


def _outermost(points: Array, stance: Array) -> Array:
    """The lowest point, and those farthest along the ground in several directions."""
    level = points @ stance[:2].T
    angles = 2.0 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    rows = [int((level @ [np.cos(angle), np.sin(angle)]).argmax()) for angle in angles]
    rows.append(int((points @ stance[2]).argmin()))
    return points[np.unique(rows)]
