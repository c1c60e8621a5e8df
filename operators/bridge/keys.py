"""Keys on F-curves, in bulk. Keymark's own are told from the animator's by Blender's key type.

Only keys of the type GENERATED are ever replaced or removed, and of these not the ones that the animator has
given another value: Blender leaves their type as it was. `back`, a number which only the interpolation of
that name uses, holds the value that a key was made with, so that a changed key is recognized. `amplitude`
marks the keys of a found keyframe, which stands beside the animator's own, and those of one that the
animator put right in the picture alone.
"""

from collections.abc import Iterable, Iterator

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.arrays import Array, BoolArray, SingleArray

Keys = dict[str, NDArray[np.generic]]  # properties of N keys by name: (N,), or (N, 2) for coordinates

UNMARKED = 0.0  # `back` of a key without a record of its first value, as earlier versions made all
MATCH_AMPLITUDE = -1.0  # `amplitude` of the keys of a found keyframe; users cannot set one below zero
PICTURE_AMPLITUDE = -2.0  # `amplitude` of the animator's keys whose depth is as it was found
SAME_FRAME = 1e-3  # keys nearer than this [frames] lie on the same frame
FLOATS = ("back", "amplitude", "period")
PAIRS = ("co", "handle_left", "handle_right")
ENUMS = ("interpolation", "easing", "handle_left_type", "handle_right_type", "type")
FLAGS = ("select_control_point", "select_left_handle", "select_right_handle")


def _generated(keys: Keys) -> BoolArray:
    """(N,) which keys are Keymark's and have the values it gave them."""
    back = keys["back"]
    changed = (back != _value_mark(keys)) & (back != UNMARKED)
    changed &= keys["interpolation"] != _enum_value("interpolation", "BACK")
    return (keys["type"] == _enum_value("type", "GENERATED")) & ~changed


def _value_mark(keys: Keys) -> SingleArray:
    """(N,) `back` of keys that records their present values."""
    values = keys["co"][:, 1].astype(np.float32)
    return np.where(values == UNMARKED, np.float32(1e-30), values)


def _as_generated(keys: Keys) -> Keys:
    """The keys as Keymark's own."""
    used = keys["interpolation"] == _enum_value("interpolation", "BACK")
    return {
        **keys,
        "type": np.full(len(used), _enum_value("type", "GENERATED"), np.int32),
        "back": np.where(used, keys["back"], _value_mark(keys)).astype(np.float32),
    }


def _as_animators(keys: Keys) -> Keys:
    """The keys as the animator's: none is of the type GENERATED."""
    types, generated = keys["type"], _enum_value("type", "GENERATED")
    plain = np.where(types == generated, _enum_value("type", "KEYFRAME"), types).astype(np.int32)
    return {**keys, "type": plain}


def _enum_value(name: str, item: str) -> int:
    return int(bpy.types.Keyframe.bl_rna.properties[name].enum_items[item].value)


def _read_keys(fcurve: bpy.types.FCurve) -> Keys:
    """Every property of every key: (N,) or, for pairs, (N, 2)."""
    points = fcurve.keyframe_points
    keys: Keys = {}
    for name in (*PAIRS, *FLOATS, *ENUMS, *FLAGS):
        values = np.empty(
            len(points) * (2 if name in PAIRS else 1),
            np.bool_ if name in FLAGS else np.int32 if name in ENUMS else np.float32,
        )
        points.foreach_get(name, values)
        keys[name] = values.reshape(-1, 2) if name in PAIRS else values
    return keys


def _write_keys(fcurve: bpy.types.FCurve, keys: Keys) -> None:
    points = fcurve.keyframe_points
    points.clear()
    points.add(len(keys["co"]))
    # Handle types come before handles: setting a type moves the handles.
    for name in (*ENUMS, *FLOATS, *PAIRS, *FLAGS):
        points.foreach_set(name, keys[name].ravel())
    fcurve.update()


def _new_keys(frames: Array, values: Array, key_type: str, interpolation: str) -> Keys:
    """Keys that are not selected, so that what the animator does next does not move them."""
    count = len(frames)
    coordinates = np.column_stack([frames, values]).astype(np.float32)
    keys: Keys = {name: coordinates.copy() for name in PAIRS}
    for name in FLOATS:
        default = bpy.types.Keyframe.bl_rna.properties[name].default
        keys[name] = np.full(count, default, np.float32)
    for name in FLAGS:
        keys[name] = np.zeros(count, np.bool_)
    chosen = {
        "interpolation": interpolation,
        "easing": "AUTO",
        "handle_left_type": "AUTO_CLAMPED",
        "handle_right_type": "AUTO_CLAMPED",
        "type": key_type,
    }
    for name, item in chosen.items():
        keys[name] = np.full(count, _enum_value(name, item), np.int32)
    return keys


