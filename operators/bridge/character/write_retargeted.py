"""Write a retargeted motion into an Action; of what is there, only what an earlier retargeting made goes."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import bpy
import numpy as np

from ....core.arrays import Array
from ....core.finish.hermite import Spline
from ....core.retarget.controls.control_motion import KeyedControl
from ..actions import channelbag_for
from ..keys import ensure_fcurve, write_linear_keys, write_smooth_keys
from ..rotation_modes import ALL_PATHS, bone_path
from .controls.channel_notes import driven_channels, keyed_paths
from .controls.posing import Property, Value
from .controls.property_paths import property_path
from .object_placement import PlacementKeys
from .pose_scales import ONE

MADE_BY_KEYMARK = "keymark_retargeted"
"""Custom property of an Action: which curves of which slot retargeting made, as JSON."""
OBJECT_GROUP = "Object Transforms"
"""Blender's own name for the group of an object's channels."""


@dataclass(frozen=True, eq=False)
class RetargetedKeys:
    """All that is keyed of a character's motion."""

    frames: Array
    """(F,) scene frames."""
    controls: tuple[KeyedControl, ...]
    properties: Mapping[Property, Value]
    """Custom properties that are keyed at the first frame."""
    placement: PlacementKeys
    """The object's channels that are keyed at the first frame."""
    scaled: tuple[str, ...] = ()
    """Bones whose scale is keyed at one, but where curves or drivers give them a scale."""

    @property
    def key_count(self) -> int:
        """Number of keys on the controls."""
        return sum(keyed.key_count for keyed in self.controls)

    @property
    def dense_count(self) -> int:
        """Number of keys on the controls with one on every frame."""
        return sum(keyed.channel_count for keyed in self.controls) * len(self.frames)


def write_keys(keys: RetargetedKeys, armature_object: bpy.types.Object, action: bpy.types.Action) -> None:
    """Write the keys into an Action, which is not assigned."""
    channelbag = channelbag_for(action, armature_object)
    _remove_made(action, channelbag)
    _remove_channels(channelbag, [keyed.control.name for keyed in keys.controls])
    driven, frames = driven_channels(armature_object), keys.frames
    made: list[tuple[str, int]] = []
    for keyed in keys.controls:
        for path, held in keyed_paths(keyed):
            values = held.values if isinstance(held, Spline) else held
            for index in range(values.shape[1]):
                if (path, index) in driven:
                    continue
                fcurve = ensure_fcurve(channelbag, path, index, keyed.control.name)
                if isinstance(held, Spline):
                    write_smooth_keys(fcurve, frames[held.keys], values[:, index], held.slopes[:, index])
                else:
                    write_linear_keys(fcurve, frames, values[:, index])
                made.append((path, index))
    for (bone, name), value in keys.properties.items():
        path = property_path(bone, name)
        made.append(_write_first(channelbag, path, 0, bone, frames, float(value)))
    for name in keys.scaled:
        path = bone_path(name, "scale")
        for index, value in enumerate(ONE):
            if (path, index) not in driven and channelbag.fcurves.find(path, index=index) is None:
                made.append(_write_first(channelbag, path, index, name, frames, value))
    for path, values in keys.placement:
        for index, value in enumerate(values):
            made.append(_write_first(channelbag, path, index, OBJECT_GROUP, frames, float(value)))
    _remember_made(action, channelbag, made)
    action.use_frame_range = True
    action.frame_start, action.frame_end = float(frames[0]), float(frames[-1])


def _write_first(
    channelbag: bpy.types.ActionChannelbag, path: str, index: int, group: str, frames: Array, value: float
) -> tuple[str, int]:
    """Key a property at the first frame alone, which holds for all."""
    fcurve = ensure_fcurve(channelbag, path, index, group)
    write_linear_keys(fcurve, frames[:1], np.array([value]))
    return path, index


def _remove_made(action: bpy.types.Action, channelbag: bpy.types.ActionChannelbag) -> None:
    """Remove the curves that an earlier retargeting made in a slot."""
    for path, index in _made(action).get(channelbag.slot.identifier, []):
        fcurve = channelbag.fcurves.find(path, index=index)
        if fcurve is not None:
            channelbag.fcurves.remove(fcurve)


def _remove_channels(channelbag: bpy.types.ActionChannelbag, bones: Iterable[str]) -> None:
    """Remove curves, of whatever rotation mode, of the bones that are to be keyed."""
    paths = {bone_path(bone, channel) for bone in bones for channel in (*ALL_PATHS, "location")}
    for fcurve in [curve for curve in channelbag.fcurves if curve.data_path in paths]:
        channelbag.fcurves.remove(fcurve)


def _remember_made(
    action: bpy.types.Action, channelbag: bpy.types.ActionChannelbag, made: list[tuple[str, int]]
) -> None:
    action[MADE_BY_KEYMARK] = json.dumps(_made(action) | {channelbag.slot.identifier: made})


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
