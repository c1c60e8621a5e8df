"""A dark stage on which a result's figure is rendered, frame by frame."""

from collections.abc import Callable, Sequence
from pathlib import Path

import bpy
import numpy as np
from keymark.core.arrays import Image
from keymark.core.camera.camera import Camera
from keymark.operators.cli.blender_silence import blender_silence
from mathutils import Vector
from studio.filming import place_camera, prepare_cycles, render

SEED = 1
FLOOR = (0.030, 0.033, 0.041)
GRID = (0.085, 0.092, 0.11)
"""Colors of the floor and of the lines on it, linear."""
GRID_M, LINE_M, REACH_M = 0.5, 0.012, 6.0
SKY = (0.003, 0.0033, 0.004)
"""Light of the background, linear."""
LAMPS = (
    ((-2.4, -3.4, 3.6), 2.6, 270.0, (1.0, 0.97, 0.93)),
    ((3.4, -1.6, 2.2), 2.2, 130.0, (0.80, 0.89, 1.0)),
    ((0.8, 3.0, 3.2), 1.8, 300.0, (0.95, 0.97, 1.0)),
)
"""Place [m], edge [m], power [W] and color: from the front, from a side, and from behind."""
AIM = Vector((0.3, 0.0, 1.0))


def render_result(
    blend: Path, frames: Sequence[int], camera_at: Callable[[int], Camera], samples: int
) -> list[Image]:
    """Render what a result's scene shows in some of its frames, on the stage.

    Args:
        blend: The result.
        frames: Frames of the clip, from 0.
        camera_at: The camera of each of these.
        samples: Light paths per pixel.
    """
    images = []
    with blender_silence(debug=False):
        bpy.ops.wm.open_mainfile(filepath=str(blend))
        scene = next(scene for scene in bpy.data.scenes if scene.camera is not None)
        bpy.context.window.scene = scene
        _furnish(scene)
        prepare_cycles(SEED)
        for frame in frames:
            scene.frame_set(scene.frame_start + frame)
            place_camera(camera_at(frame))
            images.append(np.asarray(np.rint(255.0 * render(samples)), dtype=np.uint8))
    return images


def _furnish(scene: bpy.types.Scene) -> None:
    """Floor, grid, lamps and background."""
    far = 5.0 * REACH_M
    _plates(scene, "Floor", [((-far, -far), (far, far))], -0.004, FLOOR)
    steps = np.arange(-REACH_M, REACH_M + GRID_M, GRID_M).tolist()
    lines = [((-REACH_M, step - 0.5 * LINE_M), (REACH_M, step + 0.5 * LINE_M)) for step in steps]
    lines += [((step - 0.5 * LINE_M, -REACH_M), (step + 0.5 * LINE_M, REACH_M)) for step in steps]
    _plates(scene, "Grid", lines, -0.002, GRID)
    for place, size, power, color in LAMPS:
        light = bpy.data.lights.new("Lamp", "AREA")
        light.size, light.energy, light.color = size, power, color
        thing = bpy.data.objects.new("Lamp", light)
        thing.location = place
        thing.rotation_euler = (AIM - Vector(place)).to_track_quat("-Z", "Y").to_euler()
        scene.collection.objects.link(thing)
    world = bpy.data.worlds.new("Stage")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (*SKY, 1.0)
    scene.world = world


def _plates(
    scene: bpy.types.Scene,
    name: str,
    corners: Sequence[tuple[tuple[float, float], tuple[float, float]]],
    height: float,
    color: tuple[float, float, float],
) -> None:
    """Level rectangles, by two opposite corners [m]."""
    places, faces = [], []
    for (left, front), (right, back) in corners:
        faces.append(tuple(range(len(places), len(places) + 4)))
        places += [(x, y, height) for x, y in ((left, front), (right, front), (right, back), (left, back))]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(places, [], faces)
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    shader.inputs["Roughness"].default_value = 0.7
    mesh.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new(name, mesh))
