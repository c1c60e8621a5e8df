"""An armature's Action mended, as an Action of its own on the same armature."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from bpy.types import Action, Object, Scene
from mathutils import Matrix

from ....core.arrays import Array
from ....core.body.human import HIPS
from ....core.body.skeleton import SIDES
from ....core.errors import InputError
from ....core.mend.mend_motion import PLACE_M, Mended, MendOptions, mend_motion
from ....core.progress import Job, Progress, run, stretch, within
from ....core.retarget.maps.character_map import CharacterMap
from ....core.retarget.mended_armature import ArmaturePoints, Poses, mended_poses
from ....core.retarget.solve.feet import rest_floor_m
from ....core.retarget.solve.rest_body import RestBody
from ....core.take.motion import Motion
from ..actions import assign_action, channelbag_for
from ..armature import build_armature
from ..blend_files import own_scene
from ..character.read_character import read_character
from ..character.retarget import show_result
from ..export_formats import write_bvh
from ..fcurves import write_motion
from ..keys import MOTION, POSED, Column, write_keys
from ..rotation_modes import ALL_PATHS, bone_path, rotation_path, rotation_values
from .read_poses import action_frames, animated_action, posed_frames, read_poses

SOURCE = "keymark_mended_from"  # custom property of a mended Action: the Action it was made from
SUFFIX = " Mended"
SHOWN_M = 0.01  # Blender shows a joint farther from where it was put if not its keys alone move it
LOOKED_AT = 5  # frames in which that is looked at


@dataclass(frozen=True, eq=False)
class MendedAction:
    """A mended motion of an armature, not yet written."""

    action: Action  # what it was made from
    frames: Array  # (F,) scene frames
    posed: tuple[int, ...]
    mended: Mended
    poses: Poses  # (F, 4, 4) of the bones that play a role, in the world [m]
    columns: tuple[Column, ...]


def mend_action(
    armature_object: Object,
    character_map: CharacterMap,
    named: Iterable[int] = (),
    plant_feet: bool = True,
    floor: bool = True,
) -> Job[MendedAction]:
    """Mend the Action of an armature whose bones a map names; nothing in Blender is changed.

    Posed are the frames that `posed_frames` finds and the scene frames that are `named`. An Action that was
    mended before is mended from what it was made from, with the poses that a person has set since. InputError
    where there is no Action, it cannot be mended, or a named frame is not in it.
    """
    yield Progress("Reading the motion", 0.0)
    action = animated_action(armature_object)
    character = read_character(armature_object)
    body = RestBody.of(character, character_map)
    roles = tuple(bone.name for bone in body.bones)
    rest = armature_object.data.bones
    wanted = {each.name for name in roles for each in (rest[name], *rest[name].parent_recursive)}
    bones = tuple(sorted(wanted, key=lambda name: len(rest[name].parent_recursive)))  # parents first
    source = action.get(SOURCE) if isinstance(action.get(SOURCE), bpy.types.Action) else action
    frames = action_frames(armature_object, source)
    first, last = round(frames[0]), round(frames[-1])
    for frame in named:
        if not first <= frame <= last:
            raise InputError(
                f"posed frame {frame} is not in Action '{action.name}'; its frames are {first} to {last}"
            )
    found = posed_frames(armature_object, action, roles, frames)
    posed = tuple(sorted({*found, *(frame - first for frame in named)}))
    reading = read_poses(armature_object, source, frames, bones)
    poses, objects = yield from within("Reading the motion", reading, 0.0, 0.2)
    points = ArmaturePoints.of(body)
    if source != action:
        reading = read_poses(armature_object, action, frames, bones)
        corrected, _ = yield from within("Reading the motion", reading, 0.2, 0.3)
        # They are where they were mended to, and at posed frames as a person has set them since.
        hips, before = (points.of_poses(each)[:, HIPS].mean(axis=1) for each in (corrected, poses))
        for name, pose in poses.items():
            pose[:, :3, 3] += hips - before
            pose[list(posed)] = corrected[name][list(posed)]
    ankle_m = float(np.mean([body.joint(f"foot.{side}")[2] for side in SIDES])) - rest_floor_m(body)
    place_m = PLACE_M if source == action else 0.002  # what was mended: a posed arm moves no hips
    options = MendOptions(posed, plant_feet, floor, place_m, ankle_m)
    scene = next(iter(armature_object.users_scene), bpy.context.scene)
    rate = scene.render.fps / scene.render.fps_base
    mending = mend_motion(points.of_poses(poses), rate, options, round(frames[0]))
    mended = yield from stretch(mending, 0.3, 0.8)
    yield Progress("Turning the bones", 0.8)
    made = mended_poses(points, poses, mended, np.array(posed, dtype=np.intp))
    columns = tuple(_columns(armature_object, poses, made, objects))
    return MendedAction(source, frames, posed, mended, made, columns)


def write_mended(armature_object: Object, found: MendedAction) -> Action:
    """Write a mended motion into a copy of its Action and assign that, if its keys alone move the bones."""
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
    looked = np.unique(np.linspace(0, len(found.frames) - 1, LOOKED_AT).round().astype(int))
    shown, _ = run(read_poses(armature_object, action, found.frames[looked], tuple(found.poses)))
    off = [shown[name][:, :3, 3] - pose[looked, :3, 3] for name, pose in found.poses.items()]
    wrong = float(np.linalg.norm(off, axis=-1).max())
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


def _columns(
    armature_object: Object, before: Poses, made: Poses, objects: Array
) -> Iterable[tuple[str, int, str, Array]]:
    """The curves of the bones that play a role: rotations in their own modes, and the hips' location."""
    bones, hips = armature_object.data.bones, next(iter(made))
    new: dict[str, Array] = {}
    for name, old in before.items():  # parents first
        parent = bones[name].parent
        carried = old if parent is None else new[parent.name] @ np.linalg.inv(before[parent.name]) @ old
        new[name] = made.get(name, carried)
    into, scale = np.linalg.inv(objects), np.linalg.norm(objects[:, :3, 0], axis=1)[:, None, None]
    local = {name: into @ pose for name, pose in new.items()}
    for poses in local.values():
        poses[:, :3, :3] *= scale  # axes of length one
    for name in made:
        bone, basis, above = bones[name], np.empty_like(local[name]), {}
        for frame, pose in enumerate(local[name]):
            if bone.parent is not None:
                above["parent_matrix"] = Matrix(local[bone.parent.name][frame])
                above["parent_matrix_local"] = bone.parent.matrix_local
            basis[frame] = bone.convert_local_to_pose(Matrix(pose), bone.matrix_local, **above, invert=True)
        mode = armature_object.pose.bones[name].rotation_mode
        values = {rotation_path(mode): rotation_values(basis[:, :3, :3], mode)}
        if name == hips:
            values["location"] = basis[:, :3, 3]
        for channel, columns in values.items():
            path = bone_path(name, channel)
            yield from ((path, index, name, column) for index, column in enumerate(columns.T))


def write_actor_bvh(motion: Motion, path: Path) -> None:
    """Write a motion as a BVH, from a scene of its own; ConversionError where Blender's exporter fails."""
    with own_scene("Mended Motion") as scene:
        frames = show_result(scene, None, motion)
        actor = build_armature(scene, motion.body, "Actor")
        write_motion(actor, motion, frames=np.asarray(frames))
        write_bvh(actor, path)


def add_actor(scene: Scene, motion: Motion, name: str, first: int | None = None) -> Object:
    """Add an actor with a motion to a scene, which keeps its rate; it begins at `first` or its own frame."""
    actor = build_armature(scene, motion.body, name)
    rate = scene.render.fps / scene.render.fps_base
    frames = (motion.frame_start if first is None else first) + motion.time_s * rate
    write_motion(actor, motion, frames=np.asarray(frames)).name = f"{name} Motion"
    return actor
