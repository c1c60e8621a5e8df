"""Slotted Actions, by the API that Blender 4.5 and 5.x share."""

import hashlib

import bpy
import numpy as np

SLOT = "Actor"  # name of the slot of an Action that is made for no armature in particular


def channelbag_for(
    action: bpy.types.Action, datablock: bpy.types.ID | None = None
) -> bpy.types.ActionChannelbag:
    """The F-curves of `datablock` in `action`; slot, layer, strip and bag are added where missing.

    Without a data-block, those of an empty Action that any armature may be given.
    """
    slot = None if datablock is None else slot_for(action, datablock)
    if slot is None:
        kind, name = ("OBJECT", SLOT) if datablock is None else (datablock.id_type, datablock.name)
        slot = action.slots.new(id_type=kind, name=name)
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


def curves_of(
    action: bpy.types.Action, datablock: bpy.types.ID | None = None
) -> dict[tuple[str, int], bpy.types.FCurve]:
    """The F-curves of `datablock` in `action`, by data path and array index.

    Without a data-block, those of all slots.
    """
    if datablock is None:
        bags = [bag for layer in action.layers for strip in layer.strips for bag in strip.channelbags]
    else:
        bag = existing_channelbag(action, datablock)
        bags = [] if bag is None else [bag]
    return {(curve.data_path, curve.array_index): curve for bag in bags for curve in bag.fcurves}


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


def action_of(animated: bpy.types.Object) -> bpy.types.Action | None:
    """The Action that animates an object."""
    data = animated.animation_data
    return None if data is None else data.action


def curve_digest(animated: bpy.types.Object) -> str:
    """SHA-256 of the curves that animate an object, to the last digit.

    It is the same in every run, unlike a .blend, which holds memory addresses.
    """
    action = action_of(animated)
    return hashlib.sha256().hexdigest() if action is None else action_digest(action)


def action_digest(action: bpy.types.Action) -> str:
    """SHA-256 of the curves of an Action with one slot, as `curve_digest` gives it of what it animates."""
    hashed = hashlib.sha256()
    for (path, index), curve in sorted(curves_of(action).items()):
        points = np.empty(2 * len(curve.keyframe_points), dtype="<f4")
        curve.keyframe_points.foreach_get("co", points)
        hashed.update(f"{path} {index} {len(points)}:".encode())
        hashed.update(points.tobytes())
    return hashed.hexdigest()
