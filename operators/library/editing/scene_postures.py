"""Postures taken into a library that is made in a scene."""

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import bpy

from ....core.arrays import Array
from ....core.errors import InputError
from ....core.library.library import LibraryMotion, LibraryPosture, MotionStep
from ....core.library.library_fields import LONGEST_TAG, MOST_POSTURES
from ....core.library.mirroring import with_mirrored
from ....core.library.texts import LONGEST_NAME, text_fault, unique_name
from ...bridge.library.pose_assets import add_asset
from ...bridge.library.poses import as_kept
from ...bridge.posture_curves import rewrite_posture_curves
from .scene_libraries import (
    active_posture,
    actor_of_library,
    add_motion_to,
    add_posture_to,
    draft,
    library_of,
    postures_of,
    show_again,
)

if TYPE_CHECKING:
    from ....core.body.kinematics import Body
    from ....core.body.posture import Posture

DECIMALS_S = 4


def keep_postures(
    group: bpy.types.PropertyGroup,
    body: "Body",
    postures: "Posture",
    names: Sequence[str],
    tags: tuple[str, ...] = (),
    *,
    on_floor: bool,
) -> list[str]:
    """Add postures of one performance to a library; the first ever gives it its proportions.

    Args:
        group: The scene's library.
        body: Who performed.
        postures: A batch of F, in the world.
        names: A name each; a number makes one unique.
        tags: Of each.
        on_floor: The lowest sole of all touches the floor; else the floor is the world's.

    Returns:
        The names they have got.

    Raises:
        InputError: A name or tag cannot be one, or there would be too many.
    """
    _check(group, names, tags)
    if not len(group.postures):
        group.actor = json.dumps(dict(body.actor.segments_m))
    kept = as_kept(body, postures, actor_of_library(group), on_floor=on_floor)
    return add_named(group, [LibraryPosture(name.strip(), kept[row], tags) for row, name in enumerate(names)])


def add_named(group: bpy.types.PropertyGroup, postures: Sequence[LibraryPosture]) -> list[str]:
    """Add postures of the library's own actor; a number makes a name unique. Returns the names."""
    library = draft(group)
    names = []
    for posture in postures:
        name = unique_name(posture.name, [entry.name for entry in group.postures])
        named = replace(posture, name=name)
        add_posture_to(group, named, add_asset(library, named, len(group.postures)))
        names.append(name)
    group.active_posture = len(group.postures) - 1
    show_again(group)
    return names


def replace_posture(
    group: bpy.types.PropertyGroup, body: "Body", postures: "Posture", *, on_floor: bool
) -> bpy.types.PropertyGroup:
    """Put a pose in the place of the chosen posture.

    Raises:
        InputError: None is chosen.
    """
    entry = active_posture(group)
    if entry is None or entry.action is None:
        raise InputError(f"no posture of the library '{group.name}' is chosen; choose the one to replace")
    actor = actor_of_library(group)
    kept = as_kept(body, postures, actor, on_floor=on_floor)[0]
    rewrite_posture_curves(entry.action, actor, kept)
    show_again(group, [entry])
    return entry


def keep_motion(
    group: bpy.types.PropertyGroup,
    name: str,
    postures: Sequence[str],
    time_s: "Array",
    *,
    cyclic: bool,
) -> bpy.types.PropertyGroup:
    """Add a motion through postures of the library.

    Args:
        group: The scene's library.
        name: The motion's; a number makes it unique.
        postures: Names of the postures, in order.
        time_s: (N,) from 0, rising; (N + 1,) for a cyclic one: last, when the first posture comes again [s].
        cyclic: Whether it does.

    Raises:
        InputError: The name cannot be one.
    """
    fault = text_fault(name.strip(), LONGEST_NAME)
    if fault:
        raise InputError(f"the motion's name is '{name}'; it {fault}")
    times = [round(float(value), DECIMALS_S) for value in time_s]
    free = unique_name(name.strip(), [motion.name for motion in group.motions])
    steps = tuple(MotionStep(posture, when) for posture, when in zip(postures, times, strict=False))
    motion = add_motion_to(group, LibraryMotion(free, steps, times[-1], cyclic))
    group.active_motion = len(group.motions) - 1
    show_again(group)
    return motion


def add_mirrored(group: bpy.types.PropertyGroup, *, only_chosen: bool) -> int:
    """Add the mirrored form of what a library lacks the other side of; how many postures that were.

    Args:
        group: The scene's library.
        only_chosen: Only of the posture chosen in its list; else of all, and of the motions.

    Raises:
        InputError: None is chosen, or the library's actor has sides of different lengths.
    """
    library = library_of(group)
    if only_chosen:
        chosen = active_posture(group)
        if chosen is None or chosen.name not in library.by_name:
            raise InputError(f"no posture of the library '{group.name}' is chosen; choose the one to mirror")
        library = replace(library, postures=(library.by_name[chosen.name],), motions=())
    whole = with_mirrored(library)
    postures = whole.postures[len(library.postures) :]
    motions = whole.motions[len(library.motions) :]
    names = add_named(group, postures)
    now = dict(zip((posture.name for posture in postures), names, strict=True))
    for motion in motions:
        steps = tuple(replace(step, posture=now.get(step.posture, step.posture)) for step in motion.steps)
        taken = [other.name for other in group.motions]
        add_motion_to(group, replace(motion, name=unique_name(motion.name, taken), steps=steps))
    show_again(group)
    return len(names)


def _check(group: bpy.types.PropertyGroup, names: Sequence[str], tags: Sequence[str]) -> None:
    for name in names:
        fault = text_fault(name.strip(), LONGEST_NAME)
        if fault:
            raise InputError(f"the posture's name is '{name}'; it {fault}")
    for tag in tags:
        fault = text_fault(tag, LONGEST_TAG)
        if fault:
            raise InputError(f"the tag is '{tag}'; it {fault}")
    if len(postures_of(group)) + len(names) > MOST_POSTURES:
        raise InputError(f"a library holds at most {MOST_POSTURES} postures")
