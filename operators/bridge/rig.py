"""The actor's armature as core's `Rig`, and the channel values that an Action has for it."""

from collections.abc import Collection, Generator

import numpy as np
from bpy.types import Action, FCurve, Object, Scene

from ...core.arrays import Array
from ...core.body.body_volume import sole_offsets
from ...core.body.fingers import FINGER_BONES
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.body.rotations import continuous_quaternions
from ...core.body.skeleton import SIDES
from ...core.errors import InputError, frames_in_words
from ...core.keys.rig import Rig, RigBone, RigPose, channel_count
from ...core.progress import run, within
from ...core.take.motion import Motion
from .actions import curves_of
from .armature import ActorBones, bone_models, finger_models, read_body, read_bones
from .fcurves import moved_paths
from .rotation_modes import bone_path, posture_from_frames, rotation_path

LEVER_M = 0.2  # at whose end a point shows the turn of a finger's bone


def read_rig(armature_object: Object, body: Body, extremities: Collection[str] = ()) -> Rig:
    """A rig of an armature's bones, as `rig_of`."""
    return rig_of(read_bones(armature_object), body, extremities)


def rig_of(resting: ActorBones, body: Body, extremities: Collection[str] = ()) -> Rig:
    """A rig of bones in their modes: `posture_columns` backwards; hands and feet not named are rigid."""
    axes, rest, space = {model.name: model.axes for model in resting.models}, resting.rest, resting.space
    models = tuple(model for model in (*bone_models(body), *finger_models(body)) if model.name in axes)
    turning = [model for model in models if model.chain or model.name in extremities]
    starts = {model.name: model.start for model in turning if not model.chain}
    names = [model.name for model in turning]
    carried = {model.name: str(model.parent) for model in models}
    bones = []
    for model in turning:
        own = rest[model.name][:3, :3]
        above = str(model.parent) if model.parent in names else carried.get(str(model.parent), "")
        if model.parent is None:
            left = space.rotation @ own
            origin, location_axes = space.to_world(rest[model.name][:3, 3]), space.scale * left
        else:
            # The bone's joint in its parent's joint's frame; a hand's is the wrist, a foot's the ankle.
            start = model.start - starts.get(above, 0.0)
            origin, location_axes = body.offsets[model.chain[0]] if model.chain else start, None
            left = axes[model.parent] @ rest[model.parent][:3, :3].T @ own
        # Points are the bone's own end, a foot's heel, and the ends of rigid hands and feet [m].
        points = [model.end, *(m.end for m in models if m.parent == model.name and m not in turning)]
        if not model.chain:
            along = model.end - model.start
            if model.name in FINGER_BONES:  # the end of a lever, so that the tolerance holds its turn
                along = LEVER_M * along / np.linalg.norm(along)
            points = [along]
            kind, _, side = model.name.partition(".")
            points += [sole_offsets(body)[SIDES.index(side), 0]] if kind == "foot" else []
        bones.append(
            RigBone(
                name=model.name,
                parent=-1 if model.parent is None else names.index(above),
                mode=resting.modes[model.name],
                left=left,
                right=axes[model.name].T,
                origin=origin,
                points=np.stack(points),
                location_axes=location_axes,
            )
        )
    return Rig(tuple(bones))


def rig_channels(rig: Rig) -> tuple[tuple[int, int, str, int], ...]:
    """Bone in the rig and column of its values, data path and array index of each of their properties."""
    found: list[tuple[int, int, str, int]] = []
    for bone, model in enumerate(rig.bones):
        count = channel_count(model.mode)
        path = bone_path(model.name, rotation_path(model.mode))
        found += [(bone, index, path, index) for index in range(count)]
        if model.location_axes is not None:
            found += [(bone, count + i, bone_path(model.name, "location"), i) for i in range(3)]
    return tuple(found)


def motion_frames(armature_object: Object, action: Action) -> Array:
    """(F,) whole scene frames from the first to the last key of a motion; InputError for fewer than two."""
    ranges = [curve.range() for curve in _keyed(armature_object, action)] or [(0.0, 0.0)]
    # Keys as near as this lie on the frame.
    first = int(np.ceil(min(first for first, _ in ranges) - 1e-3))
    last = int(np.floor(max(last for _, last in ranges) + 1e-3))
    if last <= first:
        raise InputError(
            f"Action '{action.name}' has no motion of '{armature_object.name}' over two frames or more; "
            "reconstruct the motion first"
        )
    return np.arange(first, last + 1, dtype=np.float64)


