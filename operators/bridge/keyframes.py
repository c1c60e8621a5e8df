"""Keyframes of an actor, posed by the animator or found in the footage, read and written."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.body.skeleton import Skeleton
from ...core.prior.keyframes import Keyframe, Matched
from .actions import channelbag_for, existing_channelbag
from .actor_lengths import skeleton_bones
from .armature import BoneModel
from .fcurves import moved_paths, posture_columns
from .keys import (
    animator_frames,
    generated_frames,
    give_to_animator,
    picture_frames,
    remove_keys,
    set_matched_keys,
    set_posed_keys,
)
from .pose import read_posture
from .rotation_modes import bone_path, rotation_path
from .scene_frames import at_scene_frame, showing_action


def candidate_posture(candidate: bpy.types.PropertyGroup) -> Posture:
    """The posture of a found keyframe's candidate, in the world."""
    return Posture.from_vector(HUMAN, np.array([*candidate.place, *candidate.turns]))


# --- Found keyframes, on the keyframe Action beside the animator's own


DIGITS = 3  # decimals to which frames are told apart, as in `keyed_frames`


def untouched_frames(
    armature_object: bpy.types.Object, action: bpy.types.Action, skeleton: Skeleton
) -> tuple[float, ...]:
    """Scene frames whose found posture is unchanged, in order."""
    return _frames_of_all(
        armature_object, action, skeleton, lambda curve: generated_frames(curve, matched=True)
    )


def picture_corrected_frames(
    armature_object: bpy.types.Object, action: bpy.types.Action, skeleton: Skeleton
) -> tuple[float, ...]:
    """Scene frames whose posture a person put right in the picture alone, unchanged since, in order."""
    return _frames_of_all(armature_object, action, skeleton, picture_frames)


def _frames_of_all(
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    skeleton: Skeleton,
    marked: Callable[[bpy.types.FCurve], Array],
) -> tuple[float, ...]:
    """Scene frames that are marked on the curves of all bones with degrees of freedom, in order."""
    channelbag = existing_channelbag(action, armature_object)
    if channelbag is None:
        return ()
    found: set[float] | None = None
    for model, path, index, _ in _channels(armature_object, skeleton):
        if not model.chain:
            continue
        fcurve = channelbag.fcurves.find(path, index=index)
        if fcurve is None:
            return ()
        frames = set(np.round(marked(fcurve), DIGITS).tolist())
        found = frames if found is None else found & frames
        if not found:
            return ()
    return tuple(sorted(found or ()))


def write_matched(
    armature_object: bpy.types.Object, action: bpy.types.Action, frames: Array, postures: Sequence[Posture]
) -> None:
    """Key K postures at scene frames (K,) as found keyframes; other keys there are replaced."""
    channelbag = channelbag_for(action, armature_object)
    columns = posture_columns(armature_object, Posture.stack(list(postures)))
    turned = _turned_to_neighbors(channelbag, columns, frames)
    remove_keys(channelbag, moved_paths(armature_object, postures[0].skeleton), frames)
    for path, index, bone, column in columns:
        set_matched_keys(channelbag, path, index, bone, frames, column * turned.get(path, 1.0))


def remove_keyframes(
    armature_object: bpy.types.Object, action: bpy.types.Action, skeleton: Skeleton, frames: Collection[float]
) -> None:
    """Remove keyframes; keys of hands and feet stay."""
    channelbag = existing_channelbag(action, armature_object)
    if channelbag is not None:
        remove_keys(channelbag, moved_paths(armature_object, skeleton), np.array(sorted(frames)))


def take_over(
    armature_object: bpy.types.Object, action: bpy.types.Action, skeleton: Skeleton, frames: Collection[float]
) -> None:
    """Turn found keyframes into the animator's own, put right in the picture alone."""
    channelbag = existing_channelbag(action, armature_object)
    if channelbag is not None:
        give_to_animator(channelbag, moved_paths(armature_object, skeleton), np.array(sorted(frames)))


def _channels(
    armature_object: bpy.types.Object, skeleton: Skeleton
) -> Iterator[tuple[BoneModel, str, int, float]]:
    """Bone, data path, array index and value of all channels, in the bones' present rotation modes."""
    for model in skeleton_bones(armature_object, skeleton):
        bone = armature_object.pose.bones[model.name]
        for channel in (rotation_path(bone.rotation_mode), *(("location",) if model.is_root else ())):
            for index, value in enumerate(getattr(bone, channel)):
                yield model, bone_path(model.name, channel), index, value


def _turned_to_neighbors(
    channelbag: bpy.types.ActionChannelbag, columns: list[tuple[str, int, str, Array]], frames: Array
) -> dict[str, Array]:
    """Signs (K,) of the quaternions by data path, so that bones do not turn the long way round.

    A quaternion and its negative are the same posture, but Blender interpolates number by number.
    """
    signs: dict[str, Array] = {}
    for path in {path for path, *_ in columns if path.endswith("rotation_quaternion")}:
        values = np.stack([column for other, _, _, column in columns if other == path])  # (4, K)
        curves = [channelbag.fcurves.find(path, index=index) for index in range(len(values))]
        if all(curve is not None and len(curve.keyframe_points) for curve in curves):
            there = np.array([[curve.evaluate(float(frame)) for frame in frames] for curve in curves])
            signs[path] = np.where(np.sum(values * there, axis=0) < 0.0, -1.0, 1.0)
    return signs


