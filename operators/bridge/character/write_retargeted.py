"""What stands in the way of keys on a character's bones: drivers, constraints, locks, connected bones."""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.types import Action, Object

from ....core.arrays import Array
from ....core.errors import InputError
from ....core.files.fields import listed
from ....core.keys.hermite import Spline, values_of
from ....core.retarget.character import Similarity
from ....core.retarget.controls.control_channels import Control, ControlKind
from ....core.retarget.controls.control_motion import ControlMotion, KeyedControl
from ..actions import channelbag_for
from ..actor_bones import evaluated
from ..keys import ensure_fcurve, write_column, write_linear_keys
from ..rotation_modes import ALL_PATHS, bone_path, rotation_path, rotation_values
from ..scene_frames import at_scene_frame
from . import held_controls
from .held_controls import Held, Property, Releases, Value, active_constraints, drivers

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
            constraint.type not in held_controls.CARRYING for constraint in active_constraints(bone)
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


# --- A retargeted motion as keys of an Action: controls, properties, scales, and where the object stands


ONE = (1.0, 1.0, 1.0)


def scaled_bones(armature_object: Object, names: Iterable[str]) -> tuple[str, ...]:
    """The bones, and those above them, that are scaled now."""
    bones = [armature_object.pose.bones[name] for name in names]
    chains = [one for bone in bones for one in (bone, *bone.parent_recursive)]
    scaled = [one.name for one in chains if max(abs(value - 1.0) for value in one.scale) > 1e-3]
    return tuple(dict.fromkeys(scaled))


PlacementKeys = tuple[tuple[str, Array], ...]  # an object's channels, (1, C) or (F, C) where it is carried


def carriers(armature_object: Object, frames: Array) -> Array:
    """(F, 4, 4) what carries an object at scene frames (F,), never changing its scale; (1, 4, 4) if still."""
    parent = armature_object.parent
    if parent is None:
        return np.eye(4)[None]
    scene, found = next(iter(armature_object.users_scene), bpy.context.scene), []
    with at_scene_frame(scene) as go_to:
        for frame in frames:
            go_to(frame)
            shown = evaluated(armature_object)
            found.append(np.array(shown.matrix_world) @ np.linalg.inv(np.array(shown.matrix_basis)))
    above = np.array(found, dtype=np.float64)
    squared = np.swapaxes(above[:, :3, :3], -1, -2) @ above[:, :3, :3]
    if np.ptp(squared, axis=0).max() > 1e-4 * squared.max():
        raise InputError(
            f"armature '{armature_object.name}' hangs on '{parent.name}', whose scale changes meanwhile; "
            "clear its parent (Alt P), or give that one scale"
        )
    moves = np.ptp(above, axis=0).max() > 1e-6 * max(1.0, float(np.abs(above).max()))
    return above if moves else above[:1]


def placement_keys(armature_object: Object, above: Array, to_world: Similarity) -> PlacementKeys:
    """The object's location and rotation, in its rotation mode and on its `carriers`, to stand somewhere."""
    world, mode = np.eye(4), armature_object.rotation_mode
    world[:3, :3], world[:3, 3] = to_world.rotation, to_world.location
    basis = np.linalg.inv(above) @ world
    turn = basis[:, :3, :3] / np.linalg.norm(basis[:, :3, :3], axis=1, keepdims=True)
    if mode != "AXIS_ANGLE":  # whose own delta nobody can set
        euler = armature_object.delta_rotation_euler.to_quaternion()
        delta = armature_object.delta_rotation_quaternion if mode == "QUATERNION" else euler
        turn = np.array(delta.normalized().to_matrix(), dtype=np.float64).T @ turn
    location = basis[:, :3, 3] - np.array(armature_object.delta_location)
    return (("location", location), (rotation_path(mode), rotation_values(turn, mode)))


