"""A character's shape in the current frame, for pictures: its meshes, or its bones where it has none."""

import bpy
import numpy as np

from ....core.arrays import Array, Image
from ....core.numerics.vectors import across
from ....core.report.canvas import LEFT, RIGHT, Color
from ....core.report.mannequin import SKIN, CharacterFigure, character_sheet
from ....core.report.pictures import evenly_spaced_frames, footage_frames
from ....core.retarget.character import LIMBS, MIDDLE
from ....core.retarget.maps.character_map import CharacterMap
from ..camera_placement import read_camera
from ..footage import Footage
from ..object_space import evaluated
from ..scene_frames import at_scene_frame
from .import_character import skins

MOST_TRIANGLES = 200_000  # with more, bones are drawn: a picture need not take half a minute
WAIST, THICKNESS = 0.15, 0.09  # an octahedral bone's widest place and its half-width there, in bone lengths
NEW_GRAY, GAMMA = 0.8, 2.2  # color of a new material, which nobody has chosen; and the display's exponent


def character_figure(armature_object: bpy.types.Object, character_map: CharacterMap) -> CharacterFigure:
    """The character as its scene shows it now."""
    meshes = [_mesh(one) for one in skins(armature_object)]
    if meshes and sum(len(mesh.triangles) for mesh in meshes) <= MOST_TRIANGLES:
        starts = np.cumsum([0, *(len(mesh.points) for mesh in meshes)])
        return CharacterFigure(
            np.concatenate([mesh.points for mesh in meshes]),
            np.concatenate([mesh.triangles + start for mesh, start in zip(meshes, starts[:-1], strict=True)]),
            np.concatenate([mesh.colors for mesh in meshes]),
        )
    return _bones(armature_object, character_map)


def _mesh(mesh_object: bpy.types.Object) -> CharacterFigure:
    shown = evaluated(mesh_object)
    mesh = shown.to_mesh()
    try:
        mesh.calc_loop_triangles()
        points = np.empty(3 * len(mesh.vertices), dtype=np.float32)
        mesh.vertices.foreach_get("co", points)
        triangles = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
        mesh.loop_triangles.foreach_get("vertices", triangles)
        material = np.empty(len(mesh.loop_triangles), dtype=np.int32)
        mesh.loop_triangles.foreach_get("material_index", material)
    finally:
        shown.to_mesh_clear()
    matrix = np.array(shown.matrix_world, dtype=np.float64)
    colors = np.array([_color(slot.material) for slot in shown.material_slots] or [SKIN], dtype=np.float64)
    return CharacterFigure(
        points.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3],
        triangles.reshape(-1, 3).astype(np.intp),
        colors[np.clip(material, 0, len(colors) - 1)],
    )


def _color(material: bpy.types.Material | None) -> Color:
    """Blue, green, red of a material in the viewport; a new material's own gray is left to `SKIN`."""
    if material is None or all(abs(value - NEW_GRAY) < 1e-3 for value in material.diffuse_color[:3]):
        return SKIN
    red, green, blue = (
        round(255.0 * min(max(value, 0.0), 1.0) ** (1.0 / GAMMA)) for value in material.diffuse_color[:3]
    )
    return blue, green, red


def _bones(armature_object: bpy.types.Object, character_map: CharacterMap) -> CharacterFigure:
    shown = evaluated(armature_object)
    world = np.array(shown.matrix_world, dtype=np.float64)
    poses = {bone.name: world @ np.array(bone.matrix, dtype=np.float64) for bone in shown.pose.bones}
    points: list[Array] = []
    triangles: list[tuple[int, int, int]] = []
    colors: list[tuple[int, int, int]] = []
    chains = [(SKIN, [bone for role in MIDDLE for bone in character_map.bones(role)])]
    for limb, roles in LIMBS.items():
        bones = [bone for bone in map(character_map.bone, roles) if bone is not None]
        chains.append((LEFT if limb.endswith("L") else RIGHT, bones))
    for color, chain in chains:
        for bone, onward in zip(chain, [*chain[1:], None], strict=True):
            if bone not in poses:
                continue
            start, end = poses[bone][:3, 3], poses[bone] @ [0.0, shown.pose.bones[bone].bone.length, 0.0, 1.0]
            end = poses[onward][:3, 3] if onward in poses else end[:3]
            size = float(np.linalg.norm(end - start))
            if size < 1e-6:
                continue
            aside = across(end - start)
            other = np.cross((end - start) / size, aside)
            waist = start + WAIST * (end - start)
            out = THICKNESS * size * np.array([aside, other, -aside, -other])
            first = 6 * len(points)
            points.append(np.array([start, end, *(waist + out)]))
            for corner in range(4):
                a, b = first + 2 + corner, first + 2 + (corner + 1) % 4
                triangles += [(first, b, a), (first + 1, a, b)]
            colors += [color] * 8
    return CharacterFigure(
        np.concatenate(points) if points else np.zeros((0, 3)),
        np.array(triangles, dtype=np.intp).reshape(-1, 3),
        np.array(colors, dtype=np.float64).reshape(-1, 3),
    )


# --- The picture of a character's motion


def character_picture(
    scene: bpy.types.Scene,
    armature_object: bpy.types.Object,
    character_map: CharacterMap,
    frames: Array,
    floor_m: float,
) -> Image | None:
    """Draw a character that shows its motion in a scene with the footage; None where there is no footage.

    `frames` are the scene frames of the motion, the clip's frames in order; `floor_m` is the floor's height
    under the character in the world. The scene's frame is as before afterwards.

    Raises:
        InputError: The clip cannot be read.
    """
    if scene.active_clip is None or scene.camera is None:
        return None
    footage = Footage(scene, scene.active_clip, scene.camera)
    camera = read_camera(footage, frames)
    shown = evenly_spaced_frames(len(frames), 6)
    figures = {}
    with at_scene_frame(scene) as go_to:
        for index in shown:
            go_to(float(frames[index]))
            figures[index] = character_figure(armature_object, character_map)
    images = footage_frames(footage.open(), shown)
    first = round(float(frames[0]))
    return character_sheet(armature_object.name, figures, camera, images, first, floor_m)
