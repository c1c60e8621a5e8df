"""An armature's Action mended, as an Action of its own on the same armature."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

from ....core.arrays import Array
from ....core.body.skeleton import SIDES
from ....core.errors import InputError
from ....core.mend.mend_motion import HIPS, PLACE_M, Mended, MendOptions, mend_motion
from ....core.progress import Job, Progress, run, stretch, within
from ....core.retarget.maps.character_map import CharacterMap
from ....core.retarget.mended_armature import ArmaturePoints, Poses, mended_poses
from ....core.retarget.solve.foot_shape import rest_floor_m
from ....core.retarget.solve.rest_body import RestBody
from ....core.take.motion import Motion
from ..actions import assign_action, channelbag_for
from ..armature import build_armature
from ..blend_files import own_scene
from ..character.read_character import read_character
from ..character.source import show_result
from ..export_formats import write_bvh
from ..fcurves import write_motion
from ..keys import MOTION, POSED, write_keys
from ..rotation_modes import ALL_PATHS, bone_path, rotation_path, rotation_values
from .read_poses import action_frames, animated_action, posed_frames, read_poses

SOURCE = "keymark_mended_from"
"""Custom property of a mended Action: the Action it was made from."""
SUFFIX = " Mended"
MENDED_PLACE_M = 0.002  # usual error of a place that was mended: a posed arm moves no hips
SHOWN_M = 0.01
"""Farthest that Blender may show a joint from where it was put; else not its keys alone move it."""
LOOKED_AT = 5  # frames in which that is looked at


@dataclass(frozen=True, eq=False)
class MendedAction:
    """A mended motion of an armature, not yet written."""

    action: bpy.types.Action  # what it was made from
    frames: Array  # (F,) scene frames
    posed: tuple[int, ...]
    mended: Mended
    poses: Poses  # (F, 4, 4) of the bones that play a role, in the world [m]
    columns: tuple[tuple[str, int, str, Array], ...]
    """Data path, array index, bone and values (F,) of each curve."""


def mend_action(
    armature_object: bpy.types.Object,
    character_map: CharacterMap,
    named: Iterable[int] = (),
    plant_feet: bool = True,
    floor: bool = True,
) -> Job[MendedAction]:
    """Mend the Action of an armature whose bones a map names; nothing in Blender is changed.

    Posed are the frames that `posed_frames` finds and the scene frames that are `named`. An Action that was
    mended before is mended from what it was made from, with the poses that a person has set since.

    Raises:
        InputError: There is no Action, it cannot be mended, or a named frame is not in it.
    """
    yield Progress("Reading the motion", 0.0)
    action = animated_action(armature_object)
    character = read_character(armature_object)
    body = RestBody.of(character, character_map)
    roles = tuple(bone.name for bone in body.bones)
    bones = _with_ancestors(armature_object, roles)
    source = action.get(SOURCE) if isinstance(action.get(SOURCE), bpy.types.Action) else action
    frames = action_frames(armature_object, source)
    posed = _posed(armature_object, action, roles, frames, named)
    reading = read_poses(armature_object, source, frames, bones)
    poses, objects = yield from within("Reading the motion", reading, 0.0, 0.2)
    points = ArmaturePoints.of(body)
    if source != action:
        reading = read_poses(armature_object, action, frames, bones)
        corrected, _ = yield from within("Reading the motion", reading, 0.2, 0.3)
        poses = _corrected(points, poses, corrected, posed)
    ankle_m = float(np.mean([body.joint(f"foot.{side}")[2] for side in SIDES])) - rest_floor_m(body)
    place_m = PLACE_M if source == action else MENDED_PLACE_M
    options = MendOptions(posed, plant_feet, floor, place_m, ankle_m)
    scene = next(iter(armature_object.users_scene), bpy.context.scene)
    rate = scene.render.fps / scene.render.fps_base
    mending = mend_motion(points.of_poses(poses), rate, options, round(frames[0]))
    mended = yield from stretch(mending, 0.3, 0.8)
    yield Progress("Turning the bones", 0.8)
    made = mended_poses(points, poses, mended, np.array(posed, dtype=np.intp))
    columns = tuple(_columns(armature_object, poses, made, objects))
    return MendedAction(source, frames, posed, mended, made, columns)


def write_mended(armature_object: bpy.types.Object, found: MendedAction) -> bpy.types.Action:
    """Write a mended motion into a copy of its Action and assign that; all curves without a role are kept.

    Raises:
        InputError: Something else than these keys moves the bones; nothing is changed then.
    """
    data = armature_object.animation_data
    before = data.action, data.action_slot
    action = found.action.copy()
    action.name = f"{found.action.name}{SUFFIX}"
    action[SOURCE] = found.action
    slot = before[1].identifier if before[1] is not None else ""
    data.action = action
    own = next((each for each in action.slots if each.identifier == slot), None)
    if own is not None:
        data.action_slot = own
    elif data.action_slot is None:
        assign_action(armature_object, action)
    channelbag = channelbag_for(action, armature_object)
    turned = {bone_path(bone, channel) for bone in found.poses for channel in ALL_PATHS}
    written = turned | {path for path, *_ in found.columns}
    for curve in [curve for curve in channelbag.fcurves if curve.data_path in written]:
        channelbag.fcurves.remove(curve)
    posed = list(found.posed)
    if posed:
        own = [(path, index, bone, values[posed]) for path, index, bone, values in found.columns]
        write_keys(channelbag, own, found.frames[posed], POSED)
    write_keys(channelbag, found.columns, found.frames, MOTION)
    action.use_fake_user = True
    wrong = _farthest_m(armature_object, action, found)
    if wrong > SHOWN_M:
        data.action = before[0]
        if before[1] is not None:
            data.action_slot = before[1]
        bpy.data.actions.remove(action)
        raise InputError(
            f"the bones of '{armature_object.name}' are moved by constraints, drivers or controls and not by "
            f"their own keys ({1e3 * wrong:.0f} mm off); mend its motion onto another armature, such as a "
            "Keymark actor or a character"
        )
    return action


def _posed(
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    roles: tuple[str, ...],
    frames: Array,
    named: Iterable[int],
) -> tuple[int, ...]:
    first, last = round(frames[0]), round(frames[-1])
    found = set(posed_frames(armature_object, action, roles, frames))
    for frame in named:
        if not first <= frame <= last:
            raise InputError(
                f"posed frame {frame} is not in Action '{action.name}'; its frames are {first} to {last}"
            )
        found.add(frame - first)
    return tuple(sorted(found))


def _corrected(points: ArmaturePoints, poses: Poses, mended: Poses, posed: tuple[int, ...]) -> Poses:
    """The poses where they were mended to, and at posed frames as a person has set them since."""
    way = points.of_poses(mended)[:, HIPS].mean(axis=1) - points.of_poses(poses)[:, HIPS].mean(axis=1)
    found = {}
    for name, pose in poses.items():
        found[name] = np.array(pose)
        found[name][:, :3, 3] += way
        found[name][list(posed)] = mended[name][list(posed)]
    return found


def _with_ancestors(armature_object: bpy.types.Object, roles: Iterable[str]) -> tuple[str, ...]:
    """The bones of these names and all that carry them, parents first."""
    bones = armature_object.data.bones
    wanted = {each.name for name in roles for each in (bones[name], *bones[name].parent_recursive)}
    ordered = sorted((bones[name] for name in wanted), key=lambda bone: len(bone.parent_recursive))
    return tuple(bone.name for bone in ordered)


def _columns(
    armature_object: bpy.types.Object, before: Poses, made: Poses, objects: Array
) -> Iterable[tuple[str, int, str, Array]]:
    """The curves of the bones that play a role: rotations in their own modes, and the hips' location."""
    bones, pose_bones = armature_object.data.bones, armature_object.pose.bones
    into = np.linalg.inv(objects)
    new: dict[str, Array] = {}
    hips = next(iter(made))
    for name, old in before.items():  # parents first
        parent = bones[name].parent
        if name in made:
            new[name] = made[name]
        elif parent is None:
            new[name] = old
        else:
            new[name] = new[parent.name] @ np.linalg.inv(before[parent.name]) @ old
        if name not in made:
            continue
        bone, above = bones[name], {}
        places = _in_object(into, objects, new[name])
        carriers = places if parent is None else _in_object(into, objects, new[parent.name])
        basis = np.empty_like(places)
        for frame, (pose, carrier) in enumerate(zip(places, carriers, strict=True)):
            if parent is not None:
                above = {"parent_matrix": Matrix(carrier), "parent_matrix_local": parent.matrix_local}
            basis[frame] = bone.convert_local_to_pose(Matrix(pose), bone.matrix_local, **above, invert=True)
        mode = pose_bones[name].rotation_mode
        values = {rotation_path(mode): rotation_values(basis[:, :3, :3], mode)}
        if name == hips:
            values["location"] = basis[:, :3, 3]
        for channel, columns in values.items():
            path = bone_path(name, channel)
            yield from ((path, index, name, column) for index, column in enumerate(columns.T))


