"""Keys on F-curves, in bulk. Keymark's own are told from the animator's by Blender's key type.

Only keys of the type GENERATED are ever replaced or removed, and of these not the ones that the animator has
given another value: Blender leaves their type as it was. `back`, a number which only the interpolation of
that name uses, holds the value that a key was made with, so that a changed key is recognized. `amplitude`
marks the keys of a found keyframe, which stands beside the animator's own, and those of one that the
animator put right in the picture alone.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np
from bpy.types import ActionChannelbag, FCurve
from numpy.typing import NDArray

from ...core.arrays import Array, BoolArray, SingleArray

if TYPE_CHECKING:
    from ...core.keys.hermite import Spline

Keys = dict[str, NDArray[np.generic]]  # properties of N keys by name: (N,), or (N, 2) for coordinates
Column = tuple[str, int, str, Array]  # data path, array index, group and values (F,) of an F-curve

UNMARKED = 0.0  # `back` of a key without a record of its first value, as earlier versions made all
SAME_FRAME = 1e-3  # keys nearer than this [frames] lie on the same frame
FLOATS = ("back", "amplitude", "period")
PAIRS = ("co", "handle_left", "handle_right")
ENUMS = ("interpolation", "easing", "handle_left_type", "handle_right_type", "type")
FLAGS = ("select_control_point", "select_left_handle", "select_right_handle")


_revision = 0


def revision() -> int:
    """A number that is another one after every change of keys that is known of."""
    return _revision


def keys_changed() -> None:
    """Keys have changed, or may have: by a person, by undo, by a script before an operator."""
    global _revision  # noqa: PLW0603
    _revision += 1


@dataclass(frozen=True)
class KeyKind:
    """A kind of keys that Keymark writes and tells from others."""

    type: str = "KEYFRAME"
    interpolation: str = "BEZIER"
    amplitude: float | None = None  # what marks them; users cannot set an amplitude below zero
    gives_way: bool = False  # whether another key on a frame stays there alone; else it is replaced


POSED = KeyKind()  # as the animator sets keys, with Blender's usual smooth interpolation
PICTURED = KeyKind(amplitude=-2.0)  # put right by the animator in the picture alone: as deep as found
FOUND = KeyKind("GENERATED", amplitude=-1.0)  # those of a found keyframe
MOTION = KeyKind("GENERATED", "LINEAR", gives_way=True)


def _generated(keys: Keys) -> BoolArray:
    """(N,) which keys are Keymark's and have the values it gave them."""
    as_made = (keys["back"] == _value_mark(keys)) | (keys["back"] == UNMARKED)
    as_made |= keys["interpolation"] == _enum_value("interpolation", "BACK")
    return (keys["type"] == _enum_value("type", "GENERATED")) & as_made


def _value_mark(keys: Keys) -> SingleArray:
    """(N,) `back` of keys that records their present values."""
    values = keys["co"][:, 1].astype(np.float32)
    return np.where(values == UNMARKED, np.float32(1e-30), values)


def _as_generated(keys: Keys) -> Keys:
    used = keys["interpolation"] == _enum_value("interpolation", "BACK")
    types = np.full(len(used), _enum_value("type", "GENERATED"), np.int32)
    return {**keys, "type": types, "back": np.where(used, keys["back"], _value_mark(keys))}


def _as_animators(keys: Keys) -> Keys:
    types, generated = keys["type"], _enum_value("type", "GENERATED")
    plain = np.where(types == generated, _enum_value("type", "KEYFRAME"), types).astype(np.int32)
    return {**keys, "type": plain}


def _enum_value(name: str, item: str) -> int:
    return int(bpy.types.Keyframe.bl_rna.properties[name].enum_items[item].value)


def _read_keys(fcurve: FCurve) -> Keys:
    """Every property of every key: (N,) or, for pairs, (N, 2)."""
    points = fcurve.keyframe_points
    keys: Keys = {}
    for name in (*PAIRS, *FLOATS, *ENUMS, *FLAGS):
        kind = np.bool_ if name in FLAGS else np.int32 if name in ENUMS else np.float32
        keys[name] = np.empty((len(points), 2) if name in PAIRS else len(points), kind)
        points.foreach_get(name, keys[name].ravel())
    return keys


