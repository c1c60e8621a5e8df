"""Files of other versions of Keymark, and from other machines: updated when Blender opens them."""

from collections.abc import Iterable
from typing import Any
from uuid import uuid4

import bpy
from bpy.app.handlers import persistent

from ..bridge.actor_bones import hips_at_rest, is_actor
from ..bridge.bone_colors import recolor_earlier
from ..footage.take_footage import is_missing, update_clip_digest
from ..shell.takes import VERSION, add_take

VALUES = ("stature", "keyframe_count", "active_marker", "armature", "keyframe_action", "motion_action")
"""Properties that version 0 kept in the scene itself; a take has them under the same names."""
CHOICES = ("method",)
"""The same for menus; version 0 stored the number of the entry."""


def upgrade_scene(scene: bpy.types.Scene) -> None:
    """Upgrade a scene's properties to this version, and note which clips are missing.

    The properties of a newer Keymark are left alone, so that nothing of them is lost.
    """
    settings = scene.keymark
    if scene.library is not None or is_newer(scene):
        return
    if not len(settings.takes):
        _upgrade_version_0(scene)
    for take in settings.takes:
        take.clip_state.missing = is_missing(take.clip)
        if take.clip is not None:
            update_clip_digest(take)
        if is_actor(take.armature):
            take.rest_hips = hips_at_rest(take.armature)
            if take.armature.data.library is None:
                recolor_earlier(take.armature.data)
    if len(settings.takes):
        settings.version = VERSION


def is_newer(scene: bpy.types.Scene) -> bool:
    """Whether a newer Keymark wrote the scene's properties."""
    return bool(scene.keymark.version > VERSION)


def _upgrade_version_0(scene: bpy.types.Scene) -> None:
    """Make a take of the properties that version 0, with one performer a scene, kept in the scene itself."""
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
    """Set a property to a stored value; a menu's is the number of its entry."""
    definition = group.bl_rna.properties.get(name)
    if definition is None or value is None:
        return
    if definition.type == "ENUM":
        value = definition.enum_items[int(value)].identifier
    setattr(group, name, value)


def _stored(scene: bpy.types.Scene) -> Any:
    """Return the scene's properties as stored in the file, independent of their definitions now."""
    if hasattr(scene, "bl_system_properties_get"):  # Blender 5.0 and later
        properties = scene.bl_system_properties_get()
        return properties.get("keymark") if properties is not None else None
    return scene.get("keymark")


def ensure_unique_identifiers(scenes: Iterable[bpy.types.Scene]) -> None:
    """Give new identifiers to takes that share one, as those of a copied scene do."""
    seen: set[str] = set()
    for scene in scenes:
        if scene.library is not None or is_newer(scene):
            continue
        for take in scene.keymark.takes:
            if not take.identifier or take.identifier in seen:
                take.identifier = uuid4().hex
            seen.add(take.identifier)


@persistent
def _on_load(*_arguments: Any) -> None:
    for scene in bpy.data.scenes:
        upgrade_scene(scene)
    ensure_unique_identifiers(bpy.data.scenes)


HANDLERS = ("load_post", "blend_import_post")


def register() -> None:
    """Upgrade the open file, and add handlers for the files that are opened."""
    for name in HANDLERS:
        getattr(bpy.app.handlers, name).append(_on_load)
    if hasattr(bpy.data, "scenes"):  # while Blender starts, there are none yet
        _on_load()


def unregister() -> None:
    """Remove the handlers."""
    for name in HANDLERS:
        getattr(bpy.app.handlers, name).remove(_on_load)
