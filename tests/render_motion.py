"""Renders a motion.blend as a camera sees it, lit evenly. Runs in a Blender and in a Python that has `bpy`.

Usage: blender -b --factory-startup --python-exit-code 1 --python render_motion.py -- BLEND CAMERA OUTPUT STEP
       python render_motion.py BLEND CAMERA OUTPUT STEP

CAMERA is a JSON file in the form of take.json's camera, or `scene` for the scene's own; every STEP-th frame
becomes a PNG in OUTPUT. Cycles on the processor is the engine that every Blender has without a graphics card.
"""

import json
import sys
from pathlib import Path

import bpy
from mathutils import Matrix

SAMPLES = 6
LIGHT_SRGB_GRAY = 0.86
"""An evenly gray world lights everything alike and keeps the markers' hues."""


def use_camera(scene: bpy.types.Scene, fields: dict) -> None:
    """Look through a camera described as in take.json."""
    data = bpy.data.cameras.new("Given camera")
    data.sensor_fit, data.sensor_width, data.lens = "HORIZONTAL", fields["sensor_width_mm"], fields["lens_mm"]
    data.shift_x, data.shift_y = fields["shift_x"], fields["shift_y"]
    camera = bpy.data.objects.new("Given camera", data)
    camera.matrix_world = Matrix(fields["matrix_world"])
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y = fields["resolution"]


def light_evenly(scene: bpy.types.Scene) -> None:
    """Light from all sides and path tracing with few samples."""
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.seed = "CPU", SAMPLES, 1
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 1
    world = bpy.data.worlds.new("Even light")
    world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (LIGHT_SRGB_GRAY, LIGHT_SRGB_GRAY, LIGHT_SRGB_GRAY, 1.0)
    scene.world = world
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"


def main(arguments: list[str]) -> None:
    """Open the file and render."""
    blend, camera, output, step = arguments
    bpy.ops.wm.open_mainfile(filepath=blend)
    scene = next(scene for scene in bpy.data.scenes if scene.camera is not None)
    if bpy.context.window is not None:
        bpy.context.window.scene = scene
    if camera != "scene":
        use_camera(scene, json.loads(Path(camera).read_text(encoding="utf-8")))
    light_evenly(scene)
    for frame in range(scene.frame_start, scene.frame_end + 1, int(step)):
        scene.frame_set(frame)
        scene.render.filepath = str(Path(output) / f"{frame:04d}.png")
        bpy.ops.render.render(write_still=True, scene=scene.name)


if __name__ == "__main__":
    after = sys.argv.index("--") + 1 if "--" in sys.argv else 1
    main(sys.argv[after:])