def animator_frames(fcurve: bpy.types.FCurve) -> Array:
    """Frames (N,) of the keys that are not GENERATED, and of those of found keyframes."""
    # Read as little as possible: the timeline's draw function asks for all of an armature's curves.
    points = fcurve.keyframe_points
    coordinates, types = np.empty((len(points), 2), np.float32), np.empty(len(points), np.int32)
    points.foreach_get("co", coordinates.ravel())
    points.foreach_get("type", types)
    counted = types != _enum_value("type", "GENERATED")
    if not counted.all():
        amplitudes = np.empty(len(points), np.float32)
        points.foreach_get("amplitude", amplitudes)
        counted |= amplitudes == MATCH_AMPLITUDE
    return np.asarray(coordinates[counted, 0], dtype=np.float64)


def picture_frames(fcurve: bpy.types.FCurve) -> Array:
    """Frames (N,) of the keys that were put right in the picture alone and not changed since."""
    if not len(fcurve.keyframe_points):
        return np.zeros(0)
    keys = _read_keys(fcurve)
    unchanged = (keys["amplitude"] == PICTURE_AMPLITUDE) & (keys["back"] == _value_mark(keys))
    unchanged &= keys["type"] != _enum_value("type", "GENERATED")
    return np.asarray(keys["co"][unchanged, 0], dtype=np.float64)


def generated_frames(fcurve: bpy.types.FCurve, matched: bool = False) -> Array:
    """Frames (N,) of the GENERATED keys that are unchanged, or of those of found keyframes among them."""
    if not len(fcurve.keyframe_points):
        return np.zeros(0)
    keys = _read_keys(fcurve)
    unchanged = _generated(keys)
    if matched:
        unchanged &= keys["amplitude"] == MATCH_AMPLITUDE
    return np.asarray(keys["co"][unchanged, 0], dtype=np.float64)


def remove_generated_keys(channelbag: bpy.types.ActionChannelbag, paths: Iterable[str]) -> None:
    """Remove the GENERATED keys of the curves with these data paths, and curves left without keys.

    Keys that the animator has given another value stay, and get the animator's own type.
    """
    wanted = set(paths)
    for fcurve in [curve for curve in channelbag.fcurves if curve.data_path in wanted]:
        keys = _read_keys(fcurve)
        own = ~_generated(keys)
        if not own.any():
            channelbag.fcurves.remove(fcurve)
        else:
            _write_keys(fcurve, _as_animators({name: values[own] for name, values in keys.items()}))


def add_generated_keys(
    channelbag: bpy.types.ActionChannelbag, path: str, index: int, group: str, frames: Array, values: Array
) -> None:
    """Add GENERATED keys at scene frames (F,), linear between them; the animator's keys there stay alone."""
    fcurve = ensure_fcurve(channelbag, path, index, group)
    _add_between(fcurve, _as_generated(_new_keys(frames, values, "GENERATED", "LINEAR")))


def mark_generated(channelbag: bpy.types.ActionChannelbag) -> None:
    """Let all keys count as Keymark's own: those that a person sets or changes later are then known."""
    for fcurve in channelbag.fcurves:
        _write_keys(fcurve, _as_generated(_read_keys(fcurve)))


def _add_between(fcurve: bpy.types.FCurve, keys: Keys) -> None:
    """Add keys to a curve on the frames that have none."""
    if len(fcurve.keyframe_points):
        kept = _read_keys(fcurve)
        free = _distances(keys["co"][:, 0], kept["co"][:, 0]) > SAME_FRAME
        keys = _merged(kept, {name: column[free] for name, column in keys.items()})
    _write_keys(fcurve, keys)


def set_posed_keys(
    channelbag: bpy.types.ActionChannelbag,
    path: str,
    index: int,
    group: str,
    frames: Array,
    values: Array,
    depth_found: bool = False,
) -> None:
    """Set keys of the animator's own type at scene frames (K,), with Blender's usual smooth interpolation.

    Keys on the same frames are replaced, all others stay; `depth_found` marks those put right in the picture
    alone.
    """
    keys = _new_keys(frames, values, "KEYFRAME", "BEZIER")
    if depth_found:
        keys["amplitude"] = np.full(len(frames), PICTURE_AMPLITUDE, np.float32)
        keys["back"] = _value_mark(keys)
    _set_keys(ensure_fcurve(channelbag, path, index, group), keys)


def set_matched_keys(
    channelbag: bpy.types.ActionChannelbag, path: str, index: int, group: str, frames: Array, values: Array
) -> None:
    """Set keys like those of `set_posed_keys`, but marked as a found keyframe's."""
    keys = _as_generated(_new_keys(frames, values, "GENERATED", "BEZIER"))
    keys["amplitude"] = np.full(len(frames), MATCH_AMPLITUDE, np.float32)
    _set_keys(ensure_fcurve(channelbag, path, index, group), keys)


