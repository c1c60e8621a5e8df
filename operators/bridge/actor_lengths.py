"""An actor's lengths, read from an armature's bones in any rest pose, and set."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace

import bpy
import numpy as np
from mathutils import Vector

from ...core.arrays import Array
from ...core.body.actor import Actor
from ...core.body.fingers import FINGER_BONES
from ...core.body.kinematics import Body
from ...core.body.rotations import hinge
from ...core.body.skeleton import Placement, Skeleton
from ...core.errors import InputError
from .actor_bones import color_bones
from .armature import ActorBones, BoneModel, bone_models, editing, finger_models
from .object_space import object_space

MODES = ("OBJECT", "POSE")  # from which bones may be edited for a moment
ANY_STATURE_M = 1.7  # stature of the actor from which bone axes are taken; they do not depend on it


def skeleton_bones(armature_object: bpy.types.Object, skeleton: Skeleton) -> tuple[BoneModel, ...]:
    """The skeleton's bones, parents first, of an armature that has them all.

    Where the rest pose is a T pose, bones may be rolled about their own length, and their axes are rolled
    with them. In another rest pose a roll cannot be told from a posed bone, and counts as posed.

    Raises:
        InputError: The object is no armature, or lacks bones.
    """
    if armature_object is None or armature_object.type != "ARMATURE":
        name = "nothing" if armature_object is None else f"'{armature_object.name}'"
        raise InputError(f"{name} is not an armature; select the actor's armature")
    models = bone_models(Body(Actor.from_stature(ANY_STATURE_M), skeleton))
    bones = armature_object.data.bones
    missing = [model.name for model in models if model.name not in bones]
    if missing:
        raise InputError(
            f"armature '{armature_object.name}' lacks the bones {', '.join(missing)}; build an actor "
            "with Keymark and keep its bones' names"
        )
    rolled = []
    for model in models:
        rest = np.array(bones[model.name].matrix_local, dtype=np.float64)[:3, :3]
        turn = model.axes.T @ rest  # at rest in a T pose all joints' frames are the object's own
        if model.chain and np.linalg.norm(turn[:, 1] - [0.0, 1.0, 0.0]) > 1e-3:
            return models
        roll = float(np.arctan2(turn[0, 2], turn[0, 0]))
        about = hinge(np.array([0.0, 1.0, 0.0]), np.array(roll))
        rolled.append(replace(model, axes=model.axes @ about) if abs(roll) > 1e-4 else model)
    return tuple(rolled)


def read_bones(armature_object: bpy.types.Object, skeleton: Skeleton) -> ActorBones:
    """An armature's bones with any location, even scale, rest pose and rotation modes; raises as above."""
    models, bones = skeleton_bones(armature_object, skeleton), armature_object.data.bones
    if has_fingers(armature_object):
        models += finger_models(Body(Actor.from_stature(ANY_STATURE_M), skeleton))
    rest = {model.name: np.array(bones[model.name].matrix_local, dtype=np.float64) for model in models}
    modes = {model.name: armature_object.pose.bones[model.name].rotation_mode for model in models}
    return ActorBones(models, rest, modes, object_space(armature_object))


def read_body(armature_object: bpy.types.Object, skeleton: Skeleton) -> Body:
    """The sizes of an armature's bones in the world, the object's scale included.

    Every bone's own vector and its head's position in its parent's axes are linear in the actor's lengths;
    the lengths are their least-squares solution.

    Raises:
        InputError: A bone is missing, the object is scaled unevenly, a length is out of range, or the bones
            do not lie as the skeleton's segments do.
    """
    models = {model.name: model for model in skeleton_bones(armature_object, skeleton)}
    scale = object_space(armature_object).scale
    segments = {segment.name: segment for segment in skeleton.segments}
    names = tuple(Actor.from_stature(ANY_STATURE_M).segments_m)
    rows: list[Array] = []
    vectors: list[Array] = []
    for name, model in models.items():
        bone, segment = armature_object.data.bones[name], segments[name]
        rows.append(_factors(names, (1.0, segment.end), (-1.0, segment.start)))
        vectors.append(model.axes[:, 1] * bone.length * scale)
        if model.parent is not None:
            joints = [(1.0, skeleton.joints[i].placement) for i in model.chain]
            above = segments[model.parent]
            rows.append(_factors(names, *joints, (1.0, segment.start), (-1.0, above.start)))
            local = bone.parent.matrix_local.inverted() @ bone.head_local
            vectors.append(models[model.parent].axes @ np.array(local) * scale)
    matrix, vector = np.concatenate(rows), np.concatenate(vectors)
    lengths = np.linalg.lstsq(matrix, vector, rcond=None)[0]
    body = Body(Actor(dict(zip(names, map(float, lengths), strict=True))), skeleton)
    misfit = float(np.abs(matrix @ lengths - vector).max())
    if misfit > 0.01 * body.actor.stature_m:
        raise InputError(
            f"armature '{armature_object.name}' has bones {1000 * misfit:.0f} mm off Keymark's "
            "skeleton; build an actor with Keymark and change its lengths only"
        )
    return body


