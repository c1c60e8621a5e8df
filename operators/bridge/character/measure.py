"""What a character shows, frame by frame: its motion with the limbs in IK and in FK, and its soles."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

import bpy
import numpy as np
from bpy.types import Action, Mesh, Object, PoseBone

from ....core.arrays import Array, IndexArray
from ....core.body.kinematics import SegmentMotion
from ....core.body.skeleton import SIDES
from ....core.progress import Part, scaled
from ....core.retarget.character import JOINTS, LEG, LIMBS, LONG_BONES, Character
from ....core.retarget.character_motion import CharacterMotion, find_stance
from ....core.retarget.maps.character_map import CharacterMap, Point
from ....core.retarget.quality import Measured, farthest_mm, measured
from ..actions import curves_of
from ..actor_bones import evaluated, object_space
from ..motions.read_poses import shown_poses
from ..scene_frames import each_frame
from .held_controls import Property, Value, active_constraints, constraint_targets, posing, property_path
from .import_character import carrying_bone, is_deformed, skins

PARTS = LEG[2:]
NEAR = 0.35  # largest distance of a sole's vertex from ankle or toe, in lengths of the leg
SOLE = 0.02  # height of the band above the lowest vertex of a foot that is its sole, in lengths of the leg
LOWEST, HIGHEST = 0.01, 0.3  # height of an ankle over its sole, in lengths of the leg; others are not feet
HEEL = 0.01  # least length of a foot's sole on either side of the ankle, in lengths of the leg
ANGLES = 2.0 * np.pi * np.arange(8) / 8  # directions along the ground in which outermost vertices are kept
MOST_VERTICES = 400_000  # vertices of a mesh that is looked at


@dataclass(frozen=True, eq=False)
class FootVertices:
    """The vertices of a mesh that a foot and its toes move, at rest."""

    mesh_object: Object
    rows: Mapping[str, IndexArray]  # (N,) indices of the mesh's vertices by role of foot and toe
    places: Mapping[str, Array]  # (N, 3) by role, in the armature's space


def mesh_soles(
    armature_object: Object, character: Character, character_map: CharacterMap
) -> dict[str, tuple[Point, ...]]:
    """The outermost points of the soles by role, in the armature's space; none where no mesh shows a foot."""
    stance, (joints, legs) = find_stance(character, character_map), _legs(character, character_map)
    feet = foot_vertices(armature_object, character, character_map)
    soles: dict[str, tuple[Point, ...]] = {}
    for side, leg in legs.items():
        roles = [f"{part}.{side}" for part in PARTS]
        own = {role: [foot.places[role] for foot in feet if role in foot.places] for role in roles}
        vertices = {role: np.concatenate(places) for role, places in own.items() if places}
        if f"foot.{side}" not in vertices:
            continue
        ankle = joints[f"foot.{side}"]
        low = min(float((points @ stance[2]).min()) for points in vertices.values())
        found: dict[str, Array] = {}
        for role, points in vertices.items():
            sole = points[points @ stance[2] < low + SOLE * leg]
            if len(sole):
                level = sole @ stance[:2].T  # kept are the lowest point, and the farthest along the ground
                outermost = (level @ [np.cos(ANGLES), np.sin(ANGLES)]).argmax(axis=0)
                found[role] = sole[np.unique([*outermost, (sole @ stance[2]).argmin()])]
        ahead = -((found.get(f"foot.{side}", np.zeros((0, 3))) - ankle) @ stance[1])
        both = len(ahead) > 0 and ahead.min() < -HEEL * leg and ahead.max() > HEEL * leg
        if both and LOWEST * leg < float(ankle @ stance[2]) - low < HIGHEST * leg:  # else these are no feet
            soles |= {role: tuple(map(tuple, kept.tolist())) for role, kept in found.items()}
    return soles


def foot_vertices(
    armature_object: Object, character: Character, character_map: CharacterMap
) -> list[FootVertices]:
    """The vertices that feet and toes move, by deforming a mesh or by carrying one, near the feet at rest."""
    leading, (joints, legs) = leading_roles(armature_object, character_map), _legs(character, character_map)
    found: list[FootVertices] = []
    for mesh_object in skins(armature_object):
        if len(mesh_object.data.vertices) > MOST_VERTICES:
            continue
        deformed = is_deformed(mesh_object, armature_object)
        bone = None if deformed else carrying_bone(mesh_object, armature_object)
        places = _places(armature_object, mesh_object, bone)
        near = np.zeros(len(places), dtype=bool)
        for role in (role for role in joints if role.partition(".")[0] in PARTS):
            near |= np.linalg.norm(places - joints[role], axis=-1) < NEAR * legs[role[-1]]
        if deformed:
            rows = foot_rows(mesh_object, mesh_object.data, np.flatnonzero(near), leading)
        else:
            role = leading.get(bone or "", "")
            rows = {role: np.flatnonzero(near)} if role.partition(".")[0] in PARTS and near.any() else {}
        if rows:
            own = {role: places[indices] for role, indices in rows.items()}
            found.append(FootVertices(mesh_object, rows, own))
    return found


