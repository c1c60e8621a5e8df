"""The character of the pictures: Rigify's basic human in a smooth body, with large hands and feet."""

from pathlib import Path

import bpy
import numpy as np
from keymark.core.arrays import Array
from keymark.operators.cli.blender_silence import blender_silence
from keymark.operators.cli.commands.demo import write_demo_character
from scipy.spatial import ConvexHull
from studio.performer import one_surface, skin_weights

RIG, BODY = "Human", "Human Body"
PREFIX = "DEF-"
RADII: dict[str, tuple[float, float, float]] = {
    "spine": (0.125, 0.115, 1.18),
    "spine.001": (0.112, 0.120, 1.18),
    "spine.002": (0.125, 0.140, 1.22),
    "spine.003": (0.140, 0.085, 1.30),
    "spine.004": (0.060, 0.058, 1.0),
    "spine.005": (0.058, 0.060, 1.0),
    "spine.006": (0.085, 0.138, 1.0),
    "shoulder": (0.065, 0.070, 1.0),
    "upper_arm": (0.068, 0.055, 1.0),
    "upper_arm.001": (0.055, 0.048, 1.0),
    "forearm": (0.050, 0.046, 1.0),
    "forearm.001": (0.052, 0.058, 1.0),
    "hand": (0.060, 0.068, 1.0),
    "thigh": (0.098, 0.086, 1.0),
    "thigh.001": (0.086, 0.068, 1.0),
    "shin": (0.068, 0.062, 1.0),
    "shin.001": (0.068, 0.078, 1.0),
    "foot": (0.072, 0.062, 1.05),
    "toe": (0.062, 0.052, 1.15),
}
"""Radii of the body at the head and the tail of a bone [m], and how much wider than deep it is."""
SHORTENED = {"spine.006": 0.5}
"""Shares of a bone's length that its part reaches, where not all: the head is round."""
COLORS = {"suit": (222, 104, 46), "pale": (232, 218, 194), "belt": (62, 44, 40), "visor": (30, 32, 42)}
"""sRGB."""
PALE = ("spine.004", "spine.005", "spine.006", "hand", "forearm.001", "foot", "toe", "shin.001")
VISOR, VISOR_M = (0.0, -0.14, 1.885), (0.092, 0.085, 0.05)
"""Middle and half-widths of the visor at rest [m]."""
BELT_M, BELT_WIDTH_M = 1.10, 0.03
"""Its height, and half its width."""
VOXEL_M = 0.014
BALL_POINTS = 400


def write_figure(file: Path) -> None:
    """Generate the rig, and dress it in the body, into a .blend."""
    write_demo_character(file)
    with blender_silence(debug=False):
        bpy.ops.wm.open_mainfile(filepath=str(file))
    rig = bpy.data.objects[RIG]
    bpy.data.objects.remove(bpy.data.objects[BODY])
    bones = {bone.name: bone for bone in rig.data.bones if bone.use_deform and _radii(bone.name)}
    hulls = {name: _hull(bone) for name, bone in bones.items()}
    body = one_surface(list(hulls.values()), VOXEL_M)
    body.name = body.data.name = BODY
    places = _places(body.data)
    weights = skin_weights(body.data, places, [hull[0] for hull in hulls.values()])
    for column, name in enumerate(hulls):
        group = body.vertex_groups.new(name=name)
        for vertex in np.flatnonzero(weights[:, column] > 1e-3).tolist():
            group.add([vertex], float(weights[vertex, column]), "REPLACE")
    _paint(body, places, np.array(list(hulls))[weights.argmax(axis=1)])
    body.parent = rig
    body.modifiers.new("Armature", "ARMATURE").object = rig
    with blender_silence(debug=False):
        bpy.ops.wm.save_as_mainfile(filepath=str(file), compress=True)


def _radii(bone: str) -> tuple[float, float, float] | None:
    """Radii of a deform bone's part of the body; None where it has none of its own."""
    return RADII.get(_plain(bone))


def _plain(bone: str) -> str:
    """A deform bone's name without its side."""
    return bone.removeprefix(PREFIX).replace(".L", "").replace(".R", "")


def _hull(bone: bpy.types.Bone) -> tuple[Array, list[list[int]]]:
    """Vertices (N, 3) and triangles of a limb that tapers from the bone's head to its tail."""
    radii = _radii(bone.name)
    assert radii is not None
    ball = _ball() * [radii[2], 1.0, 1.0]
    start, end = np.array(bone.head_local), np.array(bone.tail_local)
    ends = (start, start + SHORTENED.get(_plain(bone.name), 1.0) * (end - start))
    places = np.concatenate([end + radius * ball for end, radius in zip(ends, radii[:2], strict=True)])
    # Soles are flat: nothing of the body is below the ground.
    places[:, 2] = np.maximum(places[:, 2], 0.0)
    hull = ConvexHull(places)
    place_of = {old: new for new, old in enumerate(hull.vertices.tolist())}
    return places[hull.vertices], [[place_of[corner] for corner in face] for face in hull.simplices.tolist()]


def _ball() -> Array:
    """(N, 3) points spread evenly over the unit sphere."""
    number = np.arange(BALL_POINTS) + 0.5
    height, turn = 1.0 - 2.0 * number / BALL_POINTS, np.pi * (1.0 + 5.0**0.5) * number
    across = np.sqrt(1.0 - height**2)
    return np.stack([across * np.cos(turn), across * np.sin(turn), height], axis=-1)


def _places(mesh: bpy.types.Mesh) -> Array:
    places = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", places)
    return places.reshape(-1, 3).astype(np.float64)


def _paint(body: bpy.types.Object, places: Array, holder: Array) -> None:
    """Give every face a color by the bone that holds it."""
    for name, color in COLORS.items():
        material = bpy.data.materials.new(f"Figure {name}")
        material.use_nodes = True
        linear = (*((np.array(color) / 255.0) ** 2.2).tolist(), 1.0)
        material.diffuse_color = linear
        shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
        shader.inputs["Base Color"].default_value = linear
        shader.inputs["Roughness"].default_value = 0.25 if name == "visor" else 0.6
        body.data.materials.append(material)
    order = list(COLORS)
    worn = np.full(len(places), order.index("suit"))
    plain = np.array([_plain(name) for name in holder])
    worn[np.isin(plain, PALE)] = order.index("pale")
    worn[(plain == "spine") & (np.abs(places[:, 2] - BELT_M) < BELT_WIDTH_M)] = order.index("belt")
    away = np.linalg.norm((places - np.array(VISOR)) / np.array(VISOR_M), axis=1)
    worn[(plain == "spine.006") & (away < 1.0)] = order.index("visor")
    for face in body.data.polygons:
        face.material_index = int(np.sort(worn[list(face.vertices)])[1])
