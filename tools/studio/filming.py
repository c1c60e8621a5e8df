"""Filming: cameras, a shutter open part of the frame, sensor noise, H.264, and the markers' true masks."""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import bpy
import cv2
import numpy as np
from keymark.core.arrays import Array, BoolArray, Image
from keymark.core.camera.camera import Camera
from mathutils import Matrix

from .look import MARKERS
from .performance import Performance
from .performer import Performer
from .room import BuiltRoom

ROOM_SAMPLES = 24
MARGIN_PX = 16
SIXTEEN_BITS = 65535.0
GAMMA = 2.2
"""Gamma of display values, in place of the sRGB curve: exposures add up in linear light."""


def place_camera(camera: Camera) -> None:
    """Set the scene's camera to the described one."""
    scene = bpy.context.scene
    data = bpy.data.cameras.new("Camera")
    data.lens, data.sensor_width, data.sensor_fit = camera.lens_mm, camera.sensor_width_mm, "HORIZONTAL"
    thing = bpy.data.objects.new("Camera", data)
    thing.matrix_world = Matrix(camera.matrix_world.tolist())
    scene.collection.objects.link(thing)
    scene.camera = thing
    scene.render.resolution_x, scene.render.resolution_y = camera.resolution
    scene.render.resolution_percentage = 100


def prepare_cycles(seed: int, threads: int | None = None) -> None:
    """Set up path tracing on the processor, the same on every machine, with the given threads or all."""
    scene = bpy.context.scene
    if threads is not None:
        scene.render.threads_mode, scene.render.threads = "FIXED", threads
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.seed = seed
    scene.cycles.use_adaptive_sampling = scene.cycles.use_light_tree = False
    scene.cycles.max_bounces, scene.cycles.diffuse_bounces = 2, 1
    scene.cycles.use_denoising = True
    scene.cycles.denoiser = "OPENIMAGEDENOISE"
    scene.cycles.denoising_quality, scene.cycles.denoising_prefilter = "FAST", "NONE"
    scene.render.use_persistent_data = True
    scene.view_settings.view_transform = "Standard"
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.image_settings.color_depth = "16"
    scene.render.image_settings.compression = 0


def render(samples: int) -> Array:
    """Render the scene: (height, width, 3) blue, green, red from 0 to 1, display values."""
    bpy.context.scene.cycles.samples = samples
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "image.png"
        bpy.context.scene.render.filepath = str(path)
        bpy.ops.render.render(write_still=True)
        return np.asarray(cv2.imread(str(path), cv2.IMREAD_UNCHANGED)[..., :3] / SIXTEEN_BITS)


