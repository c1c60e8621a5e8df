"""What stands in the way of keys on a character's bones: drivers, constraints, locks, connected bones."""

from collections.abc import Iterable, Sequence

import bpy
import numpy as np

from ....core.arrays import Array
from ....core.finish.hermite import Spline
from ....core.retarget.controls.control_channels import Control
from ....core.retarget.controls.control_motion import ControlMotion, KeyedControl
from ..rotation_modes import bone_path, rotation_path
from .controls import active_constraints, drivers

CARRYING = ("CHILD_OF", "ARMATURE")
"""Constraints that carry a bone as a parent does: its own channels still count."""
MOST_NAMES = 3  # bones that a sentence names; more are counted
NOTICEABLE_M = 0.005
ADRIFT = 0.01
"""Distance, in sizes of the character, that random poses move a control from where its carrier has it."""


def driven_channels(armature_object: bpy.types.Object) -> set[tuple[str, int]]:
    """Data path and index of all channels that have a driver, which wins over keys."""
    return {(driver.data_path, driver.array_index) for driver in drivers(armature_object)}


def keyed_channels(keyed: KeyedControl) -> list[tuple[str, int]]:
    """Data path and index of each channel of a control that is keyed."""
    return [(path, index) for path, held in keyed_paths(keyed) for index in range(_width(held))]


def keyed_paths(keyed: KeyedControl) -> list[tuple[str, Array | Spline]]:
    """Data path of each property of a control that is keyed, and what it holds."""
    name, rotation = keyed.control.name, rotation_path(keyed.control.mode)
    both = ((bone_path(name, rotation), keyed.rotation), (bone_path(name, "location"), keyed.location))
    return [(path, held) for path, held in both if held is not None]


def _width(held: Array | Spline) -> int:
    return int((held.values if isinstance(held, Spline) else held).shape[1])


def channel_notes(
    armature_object: bpy.types.Object,
    keyed: Sequence[KeyedControl],
    motion: ControlMotion,
    scaled: Sequence[str] = (),
) -> tuple[str, ...]:
    """Sentences on what keeps the keyed controls from their poses, and on bones that were scaled."""
    driven = driven_channels(armature_object)
    bones = armature_object.pose.bones
    names = [one.control.name for one in keyed]
    constrained = [
        name for name, one in zip(names, keyed, strict=True) if _is_constrained(bones[name], one.control)
    ]
    locked = [name for name, one in zip(names, keyed, strict=True) if _is_locked(bones[name], one)]
    notes = {
        "Drivers win over the keys of bone {}; mute them to let the motion through": [
            name for name, one in zip(names, keyed, strict=True) if driven & set(keyed_channels(one))
        ],
        "Constraints change the keyed pose of bone {}; mute them where it goes astray": constrained,
        "Locked and keyed all the same: bone {}; unlock it to change it by hand": locked,
        "Scaled in its pose: bone {}; the motion keys its scale at 1": scaled,
        "Connected to its parent or not to be moved: bone {} stays off its place; disconnect it": _held_back(
            armature_object, motion
        ),
        "Constraints follow the carriers of bone {} only in part; it may be off its place": _adrift(motion),
    }
    listed = {note: _listed(bones) for note, bones in notes.items()}
    return tuple(note.format(bones) for note, bones in listed.items() if bones)


def _listed(names: Iterable[str]) -> str:
    found = list(names)
    more = f" and {len(found) - MOST_NAMES} more" if len(found) > MOST_NAMES else ""
    return ", ".join(f"'{name}'" for name in found[:MOST_NAMES]) + more


def _is_constrained(bone: bpy.types.PoseBone, control: Control) -> bool:
    return any(constraint.type not in CARRYING for constraint in active_constraints(bone))


def _is_locked(bone: bpy.types.PoseBone, keyed: KeyedControl) -> bool:
    turned = keyed.rotation is not None and any(bone.lock_rotation)
    return bool(turned or (keyed.location is not None and any(bone.lock_location)))


def _held_back(armature_object: bpy.types.Object, motion: ControlMotion) -> list[str]:
    """Controls that cannot be moved and are off their places."""
    found = []
    for control, channels in zip(motion.controls, motion.channels, strict=True):
        off = np.linalg.norm(channels.place - motion.wanted[control.name][:, :3, 3], axis=-1).max()
        if not control.space.movable and motion.scale * off > NOTICEABLE_M:
            found.append(control.name)
    return found


def _adrift(motion: ControlMotion) -> list[str]:
    """Controls of whose places no other control can tell, and that cannot be moved to them."""
    return [
        control.name
        for control, channels in zip(motion.controls, motion.channels, strict=True)
        if channels.location is None and control.space.residual > ADRIFT * motion.size
    ]
