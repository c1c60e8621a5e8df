"""Write footage into a scene: core's camera and clip as camera, movie clip, frame range and rate."""

from pathlib import Path

import bpy
import numpy as np
from bpy.types import MovieClip, Object, Scene

from ...core.arrays import Array
from ...core.body.rotations import continuous_quaternions, to_quaternions
from ...core.camera.camera import Camera
from ...core.errors import InputError
from ...core.files.paths import real_path
from ...core.take.motion import Motion
from ...core.take.take import Take
from ...core.video.image_sequence import find_images
from .actions import assign_action, channelbag_for, curve_digest
from .armature import build_armature
from .blend_files import own_scene, write_blend
from .body_mesh import build_body_mesh
from .export_formats import write_bvh
from .fcurves import write_motion
from .footage import clip_rate, set_scene_range
from .footage_camera import new_camera, set_background, set_clip_lens, set_lens, set_still_pose
from .keys import MOTION, write_keys
from .scene_frames import scene_frames


def load_footage(path: Path) -> MovieClip:
    """Load a video, a folder of images, or a pattern of numbered images; InputError if Blender cannot."""
    file = clip_file(path)
    before = set(bpy.data.movieclips)
    try:
        clip = bpy.data.movieclips.load(stored_path(file), check_existing=True)
    except RuntimeError as error:
        raise InputError(f"{file}: Blender cannot read this clip; name a video or numbered images") from error
    if not clip.frame_duration:  # Blender gives what it cannot decode a size, but no frames
        if clip not in before:
            bpy.data.movieclips.remove(clip)
        advice = "convert it to H.264 or to numbered images"
        raise InputError(f"{file}: Blender cannot decode this clip; {advice}")
    return clip


def clip_file(path: Path) -> Path:
    """The file that Blender opens as a clip: the video, or the first image of a sequence."""
    images = find_images(path)
    return path if images is None else images[0]


def stored_path(file: Path) -> str:
    """A file's path as Blender stores it: relative to a saved .blend, where the preferences ask for that."""
    path = str(real_path(file))
    if not (bpy.data.filepath and bpy.context.preferences.filepaths.use_relative_paths):
        return path
    try:
        return str(bpy.path.relpath(path))
    except ValueError:  # on another drive
        return path


def show_footage(
    scene: Scene, camera: Camera, clip_path: Path, fps: float, frame_start: int, time_s: Array
) -> tuple[Object, Array]:
    """Show a clip behind a new camera from `frame_start` on; both the camera and its scene frames (F,)."""
    clip = load_footage(clip_path)
    rate = clip_rate(clip, fps)
    frames = scene_frames(time_s, frame_start, rate)
    clip.frame_start = frame_start
    set_scene_range(scene, camera.resolution, rate, frame_start, len(frames))
    set_clip_lens(clip, camera)
    camera_object = new_camera(scene)
    set_lens(camera_object.data, camera)
    set_pose(camera_object, camera, frames)
    set_background(camera_object.data, clip)
    scene.camera, scene.active_clip = camera_object, clip
    return camera_object, frames


def set_pose(camera_object: Object, camera: Camera, frames: Array) -> None:
    """Give a camera the pose of core's; a moving one has its poses at scene frames (F,)."""
    if not camera.is_moving:
        set_still_pose(camera_object, camera)
        return
    camera_object.rotation_mode = "QUATERNION"
    action = bpy.data.actions.new(f"{camera_object.name} Motion")
    poses = camera.matrix_world[: len(frames)]
    turns = continuous_quaternions(to_quaternions(poses[:, :3, :3]))
    channels = (("location", poses[:, :3, 3]), ("rotation_quaternion", turns))
    columns = [(path, i, "Camera", column) for path, rows in channels for i, column in enumerate(rows.T)]
    write_keys(channelbag_for(action, camera_object), columns, frames[: len(poses)], MOTION)
    assign_action(camera_object, action)


def write_scene(take: Take, motion: Motion, blend_path: Path, bvh_path: Path | None = None) -> str:
    """Write a motion as a .blend and, if asked for, as a BVH; returns the SHA-256 of the Action's curves.

    The .blend holds the actor's armature with the motion as its Action, a skin in the markers' colors, and
    the camera with the clip behind it; the clip's path is relative where the drives allow. An error may leave
    half a file: the caller passes a staging folder and moves the files when both are complete.
    """
    with own_scene(f"{take.name} Motion") as scene:
        frames = show_take(scene, take, motion)
        armature_object = build_armature(scene, take.body, "Actor")
        write_motion(armature_object, motion, frames=frames)
        build_body_mesh(armature_object, take.body, take.markers)
        scene.frame_set(scene.frame_start)
        write_blend(blend_path, {scene}, path_remap="RELATIVE_ALL", fake_user=False)
        if bvh_path is not None:
            write_bvh(armature_object, bvh_path)
        return curve_digest(armature_object)


def show_take(scene: Scene, take: Take, motion: Motion) -> Array:
    """Put footage and camera into a scene, with rate, range and look; the motion's scene frames (F,)."""
    _, frames = show_footage(scene, take.camera, take.clip, motion.fps, motion.frame_start, motion.time_s)
    scene.frame_end = max(scene.frame_end, int(np.floor(frames[-1])))
    set_look(scene)
    return frames


def set_look(scene: Scene) -> None:
    """Workbench in material colors, which every Blender has, and light for the other engines."""
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.display.shading.color_type = "MATERIAL"
    # It shows colors as they are given, so that markers look as in the footage; the default, AgX, does not.
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("Soft Light")
    scene.world.color = (0.8, 0.8, 0.8)
