"""Write core's libraries into a scene: properties, and a pose asset for each posture."""

import json
from collections.abc import Sequence

import bpy

from ....core.library.library import Library, LibraryMotion, LibraryPosture
from ...bridge.library.pose_assets import add_assets
from .scene_libraries import TAG_SEPARATOR, updates_suspended


def add_library(
    scene: bpy.types.Scene, library: Library, actions: Sequence[bpy.types.Action] | None = None
) -> bpy.types.PropertyGroup:
    """Add a library to a scene; it becomes the active one.

    Args:
        scene: The scene.
        library: The library.
        actions: Pose assets of its postures, where the file has them already; made by default.
    """
    settings = scene.keymark
    group = settings.libraries.add()
    with updates_suspended():
        write_details(group, library)
        assets = add_assets(library) if actions is None else actions
        for posture, action in zip(library.postures, assets, strict=True):
            add_posture_entry(group, posture, action)
        for motion in library.motions:
            add_motion_entry(group, motion)
    settings.active_library = len(settings.libraries) - 1
    return group


def write_details(group: bpy.types.PropertyGroup, library: Library) -> None:
    """Copy all of a library but postures and motions into the properties of a scene's library."""
    group.actor = json.dumps(dict(library.actor.segments_m))
    group.identifier, group.name, group.version = library.identifier, library.title, library.version
    group.author, group.license = library.author, library.license
    group.description, group.tags = library.description, TAG_SEPARATOR.join(library.tags)
    group.exact_tags = json.dumps(library.tags)
    group.sources.clear()
    for source in library.sources:
        group.sources.add().text = source


def add_posture_entry(
    group: bpy.types.PropertyGroup, posture: LibraryPosture, action: bpy.types.Action
) -> bpy.types.PropertyGroup:
    """Add a posture at the end of a library's list."""
    entry = group.postures.add()
    entry.tags, entry.exact_tags = TAG_SEPARATOR.join(posture.tags), json.dumps(posture.tags)
    entry.named = entry.name = posture.name
    entry.action = action
    return entry


def add_motion_entry(group: bpy.types.PropertyGroup, motion: LibraryMotion) -> bpy.types.PropertyGroup:
    """Add a motion at the end of a library's list."""
    entry = group.motions.add()
    entry.duration_exact = repr(motion.duration_s)
    for name, value in zip(("travel_x", "travel_y", "travel_turn"), motion.travel, strict=True):
        setattr(entry, f"{name}_exact", repr(value))
    for step in motion.steps:
        row = entry.steps.add()
        row.posture, row.time_exact = step.posture, repr(step.time_s)
    entry.cyclic = motion.cyclic
    entry.name = motion.name
    return entry