def foot_rows(
    mesh_object: Object, mesh: Mesh, indices: IndexArray, leading: Mapping[str, str]
) -> dict[str, IndexArray]:
    """By role of foot and toe: which of some vertices (N,) the bones that follow it move most."""
    roles = {group.index: leading.get(group.name, "") for group in mesh_object.vertex_groups}
    found: dict[str, list[int]] = {}
    for index in map(int, indices):
        weights = [(group.weight, group.group) for group in mesh.vertices[index].groups]
        role = roles.get(max(weights)[1], "") if weights else ""
        if role.partition(".")[0] in PARTS:
            found.setdefault(role, []).append(index)
    return {role: np.array(rows, dtype=np.intp) for role, rows in found.items()}


def _legs(character: Character, character_map: CharacterMap) -> tuple[dict[str, Array], dict[str, float]]:
    """(3,) the joints of the legs by role, in the armature's space, and the legs' lengths by side."""
    bones = {f"{part}.{side}": character_map.bone(f"{part}.{side}") for part in LEG for side in SIDES}
    joints = {role: character.bone(bone).head for role, bone in bones.items() if bone is not None}
    pairs = {side: LONG_BONES[f"leg.{side}"] for side in SIDES}
    return joints, {
        side: sum(float(np.linalg.norm(joints[end] - joints[start])) for start, end in bones)
        for side, bones in pairs.items()
        if all(role in joints for bone in bones for role in bone)
    }


def _places(armature_object: Object, mesh_object: Object, bone: str | None) -> Array:
    """(N, 3) vertices of a mesh in the armature's space; those that a bone carries as its rest has them."""
    flat = np.empty(3 * len(mesh_object.data.vertices), dtype=np.float32)
    mesh_object.data.vertices.foreach_get("co", flat)
    shown = evaluated(armature_object)
    to_armature = shown.matrix_world.inverted_safe() @ evaluated(mesh_object).matrix_world
    if bone:
        rest, pose = armature_object.data.bones[bone].matrix_local, shown.pose.bones[bone].matrix
        to_armature = rest @ pose.inverted_safe() @ to_armature
    matrix = np.array(to_armature, dtype=np.float64)
    return flat.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]


def leading_roles(armature_object: Object, character_map: CharacterMap) -> dict[str, str]:
    """By bone the role of the bone that it follows: its own, or the nearest one above."""
    role_of = {bone: role for role in character_map.roles for bone in character_map.bones(role)}
    found: dict[str, str] = {}
    for bone in armature_object.pose.bones:
        at: PoseBone | None = bone
        for _ in range(64):
            if at is None or at.name in role_of:
                break
            copied = [
                name
                for constraint in active_constraints(at)
                if constraint.type in ("COPY_TRANSFORMS", "ARMATURE")
                for target, name in constraint_targets(constraint)
                if target == armature_object and name
            ]
            at = armature_object.pose.bones.get(copied[0]) if copied else at.parent
        if at is not None and at.name in role_of:
            found[bone.name] = role_of[at.name]
    return found


def measure(
    armature_object: Object,
    action: Action,
    frames: Array,
    source: SegmentMotion,
    motion: CharacterMotion,
    character: Character,
    character_map: CharacterMap,
    properties: Sequence[Property],
    in_fk: Mapping[Property, Value],
    rides: bool = False,
) -> Part[Measured]:
    """Measure the motion that an Action, assigned or not, gives a character in scene frames (F,).

    One that `rides` on something that moves is measured as if that stood still. Feet are those of the meshes,
    where these show feet, else the soles fixed to the bones. `properties` are those that the Action keys,
    `in_fk` the switches' values with which limbs show FK; none where nothing can be switched.
    """
    bones = {role: str(character_map.bone(role)) for role in character_map.roles}
    feet = ShownFeet(armature_object, character, character_map)
    still = motion.to_world if rides else None
    scene = next(iter(armature_object.users_scene), bpy.context.scene)

    def poses(switched: Mapping[Property, Value], feet: ShownFeet | None) -> Part[dict[str, Array]]:
        """(F, 4, 4) by role the pose of its first bone in the world [m], as shown; feet are read."""
        found: list[Array] = []

        def look() -> None:
            moving = object_space(armature_object)
            found.append(shown_poses(armature_object, bones.values(), still or moving))
            if feet is not None:
                feet.read(lambda points: (still or moving).to_world(moving.from_world(points)))

        @contextmanager
        def meanwhile() -> Iterator[None]:
            with posing(armature_object, properties, action), _switched(armature_object, action, switched):
                yield

        yield from each_frame(scene, frames, meanwhile, look)
        paths = np.array(found)  # (F, roles, 4, 4)
        return {role: paths[:, number] for number, role in enumerate(bones)}

    shown = yield from scaled(poses({}, feet), 0.0, 0.5 if in_fk else 1.0)
    soles = {}
    for role, points in motion.soles.items():  # at rest in the armature's space
        rest = character.bone(bones[role]).rest
        local = character.scale * (points - rest[:3, 3]) @ rest[:3, :3]
        soles[role] = shown[role][:, None, :3, 3] + local @ np.swapaxes(shown[role][:, :3, :3], -1, -2)
    meshes = {role: np.array(found) for role, found in feet.places.items()}
    # Toes of a foot that a mesh shows are in the mesh, too.
    soles = {role: points for role, points in soles.items() if f"foot.{role[-1]}" not in meshes} | meshes
    places = {role: pose[:, :3, 3] for role, pose in shown.items()}
    found = measured(source.start, motion, places, soles)
    if not in_fk:
        return found
    switched = yield from scaled(poses(in_fk, None), 0.5, 1.0)
    ends = [JOINTS[limb][2] for limb in LIMBS if limb in character_map.ik]
    other = {role: pose[:, :3, 3] for role, pose in switched.items()}
    return replace(found, quality=replace(found.quality, ik_fk_mm=farthest_mm(places, other, ends)))


