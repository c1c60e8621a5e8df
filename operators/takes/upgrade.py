"""Files of other versions of Keymark, and of other machines: looked at whenever a file is opened."""

from collections.abc import Iterable
from typing import Any
from uuid import uuid4

import bpy
from bpy.app.handlers import persistent

from ..footage.take_footage import is_missing, note_contents
from ..shell.takes import VERSION, add_take

VALUES = ("stature", "keyframe_count", "active_marker", "armature", "keyframe_action", "motion_action")
"""What version 0 kept in the scene itself and a take has under the same name."""
CHOICES = ("method",)
"""The same, as numbers of menu entries."""


def look_at(scene: bpy.types.Scene) -> None:
    """Bring a scene's properties up to date, and note which clips are missing.

    What a newer Keymark has written is left alone, so that nothing of it is lost.
    """
    settings = scene.keymark
    if scene.library is not None or is_newer(scene):
        return
    if not len(settings.takes):
        _upgrade_flat(scene)
    for take in settings.takes:
        take.clip_state.missing = is_missing(take.clip)
        if take.clip is not None:
            note_contents(take)
    if len(settings.takes):
        settings.version = VERSION


def is_newer(scene: bpy.types.Scene) -> bool:
    """Whether a newer Keymark has written the scene's properties."""
    return bool(scene.keymark.version > VERSION)


def _upgrade_flat(scene: bpy.types.Scene) -> None:
    """Make a take of what version 0 kept in the scene itself, when a scene had one performer."""
    flat = _stored(scene)
    if flat is None or not any(name in flat for name in (*VALUES, "markers")):
        return
    found = {name: flat[name] for name in (*VALUES, *CHOICES) if name in flat}
    markers = [dict(marker) for marker in flat.get("markers", ())]
    take = add_take(scene, "Take")
    take.camera = scene.camera
    take.clip = scene.active_clip
    for name, value in found.items():
        _set(take, name, value)
    for entry in markers:
        marker = take.markers.add()
        for name, value in entry.items():
            _set(marker, name, value)
    stored = _stored(scene)
    for name in (*found, "markers"):
        if stored is not None and name in stored:
            del stored[name]


def _set(group: bpy.types.PropertyGroup, name: str, value: Any) -> None:
    """Set a property from what a file holds of it; menu entries are stored by their number."""
    definition = group.bl_rna.properties.get(name)
    if definition is None or value is None:
        return
    if definition.type == "ENUM":
        value = definition.enum_items[int(value)].identifier
    setattr(group, name, value)


def _stored(scene: bpy.types.Scene) -> Any:
    """The scene's properties as the file holds them, whatever they are defined as now."""
    if hasattr(scene, "bl_system_properties_get"):  # Blender 5.0 and later
        properties = scene.bl_system_properties_get()
        return properties.get("keymark") if properties is not None else None
    return scene.get("keymark")


def tell_apart(scenes: Iterable[bpy.types.Scene]) -> None:
    """Give takes that cannot be told apart, as those of a copied scene, identifiers of their own."""
    seen: set[str] = set()
    for scene in scenes:
        if scene.library is not None or is_newer(scene):
            continue
        for take in scene.keymark.takes:
            if not take.identifier or take.identifier in seen:
                take.identifier = uuid4().hex
            seen.add(take.identifier)


@persistent
def _opened(*_given: Any) -> None:
    for scene in bpy.data.scenes:
        look_at(scene)
    tell_apart(bpy.data.scenes)


HANDLERS = ("load_post", "blend_import_post")


def register() -> None:
    """Look at every file that is opened, and at the one that is open."""
    for name in HANDLERS:
        getattr(bpy.app.handlers, name).append(_opened)
    if hasattr(bpy.data, "scenes"):  # while Blender starts, there are none yet
        _opened()


def unregister() -> None:
    """Look no longer."""
    for name in HANDLERS:
        getattr(bpy.app.handlers, name).remove(_opened)
