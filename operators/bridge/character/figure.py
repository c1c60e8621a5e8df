"""A character's shape in the current frame, for pictures: its meshes, or its bones where it has none."""

from collections.abc import Iterable

import bpy
import numpy as np

from ....core.arrays import Array, Image
from ....core.numerics.vectors import across
from ....core.report.canvas import LEFT, RIGHT, Color
from ....core.report.character_sheet import character_sheet
from ....core.report.mannequin import SKIN, CharacterFigure
from ....core.report.overlay_sheet import evenly_spaced_frames
from ....core.report.pictures import footage_frames
from ....core.retarget.figure_lines import FigureLine, figure_lines
from ....core.retarget.maps.character_map import CharacterMap
from ..camera_placement import read_camera
from ..footage import Footage
from ..object_space import evaluated
from ..scene_frames import at_scene_frame
from .import_character import skins

MOST_TRIANGLES = 200_000  # with more, bones are drawn: a picture need not take half a minute
WAIST, THICKNESS = 0.15, 0.09  # an octahedral bone's widest place and its half-width there, in bone lengths
LEAST_M = 1e-6
NEW_GRAY, GAMMA = 0.8, 2.2  # color of a new material, which nobody has chosen; and the display's exponent
CORNERS = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))


def character_figure(armature_object: bpy.types.Object, lines: Iterable[FigureLine]) -> CharacterFigure:
    """The character as its scene shows it now."""
    meshes = [_mesh(one) for one in skins(armature_object)]
    if meshes and sum(len(mesh.triangles) for mesh in meshes) <= MOST_TRIANGLES:
        starts = np.cumsum([0, *(len(mesh.points) for mesh in meshes)])
        return CharacterFigure(
            np.concatenate([mesh.points for mesh in meshes]),
            np.concatenate([mesh.triangles + start for mesh, start in zip(meshes, starts[:-1], strict=True)]),
            np.concatenate([mesh.colors for mesh in meshes]),
        )
    return _bones(armature_object, lines)


def _mesh(mesh_object: bpy.types.Object) -> CharacterFigure:
    """An evaluated mesh in the colors that its materials have in the viewport."""
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


def _bones(armature_object: bpy.types.Object, lines: Iterable[FigureLine]) -> CharacterFigure:
    """Octahedra along the lines."""
    shown = evaluated(armature_object)
    world = np.array(shown.matrix_world, dtype=np.float64)
    poses = {bone.name: world @ np.array(bone.matrix, dtype=np.float64) for bone in shown.pose.bones}
    points: list[Array] = []
    triangles: list[tuple[int, int, int]] = []
    colors: list[tuple[int, int, int]] = []
    for line in lines:
        if line.start not in poses:
            continue
        matrix = poses[line.start]
        start = matrix[:3, 3]
        end = start + matrix[:3, 1] * shown.pose.bones[line.start].bone.length
        if line.end is not None and line.end in poses:
            end = poses[line.end][:3, 3]
        ring = _ring(start, end)
        if ring is None:
            continue
        first = 6 * len(points)
        points.append(np.array([start, end, *ring]))
        for corner in range(4):
            a, b = first + 2 + corner, first + 2 + (corner + 1) % 4
            triangles += [(first, b, a), (first + 1, a, b)]
        colors += [{"L": LEFT, "R": RIGHT}.get(line.side, SKIN)] * 8
    return CharacterFigure(
        np.concatenate(points) if points else np.zeros((0, 3)),
        np.array(triangles, dtype=np.intp).reshape(-1, 3),
        np.array(colors, dtype=np.float64).reshape(-1, 3),
    )


def _ring(start: Array, end: Array) -> list[Array] | None:
    """The four corners of an octahedron's waist; None where it has no length."""
    along = end - start
    size = float(np.linalg.norm(along))
    if size < LEAST_M:
        return None
    aside = across(along)
    other = np.cross(along / size, aside)
    return [start + WAIST * along + THICKNESS * size * (a * aside + b * other) for a, b in CORNERS]


# --- The picture of a character's motion


MOST_FRAMES = 6


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
    shown = evenly_spaced_frames(len(frames), MOST_FRAMES)
    lines = figure_lines(character_map)
    figures = {}
    with at_scene_frame(scene) as go_to:
        for index in shown:
            go_to(float(frames[index]))
            figures[index] = character_figure(armature_object, lines)
    images = footage_frames(footage.open(), shown)
    first = round(float(frames[0]))
    return character_sheet(armature_object.name, figures, camera, images, first, floor_m)
