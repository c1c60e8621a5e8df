"""Measure a character's motion as Blender shows it, frame by frame, with the limbs in IK and in FK."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace

import bpy
import numpy as np

from ....core.arrays import Array, IndexArray
from ....core.body.kinematics import SegmentMotion
from ....core.progress import Part, scaled
from ....core.retarget.character import JOINTS, LIMBS, Character, Similarity
from ....core.retarget.character_motion import CharacterMotion
from ....core.retarget.controls.control_spaces import unscaled
from ....core.retarget.maps.character_map import CharacterMap
from ....core.retarget.quality import Measured, farthest_mm, measured
from ..actions import existing_channelbag
from ..object_space import evaluated, object_space
from ..scene_frames import at_scene_frame
from .controls import Property, Value, posing, property_path
from .mesh_soles import FootVertices, foot_rows, foot_vertices, leading_roles, mesh_soles

FRAMES_A_YIELD = 10  # frames shown between two reports of progress; in between the scene is as it was


def measure(
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
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
    feet = ShownFeet.of(armature_object, character, character_map)
    stands = motion.to_world
    still = stands if rides else None
    showing = _show(armature_object, action, frames, bones, properties, {}, feet, still)
    poses = yield from scaled(showing, 0.0, 0.5 if in_fk else 1.0)
    shown = {role: poses[role][:, :3, 3] for role in bones}
    soles = {}
    for role, points in motion.soles.items():  # at rest in the armature's space
        rest, shown_poses = character.bone(bones[role]).rest, poses[role]
        local = character.scale * (points - rest[:3, 3]) @ rest[:3, :3]
        soles[role] = shown_poses[:, None, :3, 3] + local @ np.swapaxes(shown_poses[:, :3, :3], -1, -2)
    meshes = feet.places()
    # Toes of a foot that a mesh shows are in the mesh, too.
    soles = {role: points for role, points in soles.items() if f"foot.{role[-1]}" not in meshes} | meshes
    found = measured(source.start, motion, shown, soles)
    if not in_fk:
        return found
    showing = _show(armature_object, action, frames, bones, properties, in_fk, None, still)
    switched = yield from scaled(showing, 0.5, 1.0)
    ends = [JOINTS[limb][2] for limb in LIMBS if limb in character_map.ik]
    other = {role: switched[role][:, :3, 3] for role in bones}
    return replace(found, quality=replace(found.quality, ik_fk_mm=farthest_mm(shown, other, ends)))


class ShownFeet:
    """Vertices of feet and toes, read frame by frame from the meshes as Blender shows them.

    Of each role's vertices those of the convex hull are kept: among them is the lowest in any posture.
    """

    def __init__(self, feet: Sequence[FootVertices], leading: Mapping[str, str]) -> None:
        """Feet at rest, and by bone the role that it follows."""
        self._feet, self._leading = feet, leading
        self._rows: dict[int, dict[str, IndexArray]] = {}
        self._found: dict[str, list[Array]] = {}

    @classmethod
    def of(
        cls, armature_object: bpy.types.Object, character: Character, character_map: CharacterMap
    ) -> "ShownFeet":
        """The feet of a character; none of a side whose mesh shows no foot."""
        shown = {role[-1] for role in mesh_soles(armature_object, character, character_map)}
        feet = [
            replace(foot, rows={role: rows for role, rows in foot.rows.items() if role[-1] in shown})
            for foot in foot_vertices(armature_object, character, character_map)
        ]
        return cls([foot for foot in feet if foot.rows], leading_roles(armature_object, character_map))

    def read(self, carried: Array) -> None:
        """Read them in the scene's current frame, moved by a matrix (4, 4)."""
        places: dict[str, list[Array]] = {}
        for number, foot in enumerate(self._feet):
            shown = evaluated(foot.mesh_object)
            flat = np.empty(3 * len(shown.data.vertices), dtype=np.float32)
            shown.data.vertices.foreach_get("co", flat)
            points = flat.reshape(-1, 3).astype(np.float64)
            if number not in self._rows:
                self._rows[number] = self._chosen(foot, shown.data, points)
            matrix = carried @ np.array(shown.matrix_world, dtype=np.float64)
            for role, rows in self._rows[number].items():
                places.setdefault(role, []).append(points[rows] @ matrix[:3, :3].T + matrix[:3, 3])
        for role, found in places.items():
            self._found.setdefault(role, []).append(np.concatenate(found))

    def places(self) -> dict[str, Array]:
        """(F, N, 3) by role of foot and toe the vertices in the frames that were read, in the world [m]."""
        return {role: np.array(found) for role, found in self._found.items()}

    def _chosen(self, foot: FootVertices, mesh: bpy.types.Mesh, points: Array) -> dict[str, IndexArray]:
        rows = foot.rows
        if len(mesh.vertices) != len(foot.mesh_object.data.vertices):  # subdivided, mirrored ...
            every = np.arange(len(mesh.vertices))
            groups = foot.mesh_object.vertex_groups
            sides = {role[-1] for role in rows}
            rows = (
                {
                    role: those
                    for role, those in foot_rows(foot.mesh_object, mesh, every, self._leading).items()
                    if role[-1] in sides
                }
                if groups
                else {next(iter(rows)): every}
            )
        return {role: those[hull_rows(points[those])] for role, those in rows.items()}


