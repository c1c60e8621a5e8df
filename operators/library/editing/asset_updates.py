"""Update the pose assets of a scene's library after its properties were changed."""

import json
from collections.abc import Sequence

import bpy

from ....core.body.kinematics import Body
from ....core.library.texts import unique_name
from ....core.report.posture_picture import posture_picture
from ...bridge.library.pose_assets import header_text, stamp_asset, stamp_header
from .library_from_scene import library_from_scene, postures_from_scene, unchecked_library
from .scene_libraries import TAG_SEPARATOR, library_containing, updates_are_suspended, updates_suspended


def update_assets(group: bpy.types.PropertyGroup, redrawn: Sequence[bpy.types.PropertyGroup] = ()) -> None:
    """Write name, tags, order and library of every posture into its pose asset.

    Args:
        group: The library.
        redrawn: Postures whose pictures are drawn again too.

    Raises:
        InputError: An asset is not what Keymark has written.
    """
    postures = postures_from_scene(group)
    library = unchecked_library(group, postures)
    entries = [entry for entry in group.postures if entry.action is not None]
    body = Body(library.actor)
    with updates_suspended():
        for order, (entry, posture) in enumerate(zip(entries, postures.values(), strict=True)):
            _rename_steps(group, entry.name, posture.name)
            entry.named = entry.name = posture.name
            entry.tags, entry.exact_tags = TAG_SEPARATOR.join(posture.tags), json.dumps(posture.tags)
            entry.action.name = posture.name
            again = any(entry == other for other in redrawn)
            picture = posture_picture(body, posture.posture) if again else None
            stamp_asset(entry.action, library, posture, order, picture)


def details_changed(part: bpy.types.PropertyGroup) -> None:
    """Write a library's details into its pose assets, after a part of it was changed.

    Raises:
        InputError: The properties are not what a library may hold.
    """
    group = None if updates_are_suspended() else library_containing(part)
    if group is None:
        return
    header = header_text(library_from_scene(group))
    for entry in group.postures:
        if entry.action is not None:
            stamp_header(entry.action, header)


def posture_changed(entry: bpy.types.PropertyGroup) -> None:
    """Write a posture's name, made unique, and its tags into the motions and its pose asset.

    Raises:
        InputError: The asset is not what Keymark has written.
    """
    group = None if updates_are_suspended() else library_containing(entry)
    if group is None or entry.action is None:
        return
    with updates_suspended():
        others = [other.name for other in group.postures if other != entry]
        entry.name = unique_name(entry.name.strip() or "Posture", others)
        _rename_steps(group, entry.named, entry.name)
    update_assets(group)


def _rename_steps(group: bpy.types.PropertyGroup, before: str, now: str) -> None:
    if before == now:
        return
    for motion in group.motions:
        for step in motion.steps:
            if step.posture == before:
                step.posture = now