def _set_keys(fcurve: bpy.types.FCurve, keys: Keys) -> None:
    """Set keys on a curve; those on the same frames are replaced, all others stay."""
    if len(fcurve.keyframe_points):
        kept = _read_keys(fcurve)
        free = _distances(kept["co"][:, 0], keys["co"][:, 0]) > SAME_FRAME
        keys = _merged({name: column[free] for name, column in kept.items()}, keys)
    _write_keys(fcurve, keys)


def remove_keys(channelbag: bpy.types.ActionChannelbag, paths: Iterable[str], frames: Array) -> None:
    """Remove all keys on frames (K,) from the curves with these data paths, and curves left without keys."""
    for fcurve, keys, there in _keys_on(channelbag, paths, frames):
        if there.all():
            channelbag.fcurves.remove(fcurve)
        else:
            _write_keys(fcurve, {name: column[~there] for name, column in keys.items()})


def give_to_animator(channelbag: bpy.types.ActionChannelbag, paths: Iterable[str], frames: Array) -> None:
    """Turn keys of found keyframes on frames (K,) into the animator's own; values and curves stay.

    The animator vouches for the picture alone: nobody has touched the depth.
    """
    for fcurve, keys, there in _keys_on(channelbag, paths, frames):
        there = there & (keys["amplitude"] == MATCH_AMPLITUDE)
        if there.any():
            given = _as_animators(keys)
            given["amplitude"] = np.full(len(there), PICTURE_AMPLITUDE, np.float32)
            for name, column in keys.items():
                column[there] = given[name][there]
            _write_keys(fcurve, keys)


def _keys_on(
    channelbag: bpy.types.ActionChannelbag, paths: Iterable[str], frames: Array
) -> Iterator[tuple[bpy.types.FCurve, Keys, BoolArray]]:
    """The curves of these paths with keys on any of the frames, their keys, and which of them lie there."""
    wanted = set(paths)
    for fcurve in [curve for curve in channelbag.fcurves if curve.data_path in wanted]:
        if not len(fcurve.keyframe_points) or not len(frames):
            continue
        keys = _read_keys(fcurve)
        there = _distances(keys["co"][:, 0], frames) <= SAME_FRAME
        if there.any():
            yield fcurve, keys, there


def write_smooth_keys(fcurve: bpy.types.FCurve, frames: Array, values: Array, slopes: Array) -> None:
    """Replace a curve's keys by the animator's own at rising frames (K,), with slopes (K,) per frame.

    The handles lie at a third of the way to the next key and are aligned: between two keys the curve is the
    cubic that has the keys' values and slopes.
    """
    keys = _new_keys(frames, values, "KEYFRAME", "BEZIER")
    third = np.diff(frames) / 3.0
    before, after = np.concatenate([third[:1], third]), np.concatenate([third, third[-1:]])
    keys["handle_left"] = np.column_stack([frames - before, values - slopes * before]).astype(np.float32)
    keys["handle_right"] = np.column_stack([frames + after, values + slopes * after]).astype(np.float32)
    for name in ("handle_left_type", "handle_right_type"):
        keys[name] = np.full(len(frames), _enum_value(name, "ALIGNED"), np.int32)
    _write_keys(fcurve, keys)


def write_linear_keys(fcurve: bpy.types.FCurve, frames: Array, values: Array) -> None:
    """Replace a curve's keys by the animator's own at rising frames (K,), linear between them."""
    _write_keys(fcurve, _new_keys(frames, values, "KEYFRAME", "LINEAR"))


def _distances(frames: NDArray[np.generic], others: NDArray[np.generic]) -> Array:
    """(N,) distance from each frame to the nearest of others."""
    apart = np.subtract.outer(frames.astype(np.float64), others.astype(np.float64))
    return np.asarray(np.abs(apart).min(axis=1))


def _merged(keys: Keys, others: Keys) -> Keys:
    both = {name: np.concatenate([keys[name], others[name]]) for name in keys}
    order = np.argsort(both["co"][:, 0], kind="stable")
    return {name: column[order] for name, column in both.items()}


def ensure_fcurve(
    channelbag: bpy.types.ActionChannelbag, path: str, index: int, group: str
) -> bpy.types.FCurve:
    """The curve of one component of a property, in its group; added where missing."""
    fcurve = channelbag.fcurves.find(path, index=index) or channelbag.fcurves.new(path, index=index)
    if fcurve.group is None:
        fcurve.group = channelbag.groups.get(group) or channelbag.groups.new(group)
    return fcurve


def copy_keys(source: bpy.types.FCurve, target: bpy.types.FCurve) -> None:
    """Replace a curve's keys by another's, handles and interpolation included, all as the animator's."""
    _write_keys(target, _as_animators(_read_keys(source)))


def copy_as_generated(source: bpy.types.FCurve, target: bpy.types.FCurve) -> None:
    """Add another curve's keys as GENERATED ones; where the animator has a key, that key stays alone."""
    _add_between(target, _as_generated(_read_keys(source)))