class ShownFeet:
    """Vertices of a character's feet as shown, frame by frame: those of the hull, of which one is lowest."""

    def __init__(self, armature_object: Object, character: Character, character_map: CharacterMap) -> None:
        """The feet at rest; none of a side whose mesh shows no foot."""
        sides = {role[-1] for role in mesh_soles(armature_object, character, character_map)}
        self._feet = []
        for foot in foot_vertices(armature_object, character, character_map):
            rows = {role: rows for role, rows in foot.rows.items() if role[-1] in sides}
            if rows:
                self._feet.append(replace(foot, rows=rows))
        self._leading = leading_roles(armature_object, character_map)
        self._rows: dict[int, dict[str, IndexArray]] = {}
        self.places: dict[str, list[Array]] = {}  # (N, 3) by role in each frame that was read, in the world

    def read(self, carried: Callable[[Array], Array]) -> None:
        """Read them in the scene's current frame, points in the world [m] carried elsewhere."""
        places: dict[str, list[Array]] = {}
        for number, foot in enumerate(self._feet):
            shown = evaluated(foot.mesh_object)
            flat = np.empty(3 * len(shown.data.vertices), dtype=np.float32)
            shown.data.vertices.foreach_get("co", flat)
            points = flat.reshape(-1, 3).astype(np.float64)
            if number not in self._rows:
                self._rows[number] = self._chosen(foot, shown.data, points)
            matrix = np.array(shown.matrix_world, dtype=np.float64)
            for role, rows in self._rows[number].items():
                world = points[rows] @ matrix[:3, :3].T + matrix[:3, 3]
                places.setdefault(role, []).append(carried(world))
        for role, found in places.items():
            self.places.setdefault(role, []).append(np.concatenate(found))

    def _chosen(self, foot: FootVertices, mesh: Mesh, points: Array) -> dict[str, IndexArray]:
        """The rows of the hulls of an evaluated mesh, which may have been subdivided or mirrored."""
        rows = dict(foot.rows)
        if len(mesh.vertices) != len(foot.mesh_object.data.vertices):
            every, sides = np.arange(len(mesh.vertices)), {role[-1] for role in rows}
            found = foot_rows(foot.mesh_object, mesh, every, self._leading)
            rows = {role: those for role, those in found.items() if role[-1] in sides}
            if not foot.mesh_object.vertex_groups:
                rows = {next(iter(foot.rows)): every}
        return {role: those[hull_rows(points[those])] for role, those in rows.items()}


def hull_rows(points: Array) -> IndexArray:
    """Indices of the points (N, 3) on their convex hull; all where they span no volume."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        return np.asarray(ConvexHull(points).vertices, dtype=np.intp)
    except (QhullError, ValueError):
        return np.arange(len(points))


@contextmanager
def _switched(armature_object: Object, action: Action, values: Mapping[Property, Value]) -> Iterator[None]:
    paths = {property_path(bone, name): float(value) for (bone, name), value in values.items()}
    curves = curves_of(action, armature_object)
    keyed = [(path, curve.keyframe_points) for (path, _), curve in curves.items() if path in paths]
    keys = [(key, path) for path, points in keyed for key in points]
    before = [key.co[1] for key, _ in keys]
    for key, path in keys:
        key.co[1] = paths[path]
    try:
        yield
    finally:
        for (key, _), value in zip(keys, before, strict=True):
            key.co[1] = value
