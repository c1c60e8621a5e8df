"""What stands in the way of keys on a character's bones: drivers, constraints, locks, connected bones."""

from collections.abc import Iterator, Sequence

import numpy as np
from bpy.types import Object

from ....core.arrays import Array
from ....core.errors import InputError
from ....core.files.fields import listed
from ....core.keys.hermite import Spline, values_of
from ....core.retarget.controls.control_channels import Control
from ....core.retarget.controls.control_motion import ControlMotion, KeyedControl
from ....core.retarget.controls.control_plan import ControlKind
from ..rotation_modes import bone_path, rotation_path
from .controls import CARRYING, active_constraints, drivers
from .held_controls import Releases

ASTRAY = 0.003  # distance of a control from its place that is worth a note, in sizes of the character
LEFT_BEHIND = 0.03  # the same of hips that is no longer the performer's motion
ADRIFT = 0.01  # the same that random poses move a control from where its carrier has it


def driven_channels(armature_object: Object) -> set[tuple[str, int]]:
    """Data path and index of all channels that have a driver, which wins over keys."""
    return {(driver.data_path, driver.array_index) for driver in drivers(armature_object)}


def keyed_paths(keyed: KeyedControl) -> list[tuple[str, Array | Spline]]:
    """Data path of each property of a control that is keyed, and what it holds."""
    both = ((rotation_path(keyed.control.mode), keyed.rotation), ("location", keyed.location))
    return [(bone_path(keyed.control.name, channel), held) for channel, held in both if held is not None]


def channel_notes(
    armature_object: Object,
    keyed: Sequence[KeyedControl],
    motion: ControlMotion,
    scaled: Sequence[str],
    releases: Releases,
) -> tuple[str, ...]:
    """Sentences on what keeps the keyed controls from their poses, and on bones that were scaled."""
    driven = driven_channels(armature_object)
    bones = armature_object.pose.bones
    astray: dict[str, list[str]] = {"driven": [], "constrained": [], "locked": []}
    for one in keyed:
        name, bone = one.control.name, bones[one.control.name]
        channels = {(path, i) for path, held in keyed_paths(one) for i in range(values_of(held).shape[1])}
        turned = one.rotation is not None and any(bone.lock_rotation)
        moved = one.location is not None and any(bone.lock_location)
        constrained = name not in releases.bones and any(
            constraint.type not in CARRYING for constraint in active_constraints(bone)
        )
        states = (("driven", driven & channels), ("constrained", constrained), ("locked", turned or moved))
        for why, so in states:
            astray[why] += [name] * bool(so)
    notes = {
        "Drivers win over the keys of bone {}; mute them to let the motion through": astray["driven"],
        "Constraints change the keyed pose of bone {}; mute them where it goes astray": astray["constrained"],
        "Locked and keyed all the same: bone {}; unlock it to change it by hand": astray["locked"],
        "Constraints hold bone {}; the motion keys their influence at 0": releases.bones,
        "Scaled in its pose: bone {}; the motion keys its scale at 1": scaled,
        "Connected to its parent or not to be moved: bone {} stays off its place; disconnect it": [
            control.name
            for control, _, off in _off(motion)
            if not control.space.movable and off > ASTRAY * motion.size
        ],
        "Constraints follow the carriers of bone {} only in part; it may be off its place": [
            control.name
            for control, location, _ in _off(motion)
            if location is None and control.space.residual > ADRIFT * motion.size
        ],
    }
    quoted = {note: [f"'{name}'" for name in names] for note, names in notes.items() if names}
    return tuple(note.format(listed(names, 3)) for note, names in quoted.items())


def require_placed_hips(armature_object: Object, motion: ControlMotion) -> None:
    """Raise InputError where the hips cannot go where the performer goes: the body would fold up instead."""
    bones = armature_object.data.bones
    for control, _, off in _off(motion):
        fixed = control.plan.kind is ControlKind.HIPS and not control.space.movable
        if fixed and off > LEFT_BEHIND * motion.size:
            name, above = f"bone '{control.name}' of '{armature_object.name}'", bones[control.name].parent
            if bones[control.name].use_connect and above is not None:
                raise InputError(
                    f"{name} is connected to '{above.name}' and cannot go where the performer goes; "
                    "disconnect it in Edit Mode (Armature > Parent > Disconnect Bone)"
                )
            raise InputError(
                f"{name} does not move with its own location and cannot go where the performer goes; mute "
                "the driver or constraint that holds it"
            )


def _off(motion: ControlMotion) -> Iterator[tuple[Control, Array | None, float]]:
    """Each control with its location, and how far its place is from where it is wanted [units]."""
    for control, channels in zip(motion.controls, motion.channels, strict=True):
        wanted = motion.wanted[control.name][:, :3, 3]
        yield control, channels.location, float(np.linalg.norm(channels.place - wanted, axis=-1).max())