def _in_object(into: Array, objects: Array, poses: Array) -> Array:
    """Poses (F, 4, 4) of the world in the object's space, with axes of length one."""
    scale = np.linalg.norm(objects[:, :3, 0], axis=1)[:, None, None]
    local = into @ poses
    local[:, :3, :3] *= scale
    return np.asarray(local)


def _farthest_m(armature_object: bpy.types.Object, action: bpy.types.Action, found: MendedAction) -> float:
    """How far Blender shows a joint from where it was put, in a few frames [m]."""
    looked = np.unique(np.linspace(0, len(found.frames) - 1, LOOKED_AT).round().astype(int))
    shown, _ = run(read_poses(armature_object, action, found.frames[looked], tuple(found.poses)))
    return max(
        float(np.linalg.norm(shown[name][:, :3, 3] - found.poses[name][looked, :3, 3], axis=-1).max())
        for name in found.poses
    )


# --- A mended motion on Keymark's own armature


def write_actor_bvh(motion: Motion, path: Path) -> None:
    """Write a motion as a BVH, from a scene of its own.

    Raises:
        ConversionError: Blender's exporter failed.
    """
    with own_scene("Mended Motion") as scene:
        frames = show_result(scene, None, motion)
        actor = build_armature(scene, motion.body, "Actor")
        write_motion(actor, motion, frames=np.asarray(frames))
        write_bvh(actor, path)


def add_actor(
    scene: bpy.types.Scene, motion: Motion, name: str, first: int | None = None
) -> bpy.types.Object:
    """Add an actor with a motion to a scene, which keeps its rate; it begins at `first` or its own frame."""
    actor = build_armature(scene, motion.body, name)
    rate = scene.render.fps / scene.render.fps_base
    frames = (motion.frame_start if first is None else first) + motion.time_s * rate
    write_motion(actor, motion, frames=np.asarray(frames)).name = f"{name} Motion"
    return actor