def _factors(names: tuple[str, ...], *signed: tuple[float, Placement]) -> Array:
    """A sum of placements as a matrix (3, lengths) from the actor's lengths to a vector."""
    matrix = np.zeros((3, len(names)))
    for sign, placement in signed:
        for name, share in placement.items():
            matrix[:, names.index(name)] += sign * np.asarray(share)
    return matrix


# --- Resize an actor


def set_lengths(armature_object: bpy.types.Object, body: Body) -> None:
    """Set the lengths of an armature's bones to those of a body.

    Every bone keeps its direction at rest, whatever the rest pose is, and the hips keep their location, so
    that keyed poses stay where they were posed.
    """
    axes = {model.name: model.axes for model in skeleton_bones(armature_object, body.skeleton)}
    models = bone_models(body)
    scale = object_space(armature_object).scale
    data = armature_object.data
    if armature_object.library is not None or data.library is not None or data.override_library is not None:
        raise InputError(
            f"armature '{armature_object.name}' comes from another file; change its lengths there, or "
            "make it local (Object > Relations > Make Local)"
        )
    segments = {segment.name: segment for segment in body.skeleton.segments}
    bones = data.bones
    heads: dict[str, Array] = {}
    tails: dict[str, Array] = {}
    frames: dict[str, Array] = {}
    for model in models:
        bone = bones[model.name]
        frames[model.name] = np.array(bone.matrix_local, dtype=np.float64)[:3, :3] @ axes[model.name].T
        if model.parent is None:
            head = np.array(bone.head_local, dtype=np.float64)
        else:
            local = model.start - body.local(segments[model.parent].start)
            local = local + sum(body.local(body.skeleton.joints[i].placement) for i in model.chain)
            head = heads[model.parent] + frames[model.parent] @ local / scale
        heads[model.name] = head
        tails[model.name] = head + frames[model.name] @ (model.end - model.start) / scale
    with _edited(armature_object) as edit_bones:
        for model in models:
            edit_bones[model.name].head = heads[model.name]
            edit_bones[model.name].tail = tails[model.name]
        if has_fingers(armature_object):
            _place_fingers(edit_bones, body, axes, scale)


def has_fingers(armature_object: bpy.types.Object) -> bool:
    """Whether an actor has bones for its fingers."""
    return set(FINGER_BONES) <= set(armature_object.data.bones.keys())


def add_fingers(armature_object: bpy.types.Object, body: Body) -> None:
    """Give an actor bones for its fingers, each of which bends about its X alone, where it has none.

    One from another file, or one that is being edited, stays as it is.
    """
    data, active = armature_object.data, bpy.context.view_layer.objects.active
    kept = armature_object.library or data.library or data.override_library
    if has_fingers(armature_object) or kept or (active is not None and active.mode not in MODES):
        return
    axes = {model.name: model.axes for model in skeleton_bones(armature_object, body.skeleton)}
    models = finger_models(body)
    with _edited(armature_object) as edit_bones:
        for model in models:
            edit_bones.new(model.name).parent = edit_bones[str(model.parent)]
        _place_fingers(edit_bones, body, axes, object_space(armature_object).scale)
    color_bones(data.bones[model.name] for model in models)
    for model in models:
        for collection in data.bones[str(model.parent)].collections:
            collection.assign(data.bones[model.name])
        bone = armature_object.pose.bones[model.name]
        bone.rotation_mode, bone.lock_rotation = "XYZ", (False, True, True)
        bone.lock_location = bone.lock_scale = (True, True, True)


def _place_fingers(
    edit_bones: "bpy.types.bpy_prop_collection[bpy.types.EditBone]",
    body: Body,
    axes: Mapping[str, Array],
    scale: float,
) -> None:
    for model in finger_models(body):
        hand = edit_bones[f"hand.{model.name[-1]}"]
        frame = np.array(hand.matrix)[:3, :3] @ axes[hand.name].T
        wrist = body.local(body.skeleton.segment(hand.name).start)
        bone = edit_bones[model.name]
        bone.head, bone.tail = (
            np.array(hand.head) + frame @ (end - wrist) / scale for end in (model.start, model.end)
        )
        bone.align_roll(Vector(frame @ model.axes[:, 2]))


@contextmanager
def _edited(
    armature_object: bpy.types.Object,
) -> "Iterator[bpy.types.bpy_prop_collection[bpy.types.EditBone]]":
    """The armature's edit bones; the mode and the active object are as before afterwards."""
    scene = armature_object.users_scene[0]
    layer = bpy.context.view_layer if bpy.context.scene == scene else scene.view_layers[0]
    active = layer.objects.active
    if active is not None and active.mode not in MODES:
        raise InputError(f"leave the mode that '{active.name}' is in first (Tab)")
    mode = "OBJECT" if active is None else active.mode
    hidden = armature_object.hide_get(view_layer=layer)
    with bpy.context.temp_override(scene=scene, view_layer=layer):
        if mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        armature_object.hide_set(False, view_layer=layer)
        layer.objects.active = armature_object
        with editing(scene, layer, armature_object) as edit_bones:
            yield edit_bones
        armature_object.hide_set(hidden, view_layer=layer)
        layer.objects.active = active
        if mode != "OBJECT":
            with bpy.context.temp_override(object=active, active_object=active):
                bpy.ops.object.mode_set(mode=mode)
