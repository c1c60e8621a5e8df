"""The takes of a scene: finding one, adding one, switching between them."""

from collections.abc import Iterable
from uuid import uuid4

import bpy

from ...core.errors import InputError
from ..bridge.footage import Footage, set_scene_range

VERSION = 1
"""Version of Keymark's properties; each scene holds the version that wrote it."""


def active_take(scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
    """Return the active take.

    Raises:
        InputError: The scene has no take.
    """
    take = find_take(scene)
    if take is None:
        raise InputError(f"scene '{scene.name}' has no take; load the footage or open a take first")
    return take


def find_take(scene: bpy.types.Scene) -> bpy.types.PropertyGroup | None:
    """Return the active take; None if the scene has no take."""
    settings = scene.keymark
    if not len(settings.takes):
        return None
    return settings.takes[min(settings.active_take, len(settings.takes) - 1)]


def take_by_identifier(scene: bpy.types.Scene, identifier: str) -> bpy.types.PropertyGroup:
    """Return the take with an identifier, active or not.

    Raises:
        InputError: There is none: it was removed.
    """
    for take in scene.keymark.takes:
        if take.identifier == identifier:
            return take
    raise InputError("the take of this job was removed while it ran; nothing was changed")


def actor_of(take: bpy.types.PropertyGroup) -> bpy.types.Object:
    """Return a take's armature.

    Raises:
        InputError: The take has none, or it was deleted.
    """
    if take.armature is None:
        raise InputError(f"take '{take.name}' has no actor; build one, or choose its armature")
    return take.armature


def present_actor(take: bpy.types.PropertyGroup) -> bpy.types.Object | None:
    """Return a take's armature if it is in the scene.

    Deleted with X it is in no scene any more, yet in the file, as long as the take points to it.
    """
    armature_object = take.armature
    there = armature_object is not None and armature_object.name in take.id_data.objects
    return armature_object if there else None


def kept_actions(take: bpy.types.PropertyGroup) -> tuple[bpy.types.Action, ...]:
    """Return the Actions of a take's actor: keyframes, motion and final; they outlive the actor."""
    actions = (take.keyframe_action, take.motion_action, take.finish.action)
    return tuple(action for action in actions if action is not None)


def has_lost_actor(take: bpy.types.PropertyGroup) -> bool:
    """Whether a take had an actor that is gone from the scene."""
    return present_actor(take) is None and (take.armature is not None or bool(kept_actions(take)))


def add_take(scene: bpy.types.Scene, name: str) -> bpy.types.PropertyGroup:
    """Add a take and make it the active one; a number makes its name unique."""
    settings = scene.keymark
    settings.version = max(settings.version, VERSION)
    take = settings.takes.add()
    take.name = name  # its update makes it unique, see `unique_name`
    take.identifier = uuid4().hex
    settings.active_take = len(settings.takes) - 1
    return take


def unique_name(name: str, others: Iterable[str]) -> str:
    """Return a name that none of the others has, made unique by a number like Blender's own (`Walk.001`)."""
    taken = set(others)
    stem, _, number = name.rpartition(".")
    base = stem if stem and len(number) == 3 and number.isdigit() else name
    numbered = (f"{base}.{number:03d}" for number in range(1, len(taken) + 2))
    return name if name not in taken else next(free for free in numbered if free not in taken)


def ensure_take(scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
    """Return the active take; if there is none, add the first one."""
    return find_take(scene) or add_take(scene, "Take")


def footage_of(scene: bpy.types.Scene, take: bpy.types.PropertyGroup) -> Footage:
    """Return a take's clip and camera in its scene."""
    return Footage(scene, take.clip, take.camera)


def show_active_take(scene: bpy.types.Scene) -> None:
    """Set the scene's clip, camera and frame range to the active take's, and select its actor."""
    take = find_take(scene)
    if take is None:
        return
    _select(scene, take.armature)
    if take.camera is not None and take.camera.name in scene.objects:
        scene.camera = take.camera
    clip = take.clip
    if clip is None or clip == scene.active_clip:
        return
    scene.active_clip = clip
    if clip.frame_duration and all(clip.size):
        footage = footage_of(scene, take)
        # Blender forgets the rate of a clip whose file is missing, and images have none of their own.
        rate = take.clip_state.rate or footage.rate
        size = (clip.size[0], clip.size[1])
        set_scene_range(scene, size, rate, footage.first_frame, clip.frame_duration)
        scene.frame_current = min(max(scene.frame_current, scene.frame_start), scene.frame_end)


def _select(scene: bpy.types.Scene, armature_object: bpy.types.Object | None) -> None:
    """Select an actor and make it active, unless another object is being edited."""
    layer = bpy.context.view_layer
    if armature_object is None or bpy.context.scene != scene or armature_object.name not in layer.objects:
        return
    before = layer.objects.active
    if before == armature_object or (before is not None and before.mode != "OBJECT"):
        return
    for chosen in list(layer.objects.selected):
        chosen.select_set(False)
    armature_object.select_set(True)
    layer.objects.active = armature_object
