"""The takes of a scene: finding, adding and switching between them."""

from uuid import uuid4

import bpy

from ..core.errors import InputError
from .bridge.footage import Footage


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


def take_called(scene: bpy.types.Scene, identifier: str) -> bpy.types.PropertyGroup:
    """The take of an identifier, whichever is worked on now.

    Raises:
        InputError: It has been removed.
    """
    for take in scene.keymark.takes:
        if take.identifier == identifier:
            return take
    raise InputError("the take that the job was about has been removed meanwhile; nothing was changed")


def add_take(scene: bpy.types.Scene, name: str) -> bpy.types.PropertyGroup:
    """Add a take, which becomes the active one; a number makes its name unique."""
    settings = scene.keymark
    names = {take.name for take in settings.takes}
    take = settings.takes.add()
    numbered = (f"{name}.{number:03d}" for number in range(1, len(names) + 1))
    take.name = name if name not in names else next(free for free in numbered if free not in names)
    take.identifier = uuid4().hex
    settings.active_take = len(settings.takes) - 1
    return take


def ensure_take(scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
    """The active take, or a first one."""
    return find_take(scene) or add_take(scene, "Take")


def footage_of(scene: bpy.types.Scene, take: bpy.types.PropertyGroup) -> Footage:
    """A take's clip and camera in its scene."""
    return Footage(scene, take.clip, take.camera)


def free_camera(scene: bpy.types.Scene, take: bpy.types.PropertyGroup | None) -> bpy.types.Object | None:
    """The camera to put a take's footage behind: its own, else the scene's where no other take has it."""
    if take is not None and take.camera is not None:
        return take.camera
    taken = {other.camera for other in scene.keymark.takes}
    return scene.camera if scene.camera not in taken else None


def bring_forward(scene: bpy.types.Scene) -> None:
    """Let the scene show the active take: its clip, its camera, its range of frames."""
    take = find_take(scene)
    if take is None:
        return
    if take.camera is not None and take.camera.name in scene.objects:
        scene.camera = take.camera
    if take.clip is not None and take.clip != scene.active_clip:
        scene.active_clip = take.clip
        footage_of(scene, take).set_scene_range()
