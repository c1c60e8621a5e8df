"""Measure a character's motion as Blender shows it, frame by frame, with the limbs in IK and in FK."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace

import bpy
import numpy as np
from bpy.types import Action, Mesh, Object

from ....core.arrays import Array, IndexArray
from ....core.body.kinematics import SegmentMotion
from ....core.progress import Part, scaled
from ....core.retarget.character import JOINTS, LIMBS, Character
from ....core.retarget.character_motion import CharacterMotion
from ....core.retarget.maps.character_map import CharacterMap
from ....core.retarget.quality import Measured, farthest_mm, measured
from ..actions import curves_of
from ..motions.read_poses import shown_poses
from ..object_space import evaluated, object_space
from ..scene_frames import each_frame
from .controls import Property, Value, posing, property_path
from .mesh_soles import FootVertices, foot_rows, foot_vertices, leading_roles, mesh_soles


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
    """Let the keys of custom properties in an Action have other values meanwhile."""
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
