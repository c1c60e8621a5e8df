"""Keyframes of an actor, posed by the animator or found in the footage, read and written."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from bpy.types import Action, Object, PropertyGroup, Scene

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.prior.keyframes import Keyframe, Matched
from . import keys
from .actions import channelbag_for, curves_of, existing_channelbag
from .armature import BoneModel, read_bones, skeleton_bones
from .fcurves import moved_paths, posture_columns
from .pose import nearest_postures, shown_bones
from .rotation_modes import bone_path, rotation_path
from .scene_frames import at_scene_frame, showing_action


def candidate_posture(candidate: PropertyGroup) -> Posture:
    """The posture of a found keyframe's candidate, in the world."""
    return Posture.from_vector(HUMAN, np.array([*candidate.place, *candidate.turns]))


DIGITS = 3  # decimals to which frames are told apart, as in `keyed_frames`


def unchanged_keyframes(armature_object: Object, action: Action, kind: keys.KeyKind) -> tuple[float, ...]:
    """Scene frames at which all bones with degrees of freedom have unchanged FOUND or PICTURED keys."""
    curves = curves_of(action, armature_object)
    found: set[float] | None = None
    for model, path, index, _ in _channels(armature_object):
        if model.chain and found != set():
            curve = curves.get((path, index))
            frames = () if curve is None else np.round(keys.unchanged_frames(curve, kind), DIGITS).tolist()
            found = set(frames) if found is None else found & set(frames)
    return tuple(sorted(found or ()))


def write_matched(armature_object: Object, action: Action, frames: Array, posed: Sequence[Posture]) -> None:
    """Key K postures at scene frames (K,) as found, instead of others, by quaternions of the nearest sign."""
    channelbag, curves = channelbag_for(action, armature_object), curves_of(action, armature_object)
    columns = posture_columns(read_bones(armature_object), Posture.stack(list(posed)))
    signs: dict[str, Array] = {}  # (K,) by data path
    for path in {path for path, *_ in columns if path.endswith("rotation_quaternion")}:
        values = np.stack([column for other, _, _, column in columns if other == path])  # (4, K)
        there = [curve for index in range(4) if (curve := curves.get((path, index))) is not None]
        if len(there) == 4 and all(len(curve.keyframe_points) for curve in there):
            shown = np.array([[curve.evaluate(float(frame)) for frame in frames] for curve in there])
            signs[path] = np.where(np.sum(values * shown, axis=0) < 0.0, -1.0, 1.0)
    turned = [(path, index, bone, column * signs.get(path, 1.0)) for path, index, bone, column in columns]
    keys.remove_keys(channelbag, moved_paths(armature_object), frames)
    keys.write_keys(channelbag, turned, frames, keys.FOUND)


def remove_keyframes(armature_object: Object, action: Action, frames: Collection[float]) -> None:
    """Remove keyframes; keys of hands and feet stay."""
    if (channelbag := existing_channelbag(action, armature_object)) is not None:
        keys.remove_keys(channelbag, moved_paths(armature_object), np.array(sorted(frames)))


def take_over(armature_object: Object, action: Action, frames: Collection[float]) -> None:
    """Turn found keyframes into the animator's own, put right in the picture alone."""
    if (channelbag := existing_channelbag(action, armature_object)) is not None:
        keys.give_to_animator(channelbag, moved_paths(armature_object), np.array(sorted(frames)))


def _channels(armature_object: Object) -> Iterator[tuple[BoneModel, str, int, float]]:
    """Bone, data path, array index and value of all channels, in the bones' present rotation modes."""
    for model in read_bones(armature_object).models:
        bone = armature_object.pose.bones[model.name]
        for channel in (rotation_path(bone.rotation_mode), *(("location",) if model.parent is None else ())):
            for index, value in enumerate(getattr(bone, channel)):
                yield model, bone_path(model.name, channel), index, value


Matches = Mapping[float, Matched]  # what found keyframes resemble, by frame of `unchanged_keyframes`
NOT_MATCHED: Matches = MappingProxyType({})
NEAREST = 0.5  # a key farther than this [frames] from every frame of the clip belongs to none
NOTICEABLE_M = 0.005  # distance between a pose and its nearest posture above which a note is made [m]