def _keyed(armature_object: Object, action: Action) -> list[FCurve]:
    wanted, curves = set(moved_paths(armature_object)), curves_of(action, armature_object)
    return [curve for (path, _), curve in curves.items() if path in wanted and not curve.is_empty]


def present_frames(armature_object: Object, action: Action, rate: float) -> Array:
    """(F,) the frames of `motion_frames` in which the performer is there: all but long gaps in dense keys."""
    from ...core.take.presence import BRIDGED_S  # OpenCV, which Blender starts without

    frames = motion_frames(armature_object, action)
    keys = []
    for curve in _keyed(armature_object, action):
        places = np.empty(2 * len(curve.keyframe_points))
        curve.keyframe_points.foreach_get("co", places)
        keys.append(places[::2])
    times = np.unique(np.concatenate(keys))
    steps = np.diff(times)
    if np.median(steps) > 1.5:
        return frames
    after = np.clip(np.searchsorted(times, frames - 1e-3), 1, len(times) - 1)
    on_key = np.abs(frames[:, None] - times[[after - 1, after]].T).min(axis=1) < 1e-3
    return frames[on_key | (steps[after - 1] <= BRIDGED_S * rate)]


def absence_note(armature_object: Object, action: Action, rate: float) -> str:
    """What an export has between stretches of a motion, in which nobody is seen; empty without any."""
    frames = motion_frames(armature_object, action)
    there = np.isin(frames, present_frames(armature_object, action, rate))
    if there.all():
        return ""
    away = frames_in_words(np.round(frames[~there]))
    return f"nobody is seen in {away}: from the pose before to the one after, nothing is known"


def read_values(
    armature_object: Object, action: Action, rig: Rig, frames: Array
) -> Generator[float, None, list[Array]]:
    """Evaluate an Action's curves at scene frames (F,) as in `Rig`, (F, C) a bone; the scene is not touched.

    Channels without a curve, or with a muted one, have the value that the armature has now, as when Blender
    plays the Action. Quaternions are of unit length and without jumps of sign. Yields the fraction done.
    """
    curves, channels = curves_of(action, armature_object), rig_channels(rig)
    columns: list[list[Array]] = [[] for _ in rig.bones]
    for number, (bone, _, path, index) in enumerate(channels):
        fcurve = curves.get((path, index))
        if fcurve is None or fcurve.mute:
            shown = [armature_object.path_resolve(path)[index]] * len(frames)
        else:
            shown = [fcurve.evaluate(frame) for frame in frames]
        columns[bone].append(np.array(shown, dtype=np.float64))
        yield (number + 1) / len(channels)
    values = [np.column_stack(column) for column in columns]
    for bone, model in enumerate(rig.bones):
        if model.mode == "QUATERNION":
            values[bone][:, :4] = unit_quaternions(values[bone][:, :4])
    return values


def unit_quaternions(quaternions: Array) -> Array:
    """Quaternions (F, 4) of unit length without jumps of sign; no turn where all four numbers are zero."""
    length = np.linalg.norm(quaternions, axis=1, keepdims=True)
    unit = np.where(length > 1e-9, quaternions / np.maximum(length, 1e-9), [1.0, 0, 0, 0])
    return continuous_quaternions(unit)


def shown_postures(rig: Rig, shown: RigPose, body: Body) -> Posture:
    """The postures nearest to a rig's poses, a batch of F."""
    turns, models = {bone.name: shown.rotation[row] for row, bone in enumerate(rig.bones)}, bone_models(body)
    turns |= {model.name: turns[str(model.parent)] for model in models if model.name not in turns}
    hips = shown.points[:, rig.point_slices[0].start] - body.offsets[0]
    return posture_from_frames(models, turns, hips)


def shown_motion(
    scene: Scene, armature_object: Object, action: Action, most_frames: int | None = None
) -> Motion:
    """The motion that an Action holds for an actor, in every frame or in as many; no deviations are known."""
    body = read_body(armature_object)
    rig, frames = read_rig(armature_object, body), motion_frames(armature_object, action)
    if most_frames is not None:
        frames = frames[np.unique(np.linspace(0, len(frames) - 1, most_frames).astype(np.intp))]
    values = run(within("Reading the motion", read_values(armature_object, action, rig, frames), 0.0, 1.0))
    posture = shown_postures(rig, rig.pose(values), body)
    points = body.points(body.pose(posture))
    rate, unknown = scene.render.fps / scene.render.fps_base, np.full((*points.shape, 3), np.nan)
    time_s = (frames - frames[0]) / rate
    return Motion(body, rate, int(frames[0]), time_s, posture, points, unknown, (), "interpolation")
