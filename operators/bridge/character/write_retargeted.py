"""A retargeted motion as keys of an Action: controls, properties, scales, and where the object stands."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Quaternion

from ....core.arrays import Array
from ....core.errors import InputError
from ....core.keys.hermite import values_of
from ....core.retarget.character import Similarity
from ....core.retarget.controls.control_motion import KeyedControl
from ..actions import channelbag_for
from ..keys import ensure_fcurve, write_column, write_linear_keys
from ..object_space import evaluated
from ..rotation_modes import ALL_PATHS, bone_path, rotation_path, rotation_values
from ..scene_frames import at_scene_frame
from .channel_notes import driven_channels, keyed_paths
from .controls import Property, Value, drivers, property_path
from .held_controls import Held, influence_path

ONE = (1.0, 1.0, 1.0)


def scaled_bones(armature_object: bpy.types.Object, names: Iterable[str]) -> tuple[str, ...]:
    """The bones, and those above them, that are scaled now."""
    found: dict[str, None] = {}
    for name in names:
        bone = armature_object.pose.bones[name]
        for one in (bone, *bone.parent_recursive):
            if max(abs(value - 1.0) for value in one.scale) > 1e-3:
                found[one.name] = None
    return tuple(found)


# --- Where an armature object stands, as channels that an Action may hold


PlacementKeys = tuple[tuple[str, Array], ...]
"""Data paths of the object's channels with their values (1, C), or (F, C) where what carries it moves."""


def carriers(armature_object: bpy.types.Object, frames: Array) -> Array:
    """(F, 4, 4) what carries an object at scene frames (F,), its parents in motion; (1, 4, 4) if still.

    Raises:
        InputError: Its parent changes its scale meanwhile, or shears it.
    """
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


def placement_keys(armature_object: bpy.types.Object, above: Array, to_world: Similarity) -> PlacementKeys:
    """The object's location and rotation, in its rotation mode and on its `carriers`, to stand somewhere."""
    world, mode = np.eye(4), armature_object.rotation_mode
    world[:3, :3], world[:3, 3] = to_world.rotation, to_world.location
    basis = np.linalg.inv(above) @ world
    turn = basis[:, :3, :3] / np.linalg.norm(basis[:, :3, :3], axis=1, keepdims=True)
    if mode == "QUATERNION":
        turn = _matrix(armature_object.delta_rotation_quaternion).T @ turn
    elif mode != "AXIS_ANGLE":  # whose own delta nobody can set
        turn = _matrix(armature_object.delta_rotation_euler.to_quaternion()).T @ turn
    location = basis[:, :3, 3] - np.array(armature_object.delta_location)
    return (("location", location), (rotation_path(mode), rotation_values(turn, mode)))


def _matrix(turn: Quaternion) -> Array:
    return np.array(turn.normalized().to_matrix(), dtype=np.float64)


def require_placeable(armature_object: bpy.types.Object) -> None:
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


# --- Write a retargeted motion into an Action


MADE_BY_KEYMARK = "keymark_retargeted"
"""Custom property of an Action: which curves of which slot retargeting made, as JSON."""
OBJECT_GROUP = "Object Transforms"  # Blender's own name for the group of an object's channels


@dataclass(frozen=True, eq=False)
class RetargetedKeys:
    """All that is keyed of a character's motion."""

    frames: Array  # (F,) scene frames
    controls: tuple[KeyedControl, ...]
    properties: Mapping[Property, Value]  # custom properties that are keyed at the first frame
    placement: PlacementKeys
    scaled: tuple[str, ...] = ()
    """Bones whose scale is keyed at one, but where curves or drivers give them a scale."""
    released: tuple[Held, ...] = ()
    """Constraints whose influence is keyed at zero at the first frame."""

    @property
    def key_count(self) -> int:
        """Number of keys on the controls."""
        return sum(values.size for keyed in self.controls for values in keyed.values)

    @property
    def dense_count(self) -> int:
        """Number of keys on the controls with one on every frame."""
        return sum(values.shape[1] for keyed in self.controls for values in keyed.values) * len(self.frames)


def write_keys(keys: RetargetedKeys, armature_object: bpy.types.Object, action: bpy.types.Action) -> None:
    """Write the keys into an Action, which is not assigned."""
    channelbag = channelbag_for(action, armature_object)
    before = _made(action)
    names = [keyed.control.name for keyed in keys.controls]
    paths = {bone_path(name, channel) for name in names for channel in (*ALL_PATHS, "location")}
    gone = before.get(channelbag.slot.identifier, [])  # and what a bone has in another rotation mode
    curves = [(curve, (curve.data_path, curve.array_index)) for curve in channelbag.fcurves]
    for fcurve in [curve for curve, own in curves if own[0] in paths or own in gone]:
        channelbag.fcurves.remove(fcurve)
    driven, frames = driven_channels(armature_object), keys.frames
    made: list[tuple[str, int]] = []
    for keyed in keys.controls:
        for path, held in keyed_paths(keyed):
            for index in range(values_of(held).shape[1]):
                if (path, index) in driven:
                    continue
                fcurve = ensure_fcurve(channelbag, path, index, keyed.control.name)
                write_column(fcurve, frames, held, index)
                made.append((path, index))
    for (bone, name), value in keys.properties.items():
        path = property_path(bone, name)
        made.append(_write_first(channelbag, path, 0, bone, frames, float(value)))
    for name in keys.scaled:
        path = bone_path(name, "scale")
        for index, value in enumerate(ONE):
            if (path, index) not in driven and channelbag.fcurves.find(path, index=index) is None:
                made.append(_write_first(channelbag, path, index, name, frames, value))
    for constraint in keys.released:
        path = influence_path(armature_object, constraint)
        made.append(_write_first(channelbag, path, 0, constraint[0], frames, 0.0))
    for path, values in keys.placement:
        for index, column in enumerate(values.T):
            fcurve = ensure_fcurve(channelbag, path, index, OBJECT_GROUP)
            write_linear_keys(fcurve, frames[: len(column)], column)
            made.append((path, index))
    action[MADE_BY_KEYMARK] = json.dumps(before | {channelbag.slot.identifier: made})
    action.use_frame_range = True
    action.frame_start, action.frame_end = float(frames[0]), float(frames[-1])


def _write_first(
    channelbag: bpy.types.ActionChannelbag, path: str, index: int, group: str, frames: Array, value: float
) -> tuple[str, int]:
    """Key a property at the first frame alone, which holds for all."""
    fcurve = ensure_fcurve(channelbag, path, index, group)
    write_linear_keys(fcurve, frames[:1], np.array([value]))
    return path, index


def _made(action: bpy.types.Action) -> dict[str, list[tuple[str, int]]]:
    """Data paths and indices by slot; none where the property is not Keymark's."""
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