def hull_rows(points: Array) -> IndexArray:
    """Indices of the points (N, 3) on their convex hull; all where they span no volume."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        return np.asarray(ConvexHull(points).vertices, dtype=np.intp)
    except (QhullError, ValueError):
        return np.arange(len(points))


def _show(
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    frames: Array,
    bones: Mapping[str, str],
    properties: Sequence[Property],
    switched: Mapping[Property, Value],
    feet: ShownFeet | None = None,
    still: Similarity | None = None,
) -> Part[dict[str, Array]]:
    """(F, 4, 4) by role the pose of its first bone in the world [m], as Blender shows it; feet are read."""
    scene = next(iter(armature_object.users_scene), bpy.context.scene)
    found: list[Array] = []
    for first in range(0, len(frames), FRAMES_A_YIELD):
        with (
            at_scene_frame(scene) as go_to,
            posing(armature_object, properties, action),
            _switched(armature_object, action, switched),
        ):
            for frame in frames[first : first + FRAMES_A_YIELD]:
                go_to(frame)
                moving, shown = object_space(armature_object), evaluated(armature_object).pose.bones
                space = moving if still is None else still
                matrices = np.array([shown[name].matrix for name in bones.values()], dtype=np.float64)
                matrices[:, :3, :3] = space.rotation @ unscaled(matrices[:, :3, :3])
                matrices[:, :3, 3] = space.to_world(matrices[:, :3, 3])
                found.append(matrices)
                if feet is not None:
                    feet.read(space.matrix @ np.linalg.inv(moving.matrix))
        yield min(first + FRAMES_A_YIELD, len(frames)) / len(frames)
    paths = np.array(found)  # (F, roles, 4, 4)
    return {role: paths[:, number] for number, role in enumerate(bones)}


@contextmanager
def _switched(
    armature_object: bpy.types.Object, action: bpy.types.Action, values: Mapping[Property, Value]
) -> Iterator[None]:
    """Let the keys of custom properties in an Action have other values meanwhile."""
    channelbag = existing_channelbag(action, armature_object)
    curves = [] if channelbag is None else list(channelbag.fcurves)
    paths = {property_path(bone, name): float(value) for (bone, name), value in values.items()}
    switches = [curve for curve in curves if curve.data_path in paths]
    before = [[key.co[1] for key in curve.keyframe_points] for curve in switches]
    for curve in switches:
        for key in curve.keyframe_points:
            key.co[1] = paths[curve.data_path]
    try:
        yield
    finally:
        for curve, values_before in zip(switches, before, strict=True):
            for key, value in zip(curve.keyframe_points, values_before, strict=True):
                key.co[1] = value
