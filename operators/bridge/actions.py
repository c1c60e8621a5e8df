"""Slotted Actions, by the API that Blender 4.5 and 5.x share."""

import hashlib

import numpy as np
from bpy.types import ID, Action, ActionChannelbag, ActionSlot, FCurve, Object


def channelbag_for(action: Action, datablock: ID | None = None) -> ActionChannelbag:
    """The F-curves of `datablock` in `action`, else of any armature; slot, layer, strip and bag are added."""
    slot = None if datablock is None else slot_for(action, datablock)
    if slot is None:
        kind, name = ("OBJECT", "Actor") if datablock is None else (datablock.id_type, datablock.name)
        slot = action.slots.new(id_type=kind, name=name)
    layer = action.layers[0] if action.layers else action.layers.new("Layer")
    strip = layer.strips[0] if layer.strips else layer.strips.new(type="KEYFRAME")
    return strip.channelbag(slot, ensure=True)


def existing_channelbag(action: Action, datablock: ID) -> ActionChannelbag | None:
    """The F-curves of `datablock` in `action`, or None where it has none."""
    slot = slot_for(action, datablock)
    strips = action.layers[0].strips if action.layers else ()
    return strips[0].channelbag(slot) if strips and slot is not None else None


def curves_of(action: Action, datablock: ID | None = None) -> dict[tuple[str, int], FCurve]:
    """The F-curves of `datablock` in `action`, or else of all slots, by data path and array index."""
    bags = [bag for layer in action.layers for strip in layer.strips for bag in strip.channelbags]
    if datablock is not None:
        bag = existing_channelbag(action, datablock)
        bags = [] if bag is None else [bag]
    return {(curve.data_path, curve.array_index): curve for bag in bags for curve in bag.fcurves}


def slot_for(action: Action, datablock: ID) -> ActionSlot | None:
    """The slot that animates `datablock`: the one in use, else the one of its name, else the only one."""
    data = datablock.animation_data
    if data is not None and data.action == action and data.action_slot is not None:
        return data.action_slot
    suitable = [slot for slot in action.slots if slot.target_id_type in (datablock.id_type, "UNSPECIFIED")]
    named = [slot for slot in suitable if slot.name_display == datablock.name]
    return named[0] if named else suitable[0] if len(suitable) == 1 else None


def assign_action(datablock: ID, action: Action) -> None:
    """Let `action` animate `datablock`, with its slot: without one nothing would move."""
    slot = slot_for(action, datablock)
    data = datablock.animation_data_create()
    data.action = action
    if slot is not None:
        data.action_slot = slot


def action_of(animated: Object) -> Action | None:
    """The Action that animates an object."""
    data = animated.animation_data
    return None if data is None else data.action


def curve_digest(animated: Object) -> str:
    """SHA-256 of the curves that animate an object, the same in every run, unlike a .blend's."""
    action = action_of(animated)
    return hashlib.sha256().hexdigest() if action is None else action_digest(action)


def action_digest(action: Action) -> str:
    """SHA-256 of the curves of an Action with one slot, as `curve_digest` gives it of what it animates."""
    hashed = hashlib.sha256()
    for (path, index), curve in sorted(curves_of(action).items()):
        points = np.empty(2 * len(curve.keyframe_points), dtype="<f4")
        curve.keyframe_points.foreach_get("co", points)
        hashed.update(f"{path} {index} {len(points)}:".encode())
        hashed.update(points.tobytes())
    return hashed.hexdigest()