# --- Keyframes of the animator


Matches = Mapping[float, Matched]
"""What found keyframes resemble, by scene frame as `untouched_frames` gives them."""

NOT_MATCHED: Matches = MappingProxyType({})
NEAREST = 0.5  # a key farther than this [frames] from every frame of the clip belongs to none
NOTICEABLE_M = 0.005  # distance between a pose and its nearest posture above which a note is made [m]


@dataclass(frozen=True, eq=False)
class PosedKeyframes:
    """Keyframes read from an armature."""

    keyframes: tuple[Keyframe, ...]  # in order of frame
    notes: tuple[str, ...]  # notes for the animator, one sentence each


def keyed_frames(
    armature_object: bpy.types.Object, action: bpy.types.Action, skeleton: Skeleton
) -> tuple[float, ...]:
    """Scene frames at which any bone that has degrees of freedom is keyed, in order.

    Keys that a motion left do not count; those of matched keyframes do.
    """
    channelbag = existing_channelbag(action, armature_object)
    if channelbag is None:
        return ()
    wanted = set(moved_paths(armature_object, skeleton))
    frames = [animator_frames(fcurve) for fcurve in channelbag.fcurves if fcurve.data_path in wanted]
    if not frames:
        return ()
    return tuple(np.unique(np.round(np.concatenate(frames), DIGITS)).tolist())


def read_keyframes(
    scene: bpy.types.Scene,
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    body: Body,
    clip_frames: Array,
    matches: Matches = NOT_MATCHED,
) -> PosedKeyframes:
    """The postures that the armature shows at the frames keyed in `action`.

    Each is the whole pose as Blender evaluates it there, so a bone without a key of its own on that frame
    counts as the animator sees it. Keys beside `clip_frames` (F,), the scene frames of the clip's, are left
    out with a note. Scene, Action and pose are as before afterwards.
    """
    notes: list[str] = []
    found: dict[int, tuple[float, Keyframe]] = {}
    outside: list[str] = []
    pictured = set(picture_corrected_frames(armature_object, action, body.skeleton))
    with showing_action(armature_object, action), at_scene_frame(scene) as go_to:
        for frame in keyed_frames(armature_object, action, body.skeleton):
            index = int(np.argmin(np.abs(clip_frames - frame)))
            apart = abs(float(clip_frames[index]) - frame)
            if apart > NEAREST + 1e-6:
                outside.append(f"{frame:g}")
                continue
            go_to(frame)
            reading = read_posture(armature_object, body)
            if reading.furthest_m > NOTICEABLE_M:
                notes.append(
                    f"Keyframe {frame:g}: the pose goes {1000 * reading.furthest_m:.0f} mm beyond "
                    "what the skeleton can do; the nearest posture is used"
                )
            if index not in found or apart < found[index][0]:
                residual = float(np.mean(reading.distance_m))
                matched = matches.get(frame)
                depth_found = matched is None and frame in pictured
                found[index] = (apart, Keyframe(index, reading.posture, residual, matched, depth_found))
    if outside:
        notes.append(f"Keys at {', '.join(outside)} lie outside the footage and are not used")
    return PosedKeyframes(tuple(found[index][1] for index in sorted(found)), tuple(notes))


def store_pose(
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    skeleton: Skeleton,
    frame: float,
    depth_found: bool = False,
) -> None:
    """Key the armature's pose as it stands, hands and feet included, in `action` at a scene frame.

    `depth_found`: whether it was put right in the picture alone.
    """
    channelbag = channelbag_for(action, armature_object)
    at = np.array([frame])
    for model, path, index, value in _channels(armature_object, skeleton):
        set_posed_keys(channelbag, path, index, model.name, at, np.array([value]), depth_found)


def write_keyframes(
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    keyframes: Sequence[Keyframe],
    clip_frames: Array,
) -> None:
    """Key postures in `action`, as if the animator had posed them; matched ones as `write_matched` does.

    `clip_frames` (F,) are the scene frames of the clip's.
    """
    frames = clip_frames[[keyframe.index for keyframe in keyframes]]
    channelbag = channelbag_for(action, armature_object)
    postures = Posture.stack([keyframe.posture for keyframe in keyframes])
    posed = np.array([keyframe.matched is None for keyframe in keyframes])
    pictured = np.array([keyframe.depth_found for keyframe in keyframes])
    for path, index, bone, column in posture_columns(armature_object, postures):
        for depth_found in (False, True):
            own = posed & (pictured == depth_found)
            if own.any():
                set_posed_keys(channelbag, path, index, bone, frames[own], column[own], depth_found)
    if not posed.all():
        matched = [keyframe.posture for keyframe in keyframes if keyframe.matched is not None]
        write_matched(armature_object, action, frames[~posed], matched)