def _write_keys(fcurve: FCurve, keys: Keys) -> None:
    points = fcurve.keyframe_points
    points.clear()
    points.add(len(keys["co"]))
    # Handle types come before handles: setting a type moves the handles.
    for name in (*ENUMS, *FLOATS, *PAIRS, *FLAGS):
        points.foreach_set(name, keys[name].ravel())
    fcurve.update()
    keys_changed()


def _new_keys(frames: Array, values: Array, kind: KeyKind) -> Keys:
    """Keys that are not selected, so that what the animator does next does not move them."""
    count, defaults = len(frames), bpy.types.Keyframe.bl_rna.properties
    coordinates = np.column_stack([frames, values]).astype(np.float32)
    keys: Keys = {name: coordinates.copy() for name in PAIRS}
    keys |= {name: np.full(count, defaults[name].default, np.float32) for name in FLOATS}
    keys |= {name: np.zeros(count, np.bool_) for name in FLAGS}
    items = (kind.interpolation, "AUTO", "AUTO_CLAMPED", "AUTO_CLAMPED", kind.type)
    for name, item in zip(ENUMS, items, strict=True):
        keys[name] = np.full(count, _enum_value(name, item), np.int32)
    if kind.amplitude is not None:
        keys["amplitude"] = np.full(count, kind.amplitude, np.float32)
    if kind.amplitude is not None or kind.type == "GENERATED":
        keys["back"] = _value_mark(keys)
    return keys


def animator_frames(fcurve: FCurve) -> Array:
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
        counted |= amplitudes == FOUND.amplitude
    return np.asarray(coordinates[counted, 0], dtype=np.float64)


def unchanged_frames(fcurve: FCurve, kind: KeyKind) -> Array:
    """Frames (N,) of the keys of a kind that nobody has changed; MOTION stands for all that are GENERATED."""
    keys = _read_keys(fcurve)
    if kind.type == "GENERATED":
        unchanged = _generated(keys)
    else:
        unchanged = (keys["back"] == _value_mark(keys)) & (keys["type"] != _enum_value("type", "GENERATED"))
    if kind.amplitude is not None:
        unchanged &= keys["amplitude"] == kind.amplitude
    return np.asarray(keys["co"][unchanged, 0], dtype=np.float64)


def write_keys(channelbag: ActionChannelbag, columns: Iterable[Column], frames: Array, kind: KeyKind) -> None:
    """Set keys of a kind at scene frames (F,); all other keys of the curves stay."""
    for path, index, group, values in columns:
        fcurve = ensure_fcurve(channelbag, path, index, group)
        _join_keys(fcurve, _new_keys(frames, values, kind), kind.gives_way)


def _join_keys(fcurve: FCurve, keys: Keys, gives_way: bool) -> None:
    """Add keys to a curve; of two on one frame the new one goes, or else the old one."""
    kept = _read_keys(fcurve)
    if gives_way:
        keys = _chosen(keys, ~_are_on(keys, kept["co"][:, 0]))
    else:
        kept = _chosen(kept, ~_are_on(kept, keys["co"][:, 0]))
    both = {name: np.concatenate([kept[name], keys[name]]) for name in keys}
    _write_keys(fcurve, _chosen(both, np.argsort(both["co"][:, 0], kind="stable")))


def _are_on(keys: Keys, frames: NDArray[np.generic]) -> BoolArray:
    """(N,) whether each key lies on one of some frames."""
    apart = np.subtract.outer(keys["co"][:, 0].astype(np.float64), frames.astype(np.float64))
    return np.asarray(np.abs(apart).min(axis=1, initial=np.inf) <= SAME_FRAME)


def _chosen(keys: Keys, which: NDArray[np.generic]) -> Keys:
    return {name: column[which] for name, column in keys.items()}


