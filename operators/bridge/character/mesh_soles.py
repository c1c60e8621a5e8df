"""The soles of a character's feet, from the meshes that its armature deforms."""

from collections.abc import Mapping

import bpy
import numpy as np

from ....core.arrays import Array, IndexArray
from ....core.body.skeleton import SIDES
from ....core.retarget.character import Character
from ....core.retarget.character_motion import find_stance
from ....core.retarget.maps.character_map import CharacterMap, Point
from .controls import active_constraints, constraint_bones
from .import_character import is_deformed, skins

PARTS = ("foot", "toe")
NEAR = 0.35  # largest distance of a sole's vertex from ankle or toe, in lengths of the leg
SOLE = 0.02  # height of the band above the lowest vertex of a foot that is its sole, in lengths of the leg
LOWEST, HIGHEST = 0.01, 0.3  # height of an ankle over its sole, in lengths of the leg; others are not feet
HEEL = 0.01  # least length of a foot's sole on either side of the ankle, in lengths of the leg
DIRECTIONS = 8  # directions along the ground in which a sole's outermost vertices are kept
MOST_VERTICES = 400_000  # vertices of a mesh that is looked at
MOST_STEPS = 64


def mesh_soles(
    armature_object: bpy.types.Object, character: Character, character_map: CharacterMap
) -> dict[str, tuple[Point, ...]]:
    """Points of the soles by role, in the armature's space; nothing where no mesh shows a foot."""
    stance = find_stance(character, character_map)
    found: dict[str, list[Array]] = {}
    leading = _leading_roles(armature_object, character_map)
    for mesh_object in skins(armature_object):
        if is_deformed(mesh_object, armature_object) and len(mesh_object.data.vertices) <= MOST_VERTICES:
            for role, points in _foot_vertices(
                armature_object, mesh_object, character, character_map, leading
            ).items():
                found.setdefault(role, []).append(points)
    soles: dict[str, tuple[Point, ...]] = {}
    for side in SIDES:
        soles |= _soles_of(
            {role: np.concatenate(points) for role, points in found.items() if role.endswith(f".{side}")},
            character,
            character_map,
            side,
            stance,
        )
    return soles


def _leading_roles(armature_object: bpy.types.Object, character_map: CharacterMap) -> dict[str, str]:
    """By bone the role of the bone that it follows: its own, or the nearest one above."""
    role_of = {bone: role for role in character_map.roles for bone in character_map.bones(role)}
    found: dict[str, str] = {}
    for bone in armature_object.pose.bones:
        at: bpy.types.PoseBone | None = bone
        for _ in range(MOST_STEPS):
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


def _foot_vertices(
    armature_object: bpy.types.Object,
    mesh_object: bpy.types.Object,
    character: Character,
    character_map: CharacterMap,
    leading: Mapping[str, str],
) -> dict[str, Array]:
    """(N, 3) by role of foot and toe the vertices near it that move with it, in the armature's space."""
    mesh = mesh_object.data
    flat = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", flat)
    to_armature = np.array(armature_object.matrix_world.inverted_safe() @ mesh_object.matrix_world)
    places = flat.reshape(-1, 3).astype(np.float64) @ to_armature[:3, :3].T + to_armature[:3, 3]
    roles = {group.index: leading[group.name] for group in mesh_object.vertex_groups if group.name in leading}
    found: dict[str, list[int]] = {}
    for index in _near_feet(places, character, character_map):
        weights = [(group.weight, group.group) for group in mesh.vertices[int(index)].groups]
        role = roles.get(max(weights)[1], "") if weights else ""
        if role.partition(".")[0] in PARTS:
            found.setdefault(role, []).append(int(index))
    return {role: places[indices] for role, indices in found.items()}


def _near_feet(places: Array, character: Character, character_map: CharacterMap) -> IndexArray:
    near = np.zeros(len(places), dtype=bool)
    for side in SIDES:
        for part in PARTS:
            bone = character_map.bone(f"{part}.{side}")
            if bone is not None:
                apart = np.linalg.norm(places - character.bone(bone).head, axis=-1)
                near |= apart < NEAR * _leg(character, character_map, side)
    return np.flatnonzero(near)


def _leg(character: Character, character_map: CharacterMap, side: str) -> float:
    joints = [
        character.bone(str(character_map.bone(f"{part}.{side}"))).head for part in ("thigh", "shin", "foot")
    ]
    return float(np.linalg.norm(np.diff(joints, axis=0), axis=-1).sum())


def _soles_of(
    vertices: Mapping[str, Array], character: Character, character_map: CharacterMap, side: str, stance: Array
) -> dict[str, tuple[Point, ...]]:
    """The outermost points of a foot's sole by role; none where these are no feet."""
    if f"foot.{side}" not in vertices:
        return {}
    leg = _leg(character, character_map, side)
    heights = {role: points @ stance[2] for role, points in vertices.items()}
    low = min(float(height.min()) for height in heights.values())
    ankle = float(character.bone(str(character_map.bone(f"foot.{side}"))).head @ stance[2]) - low
    if not LOWEST * leg < ankle < HIGHEST * leg:
        return {}
    soles = {}
    for role, points in vertices.items():
        sole = points[heights[role] < low + SOLE * leg]
        if len(sole):
            soles[role] = tuple(_point(point) for point in _outermost(sole, stance))
    foot = np.array(soles.get(f"foot.{side}", ())).reshape(-1, 3)
    ahead = -((foot - character.bone(str(character_map.bone(f"foot.{side}"))).head) @ stance[1])
    both = len(ahead) > 0 and ahead.min() < -HEEL * leg and ahead.max() > HEEL * leg
    return soles if both else {}


def _outermost(points: Array, stance: Array) -> Array:
    """The lowest point, and those farthest along the ground in several directions."""
    level = points @ stance[:2].T
    angles = 2.0 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    rows = [int((level @ [np.cos(angle), np.sin(angle)]).argmax()) for angle in angles]
    rows.append(int((points @ stance[2]).argmin()))
    return points[np.unique(rows)]


def _point(values: Array) -> Point:
    x, y, z = (float(value) for value in values)
    return x, y, z
