"""Files of other versions of Keymark, and from other machines: updated when Blender opens them."""

from collections.abc import Iterable
from typing import Any
from uuid import uuid4

import bpy
from bpy.app.handlers import persistent
from bpy.types import Scene

from ..bridge.actor_bones import hips_at_rest, is_actor, recolor_earlier
from ..bridge.footage import is_missing
from ..footage.load_footage import update_clip_digest
from ..shell.take_state import TakeState, digest_of
from ..shell.takes import VERSION


def upgrade_scene(scene: Scene) -> None:
    """Upgrade a scene's properties, but a newer Keymark's, and note which clips are missing."""
    settings = scene.keymark
    if scene.library is not None or is_newer(scene):
        return
    for take in settings.takes:
        # A Keymark that marked outdated results by hand did not note what they were made from.
        for made in (take.finish, *TakeState(take).results):
            has_own = hasattr(made, "bl_system_properties_get")
            properties = made.bl_system_properties_get() if has_own else made
            if made.action is not None and not made.made_from and not (properties or {}).get("outdated"):
                source = take.motion_action if made == take.finish else TakeState(take).source_of(made)
                made.made_from = digest_of(source)
        take.clip_state.missing = is_missing(take.clip)
        if take.clip is not None:
            update_clip_digest(take)
        if is_actor(take.armature):
            take.rest_hips = hips_at_rest(take.armature)
            if take.armature.data.library is None:
                recolor_earlier(take.armature.data)
    if len(settings.takes):
        settings.version = VERSION


def is_newer(scene: Scene) -> bool:
    """Whether a newer Keymark wrote the scene's properties."""
    return bool(scene.keymark.version > VERSION)


def ensure_unique_identifiers(scenes: Iterable[Scene]) -> None:
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


HANDLERS = {"load_post": _on_load, "blend_import_post": _on_load}


def register() -> None:
    """Upgrade the open file; while Blender starts, there is none yet."""
    if hasattr(bpy.data, "scenes"):
        _on_load()
