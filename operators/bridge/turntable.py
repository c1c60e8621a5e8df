"""Turntable: further views of the actor, from the front, from a side, and from a camera that circles it.

The cameras are parented to an empty at the actor's hips, which follows them over the floor but not up and
down, so that a jump stays a jump. All objects are in a collection of their own and are removed with it.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from math import atan2, cos, hypot, pi, sin

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.numerics.vectors import unit
from .actions import assign_action, channelbag_for
from .actor_lengths import skeleton_bones
from .keys import add_generated_keys
from .object_space import evaluated
from .scene_frames import at_scene_frame

SAMPLES = 24
"""Frames at which the actor is sampled to find where it moves and faces."""
MARGIN = 1.15
"""Ratio of a view's extent to the actor's reach."""
FACING = 0.2
"""An actor whose mean facing direction is shorter than this turns all around and faces nowhere."""
SENSOR_MM = 36.0
MADE_BY_KEYMARK = "keymark_view"
"""Custom property of the turntable's objects, by which they are recognized after renaming."""
SYMBOL_M = 0.25
"""Display size of the empties and cameras [m]."""


@dataclass(frozen=True, eq=False)
class Stage:
    """Where the actor moves and faces."""

    center: Array
    """(3,) mean of its hips over the floor, and the middle of its height [m]."""
    heading_rad: float
    """Direction it faces on the whole, from the world's +X towards +Y."""
    reach_m: float
    """How far its body reaches sideways from the center, or from its hips where the view follows them."""
    rise_m: float
    """How far it reaches up and down from the center."""


@dataclass(frozen=True)
class Turntable:
    """The views; all in one collection."""

    collection: bpy.types.Collection
    front: bpy.types.Object
    side: bpy.types.Object
    turning: bpy.types.Object


def survey(
    scene: bpy.types.Scene,
    armature_object: bpy.types.Object,
    camera_object: bpy.types.Object | None,
    follow: bool,
) -> Stage:
    """Find where the actor moves and faces over the scene's frame range.

    Args:
        scene: The scene, whose current frame is restored.
        armature_object: The actor.
        camera_object: The front of an actor that turns all around is towards it; towards -Y where None.
        follow: Whether the views follow the hips.

    Raises:
        InputError: The object is no armature, or lacks bones.
    """
    bones = [model.name for model in skeleton_bones(armature_object, HUMAN)]
    frames = np.unique(
        np.linspace(scene.frame_start, max(scene.frame_end, scene.frame_start), SAMPLES).round()
    )
    ends = np.empty((len(frames), len(bones), 2, 3))
    with at_scene_frame(scene) as go_to:
        for row, frame in enumerate(frames):
            go_to(float(frame))
            ends[row] = _bone_ends(armature_object, bones)
    hips = ends[:, bones.index("pelvis"), 0]
    left_to_right = ends[:, bones.index("thigh.L"), 0] - ends[:, bones.index("thigh.R"), 0]
    low, high = ends[..., 2].min(), ends[..., 2].max()
    middle = np.array([*hips[:, :2].mean(axis=0), 0.5 * (low + high)])
    about = hips if follow else middle[None]
    sideways = np.linalg.norm(ends[..., :2] - about[:, None, None, :2], axis=-1)
    spare = (
        (0.0, -1.0)
        if camera_object is None
        else np.array(evaluated(camera_object).matrix_world.translation[:2]) - middle[:2]
    )
    return Stage(middle, _heading(left_to_right, spare), float(sideways.max()), float(0.5 * (high - low)))


def _bone_ends(armature_object: bpy.types.Object, bones: list[str]) -> Array:
    """(B, 2, 3) head and tail of each bone in the world [m]."""
    shown = evaluated(armature_object)
    matrix = np.array(shown.matrix_world, dtype=np.float64)
    ends = np.array([[shown.pose.bones[name].head, shown.pose.bones[name].tail] for name in bones])
    return np.asarray(ends @ matrix[:3, :3].T + matrix[:3, 3])


def _heading(left_to_right: Array, spare: Iterable[float]) -> float:
    """The mean direction faced by someone with the left hip (F, 3) from the right one."""
    facing = np.stack([left_to_right[:, 1], -left_to_right[:, 0]], axis=-1)
    mean = unit(facing).mean(axis=0)
    x, y = mean if hypot(*mean) > FACING else spare
    return atan2(y, x)


