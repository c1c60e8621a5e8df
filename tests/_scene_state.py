"""The state of a .blend as plain values by name, rounded to what a person can tell apart."""

import hashlib
from collections.abc import Callable, Iterable
from typing import Any

import bpy
import numpy as np

State = dict[str, Any]
DIGITS = 4


def scene_state() -> State:
    """Everything that Keymark may change, of every scene, object, Action and clip."""
    state: State = {}
    for scene in bpy.data.scenes:
        name = f"scene {scene.name}"
        state[f"{name} range"] = (scene.frame_start, scene.frame_end, scene.frame_current)
        state[f"{name} rate"] = round(scene.render.fps / scene.render.fps_base, DIGITS)
        state[f"{name} size"] = (scene.render.resolution_x, scene.render.resolution_y)
        state[f"{name} shows"] = (_name(scene.camera), _name(scene.active_clip))
        _add_group(state, f"{name} keymark", scene.keymark)
    for blender_object in bpy.data.objects:
        _add_object(state, blender_object)
    for action in bpy.data.actions:
        _add_action(state, action)
    for clip in bpy.data.movieclips:
        lens = clip.tracking.camera
        state[f"clip {clip.name}"] = (clip.filepath, clip.frame_start, clip.frame_offset)
        state[f"clip {clip.name} lens"] = _rounded((lens.focal_length, lens.sensor_width, lens.k1, lens.k2))
    for collection in bpy.data.collections:
        state[f"collection {collection.name}"] = sorted(item.name for item in collection.all_objects)
    return state


def differences(before: State, after: State) -> str:
    """The differences between two states, one clause each; empty if there are none."""
    names = sorted(before.keys() | after.keys())
    differing = [name for name in names if before.get(name) != after.get(name)]
    return "; ".join(f"{name}: {before.get(name)} became {after.get(name)}" for name in differing)[:1000]


def assert_undoable(steps: Iterable[tuple[str, Callable[[], object]]]) -> None:
    """Hold that every step, by its name, changes something, is undone by one undo and redone by one redo."""
    bpy.ops.ed.undo_push(message="Begin")
    for name, do in steps:
        before = scene_state()
        do()
        bpy.context.view_layer.update()
        bpy.ops.ed.undo_push(message=name)
        after = scene_state()
        assert after != before, f"{name} changed nothing"
        bpy.ops.ed.undo()
        assert not differences(before, scene_state()), f"undoing {name}"
        bpy.ops.ed.redo()
        assert not differences(after, scene_state()), f"redoing {name}"


def _add_group(state: State, name: str, group: bpy.types.bpy_struct) -> None:
    """Every property of a group of properties, the groups in it included."""
    for definition in group.bl_rna.properties:
        key = definition.identifier
        if key == "rna_type":
            continue
        value = getattr(group, key)
        if definition.type == "COLLECTION":
            state[f"{name}.{key}"] = len(value)
            for number, item in enumerate(value):
                _add_group(state, f"{name}.{key}[{number}]", item)
        elif definition.type == "POINTER" and isinstance(value, bpy.types.PropertyGroup):
            _add_group(state, f"{name}.{key}", value)
        elif definition.type == "POINTER":
            state[f"{name}.{key}"] = _name(value)
        else:
            state[f"{name}.{key}"] = _rounded(value)


def _add_object(state: State, blender_object: bpy.types.Object) -> None:
    name = f"object {blender_object.name}"
    data = blender_object.animation_data
    state[name] = (blender_object.type, _name(blender_object.data), _name(blender_object.parent))
    state[f"{name} matrix"] = _rounded(np.array(blender_object.matrix_world).ravel())
    state[f"{name} action"] = _name(data.action) if data else None
    if blender_object.type == "CAMERA":
        lens = blender_object.data
        state[f"{name} lens"] = _rounded((lens.lens, lens.sensor_width, lens.shift_x, lens.shift_y))
    if blender_object.type == "ARMATURE":
        for bone in blender_object.data.bones:
            state[f"{name} bone {bone.name}"] = _rounded((*bone.head_local, *bone.tail_local))
        if data is None or data.action is None:  # else Blender's own undo gives what the Action says
            for bone in blender_object.pose.bones:
                state[f"{name} pose {bone.name}"] = _rounded(np.array(bone.matrix_basis).ravel())


def _add_action(state: State, action: bpy.types.Action) -> None:
    name = f"action {action.name}"
    tags = sorted(tag.name for tag in action.asset_data.tags) if action.asset_data else None
    state[name] = (action.use_fake_user, [slot.identifier for slot in action.slots], tags)
    for layer in action.layers:
        for strip in layer.strips:
            for bag in strip.channelbags:
                for curve in bag.fcurves:
                    state[f"{name} {curve.data_path}[{curve.array_index}]"] = _curve(curve)


def _curve(curve: bpy.types.FCurve) -> tuple[int, str]:
    """Number of keys, and a digest of their positions and types."""
    keys = np.empty(2 * len(curve.keyframe_points), dtype=np.float32)
    kinds = np.empty(len(curve.keyframe_points), dtype=np.int32)
    curve.keyframe_points.foreach_get("co", keys)
    curve.keyframe_points.foreach_get("type", kinds)
    said = np.round(keys, DIGITS).tobytes() + kinds.tobytes()
    return len(curve.keyframe_points), hashlib.sha256(said).hexdigest()[:12]


def _name(item: Any) -> str | None:
    return None if item is None else str(item.name)


def _rounded(value: Any) -> Any:
    if isinstance(value, float):
        return round(value, DIGITS) + 0.0
    if isinstance(value, str | int | bool | set | frozenset) or value is None:
        return value
    return tuple(_rounded(part if isinstance(part, int | str) else float(part)) for part in value)
