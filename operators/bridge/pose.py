"""Read a posture from an armature's evaluated pose, and pose an armature."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from bpy.types import Action, FCurve, Object

from ...core.arrays import Array
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.keys.rig import channel_count
from .actions import channelbag_for, curves_of
from .actor_bones import evaluated, object_space
from .armature import BoneModel, bones_at_rest, read_bones, skeleton_bones
from .fcurves import posture_columns
from .keys import POSED, write_keys
from .rig import rig_of, shown_postures
from .rotation_modes import bone_path, posture_from_frames, rotation_path


@dataclass(frozen=True, eq=False)
class PoseReading:
    """Poses of an armature as the nearest postures (...), and distances of the principal points of both."""

    posture: Posture
    mean_m: Array  # (...)
    furthest_m: Array  # (...) rounding only, where the pose keeps to the skeleton


def shown_bones(armature_object: Object, models: tuple[BoneModel, ...]) -> tuple[Array, Array]:
    """Where an armature shows B bones now, parents and constraints included, in the world's axes.

    Their heads (B, 3) [m], and the orientations (B, 3, 3) of their joints' frames.
    """
    space, bones = object_space(armature_object), evaluated(armature_object).pose.bones
    matrix = np.array([bones[model.name].matrix for model in models], dtype=np.float64)
    turn = matrix[:, :3, :3] / np.linalg.norm(matrix[:, :3, :3], axis=1, keepdims=True)
    axes = np.stack([model.axes.T for model in models])
    return space.to_world(matrix[:, :3, 3]), space.rotation @ turn @ axes


def read_posture(armature_object: Object, body: Body) -> PoseReading:
    """The posture nearest to what an armature of that body shows now."""
    models = skeleton_bones(armature_object)
    return nearest_postures(models, body, *shown_bones(armature_object, models))


def nearest_postures(models: tuple[BoneModel, ...], body: Body, heads: Array, turns: Array) -> PoseReading:
    """The postures nearest to bones (..., B) as `shown_bones` has them, of an armature of that body."""
    head = {model.name: heads[..., row, :] for row, model in enumerate(models)}
    frame = {model.name: turns[..., row, :, :] for row, model in enumerate(models)}
    root = models[0]  # parents are first
    posture = posture_from_frames(models, frame, head[root.name] - frame[root.name] @ root.start)
    bone_of_joint = {joint: model.name for model in reversed(models) for joint in (model.joint, *model.chain)}
    shown = []
    for point, local in zip(body.skeleton.points, body.point_places, strict=True):
        name = bone_of_joint[point.joint]
        start = body.local(body.skeleton.segment(name).start)
        shown.append(head[name] + frame[name] @ (local - start))
    away_m = np.linalg.norm(body.points(body.pose(posture)) - np.stack(shown, axis=-2), axis=-1)
    return PoseReading(posture, away_m.mean(axis=-1), away_m.max(axis=-1))


def write_posture(armature_object: Object, posture: Posture) -> None:
    """Show a posture, in each bone's own rotation mode, hands and feet as they are; nothing is keyed."""
    bones = read_bones(armature_object)
    for model in bones.models:
        if model.chain:
            pose_bone = armature_object.pose.bones[model.name]
            pose_bone.location, pose_bone.scale = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
    for path, index, _, column in posture_columns(bones, Posture.stack([posture])):
        armature_object.path_resolve(path)[index] = column[0]
    evaluated(armature_object)


SAME = 2e-6  # largest relative error of channels by single precision


def write_posture_curves(action: Action, body: Body, posture: Posture) -> None:
    """Give an empty Action the curves of a single posture, the floor at z = 0: one key a channel."""
    columns = posture_columns(bones_at_rest(body), Posture.stack([posture]))
    write_keys(channelbag_for(action), columns, np.ones(1), POSED)


def read_posture_curves(action: Action, body: Body, stored: Posture | None = None) -> Posture | None:
    """The posture of a pose asset's curves, to the last digit as `stored` where unchanged; None if none."""
    curves = {channel: curve for channel, curve in curves_of(action).items() if not curve.is_empty}
    bones = bones_at_rest(body)
    before: dict[str, list[float]] = {}  # a rotation's values, for the root then the location's
    known = Posture.rest(body.skeleton) if stored is None else stored
    for _, _, bone, column in posture_columns(bones, Posture.stack([known])):
        before.setdefault(bone, []).append(float(column[0]))
    values: dict[str, Array] = {}
    modes = dict(bones.modes)
    changed: list[BoneModel] = []
    found = False
    for model in bones.models:
        if model.chain:
            was = np.array(before[model.name])
            modes[model.name], there, now = _read_bone(curves, model, bones.modes[model.name], was)
            values[model.name] = now
            found |= there
            if len(now) != len(was) or (np.abs(now - was) > SAME * np.maximum(1.0, np.abs(was))).any():
                changed.append(model)
    if not found or (stored is not None and not changed):
        return stored if found else None
    rig = rig_of(replace(bones, modes=modes), body)
    shown = shown_postures(rig, rig.pose([values[bone.name][None] for bone in rig.bones]), body)[0]
    if stored is None:
        return shown
    skeleton, joints = body.skeleton, [joint for model in changed for joint in model.chain]
    turned = np.isin(skeleton.ball_joints, joints)[:, None, None]
    return Posture(
        skeleton,
        (shown if any(model.parent is None for model in changed) else stored).translation,
        np.where(turned, shown.rotations, stored.rotations),
        np.where(np.isin(skeleton.hinge_joints, joints), shown.angles, stored.angles),
    )


def _read_bone(
    curves: Mapping[tuple[str, int], FCurve], model: BoneModel, mode: str, known: Array
) -> tuple[str, bool, Array]:
    euler = mode if len(mode) == 3 else "XYZ"
    modes = [mode, *(other for other in ("QUATERNION", "AXIS_ANGLE", euler) if other != mode)]
    paths = {each: bone_path(model.name, rotation_path(each)) for each in modes}
    keyed = [each for each in modes if any((paths[each], index) in curves for index in range(4))]
    chosen = keyed[0] if keyed else mode
    count, place = channel_count(chosen), bone_path(model.name, "location")
    usual = known[:count] if chosen == mode else np.eye(4)[0][:count] * (chosen == "QUATERNION")
    values = otherwise = np.concatenate([usual, known[channel_count(mode) :]])
    channels = [*((paths[chosen], index) for index in range(count)), *((place, index) for index in range(3))]
    there = False
    for row, channel in enumerate(channels[: len(otherwise)]):
        if channel in curves:
            there, values = True, values.copy()
            keys = curves[channel].keyframe_points
            value = float(keys[0].co[1]) if len(keys) else np.inf
            values[row] = value if abs(value) < 1000.0 else otherwise[row]  # a file may hold any number
    length = float(np.linalg.norm(values[:4]))
    if chosen == "QUATERNION" and length < 1e-6:
        return chosen, there, otherwise
    if chosen == "QUATERNION" and abs(length - 1.0) > SAME:
        values = np.concatenate([values[:4] / length, values[4:]])
    return chosen, there, values
