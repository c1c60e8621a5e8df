"""The takes of a scene: finding, adding and switching between them."""

from collections.abc import Iterable
from uuid import uuid4

import bpy

from ...core.errors import InputError
from ..bridge.footage import Footage, set_scene_range

VERSION = 1
"""Version of Keymark's properties; a scene says by which it was written."""


def active_take(scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
    """The take that is worked on.

    Raises:
        InputError: The scene has none.
    """
    take = find_take(scene)
    if take is None:
        raise InputError(f"scene '{scene.name}' has no take; load the footage or open a take first")
    return take


def find_take(scene: bpy.types.Scene) -> bpy.types.PropertyGroup | None:
    """The take that is worked on; None where the scene has none."""
    settings = scene.keymark
    if not len(settings.takes):
        return None
    return settings.takes[min(settings.active_take, len(settings.takes) - 1)]


def take_by_identifier(scene: bpy.types.Scene, identifier: str) -> bpy.types.PropertyGroup:
    """The take of an identifier, whichever is worked on now.

    Raises:
        InputError: It has been removed.
    """
    for take in scene.keymark.takes:
        if take.identifier == identifier:
            return take
    raise InputError("the take that the job was about has been removed meanwhile; nothing was changed")


def actor_of(take: bpy.types.PropertyGroup) -> bpy.types.Object:
    """A take's armature.

    Raises:
        InputError: It has none, or it has been deleted.
    """
    if take.armature is None:
        raise InputError(f"take '{take.name}' has no actor; build one, or choose its armature")
    return take.armature


def add_take(scene: bpy.types.Scene, name: str) -> bpy.types.PropertyGroup:
    """Add a take, which becomes the active one; a number makes its name unique."""
    settings = scene.keymark
    settings.version = max(settings.version, VERSION)
    take = settings.takes.add()
    take.name = name  # made unique, see `unique_name`
    take.identifier = uuid4().hex
    settings.active_take = len(settings.takes) - 1
    return take


def unique_name(name: str, others: Iterable[str]) -> str:
    """A name that none of the others has, by a number like Blender's own."""
    taken = set(others)
    stem, _, number = name.rpartition(".")
    base = stem if stem and len(number) == 3 and number.isdigit() else name
    numbered = (f"{base}.{number:03d}" for number in range(1, len(taken) + 2))
    return name if name not in taken else next(free for free in numbered if free not in taken)


def ensure_take(scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
    """The active take, or a first one."""
    return find_take(scene) or add_take(scene, "Take")


def footage_of(scene: bpy.types.Scene, take: bpy.types.PropertyGroup) -> Footage:
    """A take's clip and camera in its scene."""
    return Footage(scene, take.clip, take.camera)


def show_active_take(scene: bpy.types.Scene) -> None:
    """Let the scene show the active take: its clip, its camera, its range of frames, its actor selected."""
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
    """Let timelines and the next mode be about an actor, unless the animator is busy with another's."""
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