def remove_generated_keys(channelbag: ActionChannelbag, paths: Iterable[str]) -> None:
    """Remove GENERATED keys of these paths, and empty curves; changed keys become the animator's."""
    for fcurve, keys in _curves(channelbag, paths):
        _keep(channelbag, fcurve, _as_animators(keys), ~_generated(keys))


def remove_keys(channelbag: ActionChannelbag, paths: Iterable[str], frames: Array) -> None:
    """Remove all keys on frames (K,) from the curves with these data paths, and curves left without keys."""
    for fcurve, keys in _curves(channelbag, paths):
        there = _are_on(keys, frames)
        if there.any():
            _keep(channelbag, fcurve, keys, ~there)


def give_to_animator(channelbag: ActionChannelbag, paths: Iterable[str], frames: Array) -> None:
    """Turn keys of found keyframes on frames (K,) into the animator's, who vouches for the picture alone."""
    for fcurve, keys in _curves(channelbag, paths):
        there = _are_on(keys, frames) & (keys["amplitude"] == FOUND.amplitude)
        if there.any():
            keys["type"] = np.where(there, _as_animators(keys)["type"], keys["type"])
            keys["amplitude"][there] = PICTURED.amplitude
            _write_keys(fcurve, keys)


def _curves(channelbag: ActionChannelbag, paths: Iterable[str]) -> Iterator[tuple[FCurve, Keys]]:
    wanted = set(paths)
    for fcurve in [curve for curve in channelbag.fcurves if curve.data_path in wanted]:
        yield fcurve, _read_keys(fcurve)


def _keep(channelbag: ActionChannelbag, fcurve: FCurve, keys: Keys, kept: BoolArray) -> None:
    if kept.any():
        _write_keys(fcurve, _chosen(keys, kept))
    else:
        channelbag.fcurves.remove(fcurve)
        keys_changed()


def mark_generated(channelbag: ActionChannelbag) -> None:
    """Let all keys count as Keymark's own: those that a person sets or changes later are then known."""
    for fcurve in channelbag.fcurves:
        _write_keys(fcurve, _as_generated(_read_keys(fcurve)))


def write_column(fcurve: FCurve, frames: Array, held: "Array | Spline", column: int) -> None:
    """Replace a curve's keys by the animator's own: few of them, or values on each of the frames (F,)."""
    if isinstance(held, np.ndarray):
        write_linear_keys(fcurve, frames, held[:, column])
        return
    at, values, slopes = frames[held.keys], held.values[:, column], held.slopes[:, column]
    keys = _new_keys(at, values, POSED)
    third = np.diff(at) / 3.0
    before, after = np.concatenate([third[:1], third]), np.concatenate([third, third[-1:]])
    keys["handle_left"] = np.column_stack([at - before, values - slopes * before]).astype(np.float32)
    keys["handle_right"] = np.column_stack([at + after, values + slopes * after]).astype(np.float32)
    for name in ("handle_left_type", "handle_right_type"):
        keys[name] = np.full(len(at), _enum_value(name, "ALIGNED"), np.int32)
    _write_keys(fcurve, keys)


def write_linear_keys(fcurve: FCurve, frames: Array, values: Array) -> None:
    """Replace a curve's keys by the animator's own at rising frames (K,), linear between them."""
    _write_keys(fcurve, _new_keys(frames, values, KeyKind(interpolation="LINEAR")))


def copy_keys(source: FCurve, target: FCurve) -> None:
    """Replace a curve's keys by another's, handles and interpolation included, all as the animator's."""
    _write_keys(target, _as_animators(_read_keys(source)))


def copy_as_generated(source: FCurve, target: FCurve) -> None:
    """Add another curve's keys as GENERATED ones; where the animator has a key, that key stays alone."""
    _join_keys(target, _as_generated(_read_keys(source)), gives_way=True)


def ensure_fcurve(channelbag: ActionChannelbag, path: str, index: int, group: str) -> FCurve:
    """The curve of one component of a property, in its group; added where missing."""
    fcurve = channelbag.fcurves.find(path, index=index) or channelbag.fcurves.new(path, index=index)
    if fcurve.group is None:
        fcurve.group = channelbag.groups.get(group) or channelbag.groups.new(group)
    return fcurve