@dataclass(frozen=True, eq=False)
class PosedKeyframes:
    """Keyframes read from an armature."""

    keyframes: tuple[Keyframe, ...]  # in order of frame
    notes: tuple[str, ...]  # notes for the animator, one sentence each


def keyed_frames(armature_object: Object, action: Action) -> tuple[float, ...]:
    """Scene frames at which a bone with degrees of freedom is keyed, posed or found, in order."""
    wanted, curves = set(moved_paths(armature_object)), curves_of(action, armature_object)
    frames = [keys.animator_frames(curve) for (path, _), curve in curves.items() if path in wanted]
    return tuple(np.unique(np.round(np.concatenate([np.zeros(0), *frames]), DIGITS)).tolist())


def read_keyframes(
    scene: Scene,
    armature_object: Object,
    action: Action,
    body: Body,
    clip_frames: Array,
    matches: Matches = NOT_MATCHED,
) -> PosedKeyframes:
    """Whole poses, as Blender shows them at frames keyed in `action` near the clip's (F,)."""
    keyed = np.array(keyed_frames(armature_object, action))
    index = np.abs(clip_frames - keyed[:, None]).argmin(axis=1)
    apart = np.abs(clip_frames[index] - keyed)
    within = apart <= NEAREST + 1e-6
    notes: list[str] = []
    found: dict[int, tuple[float, Keyframe]] = {}
    pictured = set(unchanged_keyframes(armature_object, action, keys.PICTURED))
    models, shown = skeleton_bones(armature_object), []
    with showing_action(armature_object, action), at_scene_frame(scene) as go_to:
        for frame in keyed[within]:
            go_to(frame)
            shown.append(shown_bones(armature_object, models))
    if shown:
        read = nearest_postures(models, body, *map(np.stack, zip(*shown, strict=True)))
        rows = zip(keyed[within].tolist(), index[within].tolist(), apart[within].tolist(), strict=True)
        for row, (frame, at, away) in enumerate(rows):
            if read.furthest_m[row] > NOTICEABLE_M:
                notes.append(
                    f"Keyframe {frame:g}: the pose goes {1000 * read.furthest_m[row]:.0f} mm beyond "
                    "what the skeleton can do; the nearest posture is used"
                )
            if at not in found or away < found[at][0]:
                matched, error_m = matches.get(frame), float(read.mean_m[row])
                depth_found = matched is None and frame in pictured
                found[at] = (away, Keyframe(at, read.posture[row], error_m, matched, depth_found))
    if not within.all():
        outside = ", ".join(f"{frame:g}" for frame in keyed[~within])
        notes.append(f"Keys at {outside} lie outside the footage and are not used")
    return PosedKeyframes(tuple(found[at][1] for at in sorted(found)), tuple(notes))


def store_pose(armature_object: Object, action: Action, frame: float, depth_found: bool = False) -> None:
    """Key the armature's whole pose as it stands; `depth_found` if it was put right in the picture alone."""
    channels = _channels(armature_object)
    columns = [(path, index, model.name, np.array([value])) for model, path, index, value in channels]
    kind = keys.PICTURED if depth_found else keys.POSED
    keys.write_keys(channelbag_for(action, armature_object), columns, np.array([frame]), kind)


def write_keyframes(
    armature_object: Object, action: Action, keyframes: Sequence[Keyframe], clip_frames: Array
) -> None:
    """Key postures as the animator's, matched ones as found ones; `clip_frames` (F,) are scene frames."""
    frames = clip_frames[[keyframe.index for keyframe in keyframes]]
    postures = Posture.stack([keyframe.posture for keyframe in keyframes])
    posed = np.array([keyframe.matched is None for keyframe in keyframes])
    pictured = np.array([keyframe.depth_found for keyframe in keyframes])
    columns = posture_columns(read_bones(armature_object), postures)
    for own, kind in ((posed & ~pictured, keys.POSED), (posed & pictured, keys.PICTURED)):
        if own.any():
            rows = [(path, index, bone, column[own]) for path, index, bone, column in columns]
            keys.write_keys(channelbag_for(action, armature_object), rows, frames[own], kind)
    if not posed.all():
        matched = [keyframe.posture for keyframe in keyframes if keyframe.matched is not None]
        write_matched(armature_object, action, frames[~posed], matched)
