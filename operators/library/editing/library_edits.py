"""Edits of the library that is made in a scene: postures and motions added, replaced, mirrored."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np

from ....core.arrays import Array
from ....core.body.human import HUMAN
from ....core.body.kinematics import Body
from ....core.body.posture import Posture
from ....core.errors import InputError
from ....core.library.library import MOST_POSTURES, LibraryMotion, LibraryPosture, MotionStep
from ....core.library.mirroring import with_mirrored
from ....core.library.text_fields import LONGEST_TAG
from ....core.library.texts import LONGEST_NAME, text_fault, unique_name
from ...bridge.actor_lengths import read_body
from ...bridge.keyframes import NOTICEABLE_M, keyed_frames, read_keyframes
from ...bridge.library.pose_assets import add_asset
from ...bridge.library.posture_transfer import posture_for_library
from ...bridge.pose import read_posture
from ...bridge.posture_curves import rewrite_posture_curves
from .asset_updates import update_assets
from .library_from_scene import actor_of_library, library_from_scene, postures_from_scene, unchecked_library
from .library_to_scene import add_motion_entry, add_posture_entry
from .scene_libraries import active_posture

DECIMALS_S = 4


@dataclass(frozen=True)
class AddedPose:
    """The actor's pose as a posture of a library."""

    name: str
    beyond_m: float
    """How far the pose goes beyond what the skeleton can do [m]; 0 where that is not noticeable."""


def add_pose(
    group: bpy.types.PropertyGroup,
    armature_object: bpy.types.Object,
    name: str | None,
    tags: tuple[str, ...] = (),
    *,
    on_floor: bool,
) -> AddedPose:
    """Add the pose that an armature shows to a library, or replace the chosen posture by it.

    Args:
        group: The scene's library.
        armature_object: The actor.
        name: The posture's; None to replace the chosen posture, which keeps its name and tags.
        tags: The posture's.
        on_floor: The lowest sole touches the floor; else the floor is the world's.

    Raises:
        InputError: The object is not an actor, a name or tag is invalid, or none is chosen to be replaced.
    """
    body = read_body(armature_object, HUMAN)
    reading = read_posture(armature_object, body)
    postures = Posture.stack([reading.posture])
    if name is None:
        name = replace_posture(group, body, postures, on_floor=on_floor).name
    else:
        (name,) = add_postures(group, body, postures, [name], tags, on_floor=on_floor)
    return AddedPose(name, reading.furthest_m if reading.furthest_m > NOTICEABLE_M else 0.0)


def add_keyframes(
    group: bpy.types.PropertyGroup,
    scene: bpy.types.Scene,
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    name: str,
    *,
    cyclic: bool,
) -> tuple[list[str], Array]:
    """Add the keyframes of an Action to a library, a posture each.

    Args:
        group: The scene's library.
        scene: The scene that holds the armature.
        armature_object: The actor.
        action: The animator's Action.
        name: Each posture's name begins with it; a number follows.
        cyclic: The last keyframe is the first posture again and is not added.

    Returns:
        Names of the postures, and the times of all keyframes from the first one on [s].

    Raises:
        InputError: There are too few keyframes, a name is invalid, or the library would be too large.
    """
    body = read_body(armature_object, HUMAN)
    frames = np.array(keyed_frames(armature_object, action, HUMAN))
    if len(frames) < (3 if cyclic else 2):
        raise InputError(
            "the take has {frames} keyframes; a motion needs two, a cyclic one three", frames=len(frames)
        )
    posed = read_keyframes(scene, armature_object, action, body, frames).keyframes
    time_s = (frames - frames[0]) * scene.render.fps_base / scene.render.fps
    kept = posed[:-1] if cyclic else posed
    digits = len(str(len(kept)))
    names = [f"{name.strip()} {number:0{digits}}" for number in range(1, len(kept) + 1)]
    postures = Posture.stack([keyframe.posture for keyframe in kept])
    return add_postures(group, body, postures, names, on_floor=True), time_s


def add_postures(
    group: bpy.types.PropertyGroup,
    body: Body,
    postures: Posture,
    names: Sequence[str],
    tags: tuple[str, ...] = (),
    *,
    on_floor: bool,
) -> list[str]:
    """Add postures of one performance to a library; the first ever added sets the library's proportions.

    Args:
        group: The scene's library.
        body: The performer's.
        postures: A batch of F, in the world.
        names: A name for each; a number makes it unique.
        tags: Tags of each.
        on_floor: The lowest sole of all touches the floor; else the floor is the world's.

    Returns:
        The names given.

    Raises:
        InputError: A name or tag is invalid, or the library would be too large.
    """
    _check(group, names, tags)
    if not len(group.postures):
        group.actor = json.dumps(dict(body.actor.segments_m))
    kept = posture_for_library(body, postures, actor_of_library(group), on_floor=on_floor)
    return _add_entries(
        group, [LibraryPosture(name.strip(), kept[row], tags) for row, name in enumerate(names)]
    )


