"""Slotted Actions, by the API that Blender 4.5 and 5.x share."""

import hashlib
from collections.abc import Iterable

import bpy
import numpy as np

SLOT = "Actor"  # name of the slot of an Action that is made for no armature in particular


def new_channelbag(action: bpy.types.Action) -> bpy.types.ActionChannelbag:
    """The F-curves of an empty Action that any armature may be given."""
    slot = action.slots.new(id_type="OBJECT", name=SLOT)
    return action.layers.new("Layer").strips.new(type="KEYFRAME").channelbag(slot, ensure=True)


def channelbag_for(action: bpy.types.Action, datablock: bpy.types.ID) -> bpy.types.ActionChannelbag:
    """The F-curves of `datablock` in `action`; slot, layer, strip and bag are added where missing."""
    slot = slot_for(action, datablock)
    if slot is None:
        slot = action.slots.new(id_type=datablock.id_type, name=datablock.name)
    layer = action.layers[0] if action.layers else action.layers.new("Layer")
    strip = layer.strips[0] if layer.strips else layer.strips.new(type="KEYFRAME")
    return strip.channelbag(slot, ensure=True)


def existing_channelbag(
    action: bpy.types.Action, datablock: bpy.types.ID
) -> bpy.types.ActionChannelbag | None:
    """The F-curves of `datablock` in `action`, or None where it has none."""
    slot = slot_for(action, datablock)
    if slot is None or not action.layers or not action.layers[0].strips:
        return None
    return action.layers[0].strips[0].channelbag(slot)


def slot_for(action: bpy.types.Action, datablock: bpy.types.ID) -> bpy.types.ActionSlot | None:
    """The slot that animates `datablock`: the one in use, else the one of its name, else the only one."""
    suitable = [slot for slot in action.slots if slot.target_id_type in (datablock.id_type, "UNSPECIFIED")]
    data = datablock.animation_data
    if data is not None and data.action == action and data.action_slot is not None:
        return data.action_slot
    named = [slot for slot in suitable if slot.name_display == datablock.name]
    if named:
        return named[0]
    return suitable[0] if len(suitable) == 1 else None


def assign_action(datablock: bpy.types.ID, action: bpy.types.Action) -> None:
    """Let `action` animate `datablock`, with its slot: without one nothing would move."""
    slot = slot_for(action, datablock)
    data = datablock.animation_data_create()
    data.action = action
    if slot is not None:
        data.action_slot = slot


def curve_digest(animated: bpy.types.Object) -> str:
    """SHA-256 of the curves that animate an object, to the last digit.

    It is the same in every run, unlike a .blend, which holds memory addresses.
    """
    animation = animated.animation_data
    action = None if animation is None else animation.action
    bag = None if action is None else existing_channelbag(action, animated)
    return _digest(() if bag is None else bag.fcurves)


def action_digest(action: bpy.types.Action) -> str:
    """SHA-256 of the curves of an Action with one slot, as `curve_digest` gives it of what it animates."""
    strips = action.layers[0].strips if action.layers else ()
    bags = [bag for strip in strips for bag in strip.channelbags]
    return _digest([curve for bag in bags for curve in bag.fcurves])


def _digest(curves: Iterable[bpy.types.FCurve]) -> str:
    hashed = hashlib.sha256()
    for curve in sorted(curves, key=lambda curve: (curve.data_path, curve.array_index)):
        points = np.empty(2 * len(curve.keyframe_points), dtype="<f4")
        curve.keyframe_points.foreach_get("co", points)
        hashed.update(f"{curve.data_path} {curve.array_index} {len(points)}:".encode())
        hashed.update(points.tobytes())
    return hashed.hexdigest()