def film(
    performer: Performer,
    performance: Performance,
    room: BuiltRoom,
    camera: Camera,
    moments: int,
    shutter_frames: float,
    samples: int,
    shadow_per_height: Array,
) -> list[Array]:
    """All frames of the performance from one camera, without sensor noise.

    The empty room is rendered once; each frame renders only the neighborhood of the performer, the shadow and
    the moving things, and the seam is blended.

    Args:
        performer: The mesh that is filmed.
        performance: The motion.
        room: The surroundings.
        camera: Becomes the scene's camera.
        moments: Renders while the shutter is open; the frame is their mean.
        shutter_frames: How long the shutter is open.
        samples: Light paths per pixel of each render.
        shadow_per_height: (3,) offset of a point's shadow on the floor, per meter of its height.
    """
    place_camera(camera)
    for thing in (performer.thing, *room.moving):
        thing.hide_render = True
    empty = render(ROOM_SAMPLES)
    for thing in (performer.thing, *room.moving):
        thing.hide_render = False
    offsets = shutter_frames * ((np.arange(moments) + 0.5) / moments - 0.5)
    images = []
    for frame in range(performance.frame_count):
        indices = performance.at(frame + offsets)
        performer.bend(performance, int(indices[moments // 2]))
        places = np.concatenate([performer.world_places(), room.moving_places(frame)])
        shadow = places * [1.0, 1.0, 0.0] + places[:, 2:] * shadow_per_height
        left, top, right, bottom = _neighborhood(np.concatenate([places, shadow]), camera)
        with _border(camera, left, top, right, bottom):
            light = np.zeros((bottom - top, right - left, 3))
            for index, offset in zip(indices, offsets, strict=True):
                performer.bend(performance, int(index))
                room.move(frame + offset)
                light += render(samples) ** GAMMA / moments
        share = _seam(light.shape[:2], (left, top, right, bottom), camera.resolution)[..., None]
        image = empty.copy()
        image[top:bottom, left:right] *= 1.0 - share
        image[top:bottom, left:right] += share * light ** (1.0 / GAMMA)
        images.append(image)
    return images


def _neighborhood(places: Array, camera: Camera) -> tuple[int, int, int, int]:
    """Left, top, right and bottom pixel bounds of points (N, 3) before the camera, with a margin."""
    pixels, depth = camera.project(places)
    pixels = pixels[depth > 0.0]
    width, height = camera.resolution
    first = np.clip(np.floor(pixels.min(axis=0)).astype(int) - MARGIN_PX, 0, [width - 1, height - 1])
    last = np.clip(np.ceil(pixels.max(axis=0)).astype(int) + MARGIN_PX, first + 1, [width, height])
    return int(first[0]), int(first[1]), int(last[0]), int(last[1])


@contextmanager
def _border(camera: Camera, left: int, top: int, right: int, bottom: int) -> Iterator[None]:
    """Context manager that restricts rendering to these pixels."""
    render_settings = bpy.context.scene.render
    width, height = camera.resolution
    inside = 0.01  # share of a pixel, against rounding to a neighbor
    render_settings.use_border = render_settings.use_crop_to_border = True
    render_settings.border_min_x, render_settings.border_max_x = (
        (left + inside) / width,
        (right + inside) / width,
    )
    render_settings.border_min_y = (height - bottom + inside) / height
    render_settings.border_max_y = (height - top + inside) / height
    try:
        yield
    finally:
        render_settings.use_border = render_settings.use_crop_to_border = False


def _seam(shape: tuple[int, int], bounds: tuple[int, int, int, int], resolution: tuple[int, int]) -> Array:
    """Weight of the new render in each pixel: rising from its edges, except at the image's own edges."""
    rows, columns = shape
    left, top, right, bottom = bounds
    x, y = np.arange(columns) + 1.0, np.arange(rows) + 1.0
    ramps = [
        x if left > 0 else np.full(columns, np.inf),
        x[::-1] if right < resolution[0] else np.full(columns, np.inf),
        y if top > 0 else np.full(rows, np.inf),
        y[::-1] if bottom < resolution[1] else np.full(rows, np.inf),
    ]
    across, down = np.minimum(ramps[0], ramps[1]), np.minimum(ramps[2], ramps[3])
    return np.clip(np.minimum(down[:, None], across[None, :]) / MARGIN_PX, 0.0, 1.0)


def add_sensor_noise(image: Array, random: np.random.Generator, strength: float) -> Image:
    """Eight-bit image with noise that is strongest in the shadows, as a small sensor's is after gamma."""
    spread = strength * (1.4 - 0.8 * image)
    noisy = 255.0 * image + spread * random.standard_normal(image.shape)
    return np.asarray(np.clip(np.rint(noisy), 0, 255), dtype=np.uint8)


def encode(images: list[Image], path: Path, quality: str, fps: int) -> None:
    """Write images as H.264 in MP4, by Blender's sequencer."""
    with tempfile.TemporaryDirectory() as folder:
        for number, image in enumerate(images):
            cv2.imwrite(str(Path(folder) / f"{number:04d}.png"), image)
        scene = bpy.data.scenes.new("Encoding")
        height, width = images[0].shape[:2]
        scene.render.resolution_x, scene.render.resolution_y, scene.render.fps = width, height, fps
        scene.frame_start, scene.frame_end = 1, len(images)
        scene.view_settings.view_transform = "Standard"
        editor = scene.sequence_editor_create()
        strip = editor.strips.new_image("Frames", str(Path(folder) / "0000.png"), 1, 1)
        for number in range(1, len(images)):
            strip.elements.append(f"{number:04d}.png")
        strip.frame_final_duration = len(images)
        scene.render.image_settings.file_format = "FFMPEG"
        scene.render.ffmpeg.format, scene.render.ffmpeg.codec = "MPEG4", "H264"
        scene.render.ffmpeg.constant_rate_factor = quality
        scene.render.ffmpeg.ffmpeg_preset = "BEST"
        scene.render.ffmpeg.audio_codec = "NONE"
        scene.render.filepath = str(path)
        bpy.ops.render.render(animation=True, scene=scene.name)
        bpy.data.scenes.remove(scene)


@contextmanager
def only_markers(performer: bpy.types.Object, room: BuiltRoom) -> Iterator[list[int]]:
    """Context manager for flat renders: each marker in its own gray, all else black; yields the grays."""
    scene = bpy.context.scene
    kept_visible = (performer, *room.things)
    others = [
        thing for thing in scene.objects if thing.type in ("MESH", "LIGHT") and thing not in kept_visible
    ]
    grays = [40 * (number + 1) for number in range(len(MARKERS))]
    painted = {thing: list(thing.data.materials) for thing in kept_visible}
    black = _flat(0.0)
    for thing, materials in painted.items():
        for slot in range(len(materials)):
            shown = thing is performer and slot < len(MARKERS)
            thing.data.materials[slot] = _flat(grays[slot] / 255.0) if shown else black
    kept = (scene.cycles.use_denoising, scene.cycles.filter_width, scene.world)
    scene.cycles.use_denoising, scene.cycles.filter_width = False, 0.01
    scene.view_settings.view_transform, scene.world = "Raw", None
    for thing in others:
        thing.hide_render = True
    try:
        yield grays
    finally:
        for thing, materials in painted.items():
            for slot, material in enumerate(materials):
                thing.data.materials[slot] = material
        scene.cycles.use_denoising, scene.cycles.filter_width, scene.world = kept
        scene.view_settings.view_transform = "Standard"
        for thing in others:
            thing.hide_render = False


def marker_masks(grays: list[int]) -> BoolArray:
    """(M, height, width) masks of the pixels whose center shows each marker, from one flat render."""
    image = np.rint(255.0 * render(1)[..., 0])
    return np.stack([image == gray for gray in grays])


def _flat(value: float) -> bpy.types.Material:
    material = bpy.data.materials.new("Flat")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    light = nodes.new("ShaderNodeEmission")
    light.inputs["Color"].default_value = (value, value, value, 1.0)
    links.new(light.outputs["Emission"], nodes["Material Output"].inputs["Surface"])
    return material