def require_placeable(armature_object: Object) -> None:
    """Raise InputError where constraints or drivers decide where an object stands."""
    name = armature_object.name
    working = [one.name for one in armature_object.constraints if not one.mute and one.influence > 0.0]
    if working:
        raise InputError(
            f"armature '{name}' stands where its constraint '{working[0]}' puts it; mute it, or let the "
            "motion begin where the character stands"
        )
    paths = [one.data_path for one in drivers(armature_object)]
    driven = [path for path in paths if path in ("location", *ALL_PATHS)]
    if driven:
        raise InputError(
            f"armature '{name}' has a driver on '{driven[0]}', which wins over keys; mute it, "
            "or let the motion begin where the character stands"
        )


MADE_BY_KEYMARK = "keymark_retargeted"  # an Action's property: which curves of which slot were made, as JSON


@dataclass(frozen=True, eq=False)
class RetargetedKeys:
    """All that is keyed of a character's motion."""

    frames: Array  # (F,) scene frames
    controls: tuple[KeyedControl, ...]
    properties: Mapping[Property, Value]  # custom properties that are keyed at the first frame
    placement: PlacementKeys
    scaled: tuple[str, ...] = ()  # bones whose scale is keyed at one, but where curves or drivers give one
    released: tuple[Held, ...] = ()  # constraints whose influence is keyed at zero at the first frame


def write_keys(keys: RetargetedKeys, armature_object: Object, action: Action) -> None:
    """Write the keys into an Action, which is not assigned."""
    channelbag = channelbag_for(action, armature_object)
    before = _made(action)
    names = [keyed.control.name for keyed in keys.controls]
    paths = {bone_path(name, channel) for name in names for channel in (*ALL_PATHS, "location")}
    gone = before.get(channelbag.slot.identifier, [])  # and what a bone has in another rotation mode
    curves = [(curve, (curve.data_path, curve.array_index)) for curve in channelbag.fcurves]
    for fcurve in [curve for curve, own in curves if own[0] in paths or own in gone]:
        channelbag.fcurves.remove(fcurve)
    driven, frames, bones = driven_channels(armature_object), keys.frames, armature_object.pose.bones
    made: list[tuple[str, int]] = []

    def write(path: str, index: int, group: str, column: Array) -> None:
        """Key a channel at the first frames; one at the first alone holds for all."""
        write_linear_keys(ensure_fcurve(channelbag, path, index, group), frames[: len(column)], column)
        made.append((path, index))

    for keyed in keys.controls:
        for path, held in keyed_paths(keyed):
            for index in range(values_of(held).shape[1]):
                if (path, index) not in driven:
                    fcurve = ensure_fcurve(channelbag, path, index, keyed.control.name)
                    write_column(fcurve, frames, held, index)
                    made.append((path, index))
    for (bone, name), value in keys.properties.items():
        write(held_controls.property_path(bone, name), 0, bone or "Properties", np.array([float(value)]))
    for name in keys.scaled:
        path = bone_path(name, "scale")
        for index, value in enumerate(ONE):
            if (path, index) not in driven and channelbag.fcurves.find(path, index=index) is None:
                write(path, index, name, np.array([value]))
    for bone, name in keys.released:
        write(str(bones[bone].constraints[name].path_from_id("influence")), 0, bone, np.zeros(1))
    for path, values in keys.placement:
        for index, column in enumerate(values.T):
            write(path, index, "Object Transforms", column)
    action[MADE_BY_KEYMARK] = json.dumps(before | {channelbag.slot.identifier: made})
    action.use_frame_range = True
    action.frame_start, action.frame_end = float(frames[0]), float(frames[-1])


def _made(action: Action) -> dict[str, list[tuple[str, int]]]:
    try:
        value = json.loads(action.get(MADE_BY_KEYMARK, "{}"))
    except (TypeError, ValueError):
        return {}
    if not isinstance(value, dict):
        return {}
    return {
        slot: [(str(path), int(index)) for path, index in curves]
        for slot, curves in value.items()
        if isinstance(curves, list) and all(isinstance(one, list) and len(one) == 2 for one in curves)
    }