def _add_entries(group: bpy.types.PropertyGroup, postures: Sequence[LibraryPosture]) -> list[str]:
    """Add postures of the library's own actor; a number makes a name unique. Returns the names."""
    library = unchecked_library(group)
    names = []
    for posture in postures:
        name = unique_name(posture.name, [entry.name for entry in group.postures])
        named = replace(posture, name=name)
        add_posture_entry(group, named, add_asset(library, named, len(group.postures)))
        names.append(name)
    group.active_posture = len(group.postures) - 1
    update_assets(group)
    return names


def replace_posture(
    group: bpy.types.PropertyGroup, body: Body, postures: Posture, *, on_floor: bool
) -> bpy.types.PropertyGroup:
    """Replace the chosen posture of a library by a pose.

    Raises:
        InputError: None is chosen.
    """
    entry = active_posture(group)
    if entry is None or entry.action is None:
        raise InputError(
            "no posture of the library '{library}' is chosen; choose the one to replace",
            library=group.name,
        )
    actor = actor_of_library(group)
    kept = posture_for_library(body, postures, actor, on_floor=on_floor)[0]
    rewrite_posture_curves(entry.action, actor, kept)
    update_assets(group, [entry])
    return entry


def add_motion(
    group: bpy.types.PropertyGroup,
    name: str,
    postures: Sequence[str],
    time_s: Array,
    *,
    cyclic: bool,
) -> bpy.types.PropertyGroup:
    """Add a motion through postures of the library.

    Args:
        group: The scene's library.
        name: The motion's; a number makes it unique.
        postures: Names of the postures, in order.
        time_s: (N,) rising from 0 [s]; (N + 1,) for a cyclic motion, whose first posture comes again last.
        cyclic: Whether the first posture comes again.

    Raises:
        InputError: The name is invalid.
    """
    fault = text_fault(name.strip(), LONGEST_NAME)
    if fault:
        raise InputError("the motion's name is '{name}'; it {fault}", name=name, fault=fault)
    times = [round(float(value), DECIMALS_S) for value in time_s]
    free = unique_name(name.strip(), [motion.name for motion in group.motions])
    steps = tuple(MotionStep(posture, when) for posture, when in zip(postures, times, strict=False))
    motion = add_motion_entry(group, LibraryMotion(free, steps, times[-1], cyclic))
    group.active_motion = len(group.motions) - 1
    update_assets(group)
    return motion


def add_mirrored(group: bpy.types.PropertyGroup, *, only_chosen: bool) -> int:
    """Add the mirrored form of postures and motions that a library has for one side only.

    Args:
        group: The scene's library.
        only_chosen: Mirror only the posture chosen in its list, and no motion.

    Returns:
        How many postures were added.

    Raises:
        InputError: None is chosen, or the library's actor has sides of different lengths.
    """
    library = library_from_scene(group)
    if only_chosen:
        chosen = active_posture(group)
        if chosen is None or chosen.name not in library.by_name:
            raise InputError(
                "no posture of the library '{library}' is chosen; choose the one to mirror",
                library=group.name,
            )
        library = replace(library, postures=(library.by_name[chosen.name],), motions=())
    whole = with_mirrored(library)
    postures = whole.postures[len(library.postures) :]
    motions = whole.motions[len(library.motions) :]
    names = _add_entries(group, postures)
    now = dict(zip((posture.name for posture in postures), names, strict=True))
    for motion in motions:
        steps = tuple(replace(step, posture=now.get(step.posture, step.posture)) for step in motion.steps)
        taken = [other.name for other in group.motions]
        add_motion_entry(group, replace(motion, name=unique_name(motion.name, taken), steps=steps))
    update_assets(group)
    return len(names)


def _check(group: bpy.types.PropertyGroup, names: Sequence[str], tags: Sequence[str]) -> None:
    for name in names:
        fault = text_fault(name.strip(), LONGEST_NAME)
        if fault:
            raise InputError("the posture's name is '{name}'; it {fault}", name=name, fault=fault)
    for tag in tags:
        fault = text_fault(tag, LONGEST_TAG)
        if fault:
            raise InputError("the tag is '{tag}'; it {fault}", tag=tag, fault=fault)
    if len(postures_from_scene(group)) + len(names) > MOST_POSTURES:
        raise InputError("a library holds at most {most_postures} postures", most_postures=MOST_POSTURES)
