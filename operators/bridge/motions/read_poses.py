"""Any armature's bones by role, the poses that an Action gives it, and which of them a person posed."""

from collections.abc import Collection, Iterable, Sequence
from contextlib import nullcontext
from pathlib import Path

import bpy
import numpy as np
from bpy.types import Action, FCurve, Object

from ....core.arrays import Array
from ....core.body.skeleton import SIDES
from ....core.errors import InputError
from ....core.mend.mend_motion import MOST_FRAMES
from ....core.progress import Part, run
from ....core.retarget.character import ARM, LEG, Similarity
from ....core.retarget.controls.control_channels import unscaled
from ....core.retarget.maps.character_map import CharacterMap, RoleBones
from ....core.retarget.maps.map_registry import ChosenMap, choose_map
from ....core.retarget.mended_armature import ArmaturePoints, Poses
from ....core.retarget.retarget_record import RECOGNIZED
from ....core.retarget.solve.rest_body import RestBody
from ....core.take.conversion_settings import AUTO
from ..actions import action_of, curves_of
from ..actor_bones import evaluated, is_actor, joint_places, object_space
from ..character.read_character import read_character
from ..keys import MOTION, animator_frames, unchanged_frames
from ..rotation_modes import ALL_PATHS, bone_path
from ..scene_frames import each_frame, showing_action

ACTOR_BONES = {"hips": "pelvis", "spine": "chest", "head": "head"} | {
    f"{role}.{side}": f"{'girdle' if role == 'shoulder' else role}.{side}"
    for role in (*ARM, *LEG[:3])
    for side in SIDES
}
"""The bones of Keymark's actor by the role that they play."""


def motion_map(armature_object: Object, maps: Sequence[Path]) -> ChosenMap:
    """The roles of an armature's bones: of Keymark's actor by its bones, of any other as a character's."""
    if is_actor(armature_object):
        roles = {role: RoleBones((bone,)) for role, bone in ACTOR_BONES.items()}
        return ChosenMap(CharacterMap("Actor", roles), RECOGNIZED)
    return choose_map(read_character(armature_object), AUTO, maps)


def animated_action(armature_object: Object) -> Action:
    """The Action that animates an armature; InputError without one."""
    action = action_of(armature_object)
    if action is None:
        what = f"armature '{armature_object.name}' has no Action"
        raise InputError(f"{what}; load a motion, or choose the Action that moves it")
    return action


def action_frames(armature_object: Object, action: Action) -> Array:
    """(F,) whole scene frames from the first to the last key of an Action's bones; InputError for too few."""
    ranges = [curve.range() for curve in _bone_curves(armature_object, action)]
    first = int(np.ceil(min((r[0] for r in ranges), default=0.0) - 1e-3))
    last = int(np.floor(max((r[1] for r in ranges), default=0.0) + 1e-3))
    if not 3 <= last - first + 1 <= MOST_FRAMES:
        raise InputError(
            f"Action '{action.name}' moves the bones of '{armature_object.name}' over "
            f"{max(last - first + 1, 0) if ranges else 0} frames; 3 to {MOST_FRAMES} can be mended"
        )
    return np.arange(first, last + 1, dtype=np.float64)


def _bone_curves(armature_object: Object, action: Action) -> list[FCurve]:
    return [
        curve
        for (path, _), curve in curves_of(action, armature_object).items()
        if path.startswith("pose.bones[") and not curve.is_empty and not curve.mute
    ]


def posed_frames(
    armature_object: Object, action: Action, bones: Iterable[str], frames: Array
) -> tuple[int, ...]:
    """Indices of the frames (F,) that a person posed: keyed unlike most, or by a changed key of Keymark's."""
    paths = {bone_path(bone, channel) for bone in bones for channel in (*ALL_PATHS, "location")}
    curves = [curve for curve in _bone_curves(armature_object, action) if curve.data_path in paths]
    own: set[int] = set()
    every: set[int] = set()
    for curve in curves:
        keyed = {round(key.co[0]): key.type for key in curve.keyframe_points}
        made = {round(frame) for frame in unchanged_frames(curve, MOTION)}
        every |= set(keyed)
        if made:
            own |= set(keyed) - made
        else:
            animators = {round(frame) for frame in animator_frames(curve)}
            own |= {frame for frame in animators if keyed[frame] == "KEYFRAME"}
    if 2 * len(own) > len(every):
        return ()
    first = round(frames[0])
    return tuple(sorted(frame - first for frame in own if 0 <= frame - first < len(frames)))


def shown_poses(armature_object: Object, names: Iterable[str], space: Similarity) -> Array:
    """(N, 4, 4) poses of bones in the world [m] as shown now, unscaled, the object standing at `space`."""
    bones = evaluated(armature_object).pose.bones
    poses = np.array([bones[name].matrix for name in names], dtype=np.float64)
    poses[:, :3, :3] = space.rotation @ unscaled(poses[:, :3, :3])
    poses[:, :3, 3] = space.to_world(poses[:, :3, 3])
    return poses


def read_poses(
    armature_object: Object, action: Action, frames: Array, bones: Collection[str]
) -> Part[tuple[Poses, Array]]:
    """Poses (F, 4, 4) of bones in the world [m] at scene frames (F,), and the object's matrices (F, 4, 4)."""
    scene = next(iter(armature_object.users_scene), bpy.context.scene)
    found, objects = [], []

    def look() -> None:
        found.append(shown_poses(armature_object, bones, object_space(armature_object)))
        objects.append(np.array(evaluated(armature_object).matrix_world, dtype=np.float64))

    yield from each_frame(scene, frames, lambda: showing_action(armature_object, action), look)
    paths = np.array(found)
    if not np.isfinite(paths).all():
        what = f"Action '{action.name}' gives '{armature_object.name}'"
        raise InputError(f"{what} poses that are not numbers; delete the keys that are no numbers")
    return {name: paths[:, number] for number, name in enumerate(bones)}, np.array(objects)


def joint_paths(armature_object: Object) -> tuple[Array, float]:
    """(F, 13, 3) the principal points over the frames of a person's armature's scene [m], and their rate."""
    scene = next(iter(armature_object.users_scene), bpy.context.scene)
    frames = np.arange(scene.frame_start, scene.frame_end + 1, dtype=np.float64)
    rate = scene.render.fps / scene.render.fps_base
    if is_actor(armature_object):
        places: list[Array] = []
        run(each_frame(scene, frames, nullcontext, lambda: places.append(joint_places(armature_object))))
        return np.array(places), rate
    character_map = motion_map(armature_object, ()).character_map
    points = ArmaturePoints.of(RestBody.of(read_character(armature_object), character_map))
    bones = tuple(dict.fromkeys(points.bones))
    poses, _ = run(read_poses(armature_object, animated_action(armature_object), frames, bones))
    return points.of_poses(poses), rate
