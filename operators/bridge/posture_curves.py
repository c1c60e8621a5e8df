"""F-curves of a single posture, written and read without any armature.

The curves are those of an armature as Keymark builds it: T pose at rest, its object at the world's origin,
every bone in the rotation mode it is built with. Blender's own pose library applies them to such armatures.
"""

from collections.abc import Mapping
from functools import lru_cache

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.body.skeleton import JointKind
from ...core.finish.rig import channel_count
from .actions import new_channelbag
from .armature import BoneModel, bone_models, rest_matrices, usual_mode
from .fcurves import channels_at_rest
from .keys import set_posed_keys
from .object_space import AT_ORIGIN
from .rig import nearest_postures, rig_at_rest
from .rotation_modes import bone_path, rotation_path, rotation_values

Values = dict[str, Array]  # channel values by bone: the rotation's, for the root then the location's

SAME = 2e-6  # largest relative error of channels by single precision


def write_posture_curves(action: bpy.types.Action, body: Body, posture: Posture) -> None:
    """Give an empty Action the curves of a single posture, the floor at z = 0: one key a channel."""
    channelbag = new_channelbag(action)
    values = channel_values(body, posture)
    for model in _models(body):
        if model.chain:
            channels = _channels(model, usual_mode(body.skeleton, model))
            for (path, index), value in zip(channels, values[model.name], strict=True):
                set_posed_keys(channelbag, path, index, model.name, np.array([1.0]), np.array([value]))


def read_posture_curves(
    action: bpy.types.Action, body: Body, stored: Posture | None = None
) -> Posture | None:
    """The posture that a pose asset's curves show; None where it has no curve of a bone of the skeleton.

    Curves of anything but the skeleton's bones are ignored; bones without curves are as in `stored`, or at
    rest. `stored` is the posture that the curves were once written from: joints whose curves are unchanged
    are taken from it, to the last digit.
    """
    curves = {(curve.data_path, curve.array_index): curve for curve in _fcurves(action) if not curve.is_empty}
    known = channel_values(body, stored if stored is not None else Posture.rest(body.skeleton))
    values: Values = {}
    modes: dict[str, str] = {}
    changed: list[str] = []
    found = False
    for model in _models(body):
        mode = usual_mode(body.skeleton, model)
        modes[model.name] = mode
        if not model.chain:
            continue
        before = known[model.name]
        modes[model.name], there, column = _read_bone(curves, model, mode, before)
        values[model.name] = column
        found |= there
        slack = SAME * np.maximum(1.0, np.abs(before))
        if len(column) != len(before) or (np.abs(column - before) > slack).any():
            changed.append(model.name)
    if not found:
        return None
    if stored is not None and not changed:
        return stored
    shown = _shown(body, modes, values)
    return shown if stored is None else _with_joints(body, stored, shown, changed)


def channel_values(body: Body, posture: Posture) -> Values:
    """Channel values of a single posture."""
    batch = Posture.stack([posture])
    models = _models(body)
    values: Values = {}
    modes = {model.name: usual_mode(body.skeleton, model) for model in models}
    for channel in channels_at_rest(models, _rest(body), AT_ORIGIN, batch):
        turn = rotation_values(channel.rotation, modes[channel.bone])[0]
        location = () if channel.location is None else channel.location[0]
        values[channel.bone] = np.concatenate([turn, location])
    return values


def _channels(model: BoneModel, mode: str) -> list[tuple[str, int]]:
    """Data path and index of each of a bone's values in a rotation mode."""
    location = [(bone_path(model.name, "location"), index) for index in range(3 if model.is_root else 0)]
    path = bone_path(model.name, rotation_path(mode))
    return [*((path, index) for index in range(channel_count(mode))), *location]


@lru_cache(maxsize=4)
def _models(body: Body) -> tuple[BoneModel, ...]:
    return bone_models(body)


@lru_cache(maxsize=4)
def _rest(body: Body) -> Mapping[str, Array]:
    return rest_matrices(body)


def _fcurves(action: bpy.types.Action) -> list[bpy.types.FCurve]:
    """The curves of an Action's first slot."""
    if not action.slots or not action.layers or not action.layers[0].strips:
        return []
    channelbag = action.layers[0].strips[0].channelbag(action.slots[0])
    return [] if channelbag is None else list(channelbag.fcurves)


def _read_bone(
    curves: Mapping[tuple[str, int], bpy.types.FCurve], model: BoneModel, mode: str, known: Array
) -> tuple[str, bool, Array]:
    """A bone's rotation mode, whether it has any curves, and its values."""
    name = model.name
    euler = mode if len(mode) == 3 else "XYZ"
    modes = [mode, *(other for other in ("QUATERNION", "AXIS_ANGLE", euler) if other != mode)]
    keyed = [m for m in modes if any((bone_path(name, rotation_path(m)), i) in curves for i in range(4))]
    chosen = keyed[0] if keyed else mode
    count, channels = channel_count(chosen), _channels(model, chosen)
    usual = known[:count] if chosen == mode else np.eye(4)[0][:count] * (chosen == "QUATERNION")
    otherwise = np.concatenate([usual, known[channel_count(mode) :]])
    values = [
        _value(curves[channel], default) if channel in curves else default
        for channel, default in zip(channels, otherwise, strict=True)
    ]
    there = any(channel in curves for channel in channels)
    return chosen, there, _usable(np.array(values), otherwise, chosen)


def _value(curve: bpy.types.FCurve, default: float) -> float:
    """A curve's value at its first key; an untrusted file may hold any number."""
    value = float(curve.keyframe_points[0].co[1]) if len(curve.keyframe_points) else default
    return value if abs(value) < 1000.0 else default


def _usable(values: Array, otherwise: Array, mode: str) -> Array:
    """Values with a quaternion of unit length; `otherwise` where it has none."""
    if mode == "QUATERNION":
        length = float(np.linalg.norm(values[:4]))
        if length < 1e-6:
            return otherwise
        if abs(length - 1.0) > SAME:
            return np.concatenate([values[:4] / length, values[4:]])
    return values


def _shown(body: Body, modes: Mapping[str, str], values: Values) -> Posture:
    models = _models(body)
    axes = {model.name: model.axes for model in models}
    rig = rig_at_rest(body, axes, _rest(body), modes, AT_ORIGIN)
    shown = rig.pose([values[bone.name][None] for bone in rig.bones])
    return nearest_postures(models, rig, shown, body)[0]


def _with_joints(body: Body, stored: Posture, shown: Posture, bones: list[str]) -> Posture:
    """The stored posture with the joints of some bones from the shown one."""
    skeleton = body.skeleton
    rotations, angles = stored.rotations.copy(), stored.angles.copy()
    translation = stored.translation
    for model in _models(body):
        if model.name not in bones:
            continue
        translation = shown.translation if model.is_root else translation
        for index in model.chain:
            if skeleton.joints[index].kind is JointKind.HINGE:
                column = skeleton.hinge_joints.index(index)
                angles[column] = shown.angles[column]
            elif index in skeleton.ball_joints:
                ball = skeleton.ball_joints.index(index)
                rotations[ball] = shown.rotations[ball]
    return Posture(skeleton, translation, rotations, angles)