def add_turntable(
    scene: bpy.types.Scene,
    armature_object: bpy.types.Object,
    stage: Stage,
    name: str,
    *,
    side: str = "LEFT",
    follow: bool = True,
    lens_mm: float = 50.0,
) -> Turntable:
    """Add the views to a scene.

    Args:
        scene: Its size gives the views' shape, its range of frames is one turn of the turning view.
        armature_object: The actor.
        stage: Where it moves.
        name: Name of the collection.
        side: `LEFT` or `RIGHT`: the side of the actor that the side view sees.
        follow: Whether the views follow the hips.
        lens_mm: Focal length on a sensor 36 mm wide.
    """
    collection = bpy.data.collections.new(name)
    scene.collection.children.link(collection)
    center = _empty(collection, f"{name} Center")
    center.location = stage.center.tolist()
    if follow:
        _follow_hips(center, armature_object)
    pivot = _empty(collection, f"{name} Pivot")
    pivot.parent = center
    for layer in scene.view_layers:
        layer.update()  # it does not know the new objects yet
        for empty in (center, pivot):  # lines from each camera to them would lie over the actor
            if empty.name in layer.objects:
                empty.hide_set(True, view_layer=layer)
    _turn_once(pivot, scene.frame_start, scene.frame_end + 1)
    distance = _distance(scene, stage, lens_mm)
    sideways = stage.heading_rad + (pi / 2.0 if side == "LEFT" else -pi / 2.0)
    views = [
        _camera(collection, title, parent, angle, distance, lens_mm)
        for title, parent, angle in (
            ("Front View", center, stage.heading_rad),
            ("Side View", center, sideways),
            ("Turning View", pivot, stage.heading_rad),
        )
    ]
    return Turntable(collection, *views)


def remove_turntable(scene: bpy.types.Scene, collection: bpy.types.Collection) -> None:
    """Remove the views with their data and Actions, and their collection; what else lies in it is kept."""
    for item in list(collection.objects):
        if MADE_BY_KEYMARK in item:
            _remove_object(item)
        elif item.users_collection == (collection,):
            scene.collection.objects.link(item)
    bpy.data.collections.remove(collection)


def _remove_object(item: bpy.types.Object) -> None:
    camera = item.data
    action = item.animation_data.action if item.animation_data else None
    bpy.data.objects.remove(item)
    if camera is not None and not camera.users:
        bpy.data.cameras.remove(camera)
    if action is not None and not action.users:
        bpy.data.actions.remove(action)


def show_reference(
    camera_object: bpy.types.Object, clip: bpy.types.MovieClip | None, first_frame: int
) -> None:
    """Show a clip behind a view, or nothing.

    Args:
        camera_object: The view's camera.
        clip: The clip, which is moved in time.
        first_frame: Scene frame of its first frame.
    """
    images = camera_object.data.background_images
    camera_object.data.show_background_images = clip is not None
    if clip is None:
        images.clear()
        return
    clip.frame_start = first_frame + clip.frame_offset
    background = images[0] if images else images.new()  # where the animator moved it, it stays
    background.source = "MOVIE_CLIP"
    background.clip = clip
    background.frame_method = "FIT"
    background.alpha = 1.0


def _empty(collection: bpy.types.Collection, name: str) -> bpy.types.Object:
    empty = bpy.data.objects.new(name, None)
    empty.empty_display_type = "PLAIN_AXES"
    empty.empty_display_size = SYMBOL_M
    _add(collection, empty)
    return empty


def _add(collection: bpy.types.Collection, item: bpy.types.Object) -> None:
    item[MADE_BY_KEYMARK] = True
    collection.objects.link(item)


def _follow_hips(center: bpy.types.Object, armature_object: bpy.types.Object) -> None:
    constraint = center.constraints.new("COPY_LOCATION")
    constraint.target = armature_object
    constraint.subtarget = "pelvis"
    constraint.use_z = False


def _turn_once(pivot: bpy.types.Object, first: int, last: int) -> None:
    action = bpy.data.actions.new(pivot.name)
    channelbag = channelbag_for(action, pivot)
    frames, angles = np.array([first, last], dtype=np.float64), np.array([0.0, 2.0 * pi])
    add_generated_keys(channelbag, "rotation_euler", 2, "Turn", frames, angles)
    assign_action(pivot, action)


def _distance(scene: bpy.types.Scene, stage: Stage, lens_mm: float) -> float:
    """From where the actor fits into the picture, its nearest part included [m]."""
    render = scene.render
    half_width = 0.5 * SENSOR_MM / lens_mm
    half_height = half_width * render.resolution_y / render.resolution_x
    return stage.reach_m + MARGIN * max(stage.reach_m / half_width, stage.rise_m / half_height)


def _camera(
    collection: bpy.types.Collection,
    title: str,
    parent: bpy.types.Object,
    angle: float,
    distance: float,
    lens_mm: float,
) -> bpy.types.Object:
    """A camera at an angle round its parent, level and looking at it."""
    name = f"{collection.name} {title}"
    camera = bpy.data.cameras.new(name)
    camera.sensor_fit, camera.sensor_width, camera.lens = "HORIZONTAL", SENSOR_MM, lens_mm
    camera.display_size = SYMBOL_M
    camera_object = bpy.data.objects.new(name, camera)
    _add(collection, camera_object)
    camera_object.parent = parent
    camera_object.location = (distance * cos(angle), distance * sin(angle), 0.0)
    # Unturned, a camera looks down; tilted up by a quarter turn it looks towards +Y.
    camera_object.rotation_euler = (pi / 2.0, 0.0, angle + pi / 2.0)
    return camera_object
