"""A character's shape in the current frame, for pictures: its meshes, or its bones where it has none."""

from collections.abc import Iterator

import numpy as np
from bpy.types import Material, Object, Scene

from ....core.arrays import Array, Image
from ....core.numerics.vectors import across
from ....core.report.canvas import LEFT, RIGHT, Color
from ....core.report.mannequin import SKIN, CharacterFigure, character_sheet
from ....core.report.pictures import evenly_spaced_frames, footage_frames
from ....core.retarget.character import LIMBS, MIDDLE
from ....core.retarget.maps.character_map import CharacterMap
from ..actor_bones import evaluated
from ..footage import Footage, read_camera
from ..scene_frames import at_scene_frame
from .import_character import skins

MOST_TRIANGLES = 200_000  # with more, bones are drawn: a picture need not take half a minute
WAIST, THICKNESS = 0.15, 0.09  # an octahedral bone's widest place and its half-width there, in bone lengths
CORNERS = [(2, 3), (3, 4), (4, 5), (5, 2)]  # of the waist; the ends come before them
OCTAHEDRON = np.array([side for a, b in CORNERS for side in ((0, b, a), (1, a, b))], dtype=np.intp)
NEW_GRAY = 0.8  # color of a new material, which nobody has chosen


def character_figure(armature_object: Object, character_map: CharacterMap) -> CharacterFigure:
    """The character as its scene shows it now."""
    figures = [_mesh(one) for one in skins(armature_object)]
    if not 0 < sum(len(figure.triangles) for figure in figures) <= MOST_TRIANGLES:
        figures = list(_bones(armature_object, character_map))
    figures = figures or [CharacterFigure(np.zeros((0, 3)), OCTAHEDRON[:0], np.zeros((0, 3)))]
    starts = np.cumsum([0, *(len(figure.points) for figure in figures[:-1])])
    return CharacterFigure(
        np.concatenate([figure.points for figure in figures]),
        np.concatenate([figure.triangles + start for figure, start in zip(figures, starts, strict=True)]),
        np.concatenate([figure.colors for figure in figures]),
    )


def _mesh(mesh_object: Object) -> CharacterFigure:
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


def _color(material: Material | None) -> Color:
    """Blue, green, red of a material in the viewport; a new material's own gray is left to `SKIN`."""
    if material is None or all(abs(value - NEW_GRAY) < 1e-3 for value in material.diffuse_color[:3]):
        return SKIN
    red, green, blue = (round(255.0 * min(max(x, 0.0), 1.0) ** (1 / 2.2)) for x in material.diffuse_color[:3])
    return blue, green, red


def _bones(armature_object: Object, character_map: CharacterMap) -> Iterator[CharacterFigure]:
    """An octahedron for each bone that plays a role, to the next one of its limb."""
    shown = evaluated(armature_object)
    world = np.array(shown.matrix_world, dtype=np.float64)
    poses = {bone.name: world @ np.array(bone.matrix, dtype=np.float64) for bone in shown.pose.bones}
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
            if size >= 1e-6:
                aside = across(end - start)
                other = np.cross((end - start) / size, aside)
                out = THICKNESS * size * np.array([aside, other, -aside, -other])
                points = np.array([start, end, *(start + WAIST * (end - start) + out)])
                yield CharacterFigure(points, OCTAHEDRON, np.tile(np.array(color, dtype=np.float64), (8, 1)))


def character_picture(
    scene: Scene, armature_object: Object, character_map: CharacterMap, frames: Array, floor_m: float
) -> Image | None:
    """Draw a character at scene frames of its motion over the footage and a floor; None without footage."""
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
