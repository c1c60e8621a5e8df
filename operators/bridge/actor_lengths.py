"""An actor's lengths, read from an armature's bones in any rest pose, and set."""

from collections.abc import Mapping
from dataclasses import replace

import bpy
import numpy as np
from bpy.types import EditBone, Object, bpy_prop_collection
from mathutils import Vector

from ...core.arrays import Array
from ...core.body.actor import Actor
from ...core.body.fingers import FINGER_BONES
from ...core.body.human import HUMAN
from ...core.body.kinematics import Body
from ...core.body.rotations import hinge
from ...core.body.skeleton import Placement
from ...core.errors import InputError
from .actor_bones import color_bones, missing_bones, object_space
from .armature import MODES, ActorBones, BoneModel, bone_models, editing, finger_models

ANY_BODY = Body(Actor.from_stature(1.7))  # bone axes are taken from it, and depend on no length


def skeleton_bones(armature_object: Object) -> tuple[BoneModel, ...]:
    """Keymark's bones, parents first, of an armature; InputError where it is none, or lacks some of them.

    Where the rest pose is a T pose, bones may be rolled about their own length, and their axes are rolled
    with them. In another rest pose a roll cannot be told from a posed bone, and counts as posed.
    """
    if armature_object is None or armature_object.type != "ARMATURE":
        name = "nothing" if armature_object is None else f"'{armature_object.name}'"
        raise InputError(f"{name} is not an armature; select the actor's armature")
    if missing := missing_bones(armature_object):
        raise InputError(
            f"armature '{armature_object.name}' lacks the bones {', '.join(missing)}; build an actor "
            "with Keymark and keep its bones' names"
        )
    models, bones = bone_models(ANY_BODY), armature_object.data.bones
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


def read_bones(armature_object: Object) -> ActorBones:
    """An armature's bones with any location, even scale, rest pose and rotation modes; raises as above."""
    models, bones = skeleton_bones(armature_object), armature_object.data.bones
    if has_fingers(armature_object):
        models += finger_models(ANY_BODY)
    rest = {model.name: np.array(bones[model.name].matrix_local, dtype=np.float64) for model in models}
    modes = {model.name: armature_object.pose.bones[model.name].rotation_mode for model in models}
    return ActorBones(models, rest, modes, object_space(armature_object))


def read_body(armature_object: Object) -> Body:
    """The sizes of an armature's bones in the world, the object's scale included.

    Every bone's own vector and its head's position in its parent's axes are linear in the actor's lengths;
    the lengths are their least-squares solution. Raises InputError where a bone is missing, the object is
    scaled unevenly, a length is out of range, or the bones do not lie as the skeleton's segments do.
    """
    models = {model.name: model for model in skeleton_bones(armature_object)}
    scale = object_space(armature_object).scale
    segments = {segment.name: segment for segment in HUMAN.segments}
    names = tuple(ANY_BODY.actor.segments_m)

    def factors(*signed: tuple[float, Placement]) -> Array:
        """A sum of placements as a matrix (3, lengths) from the actor's lengths to a vector."""
        matrix = np.zeros((3, len(names)))
        for sign, placement in signed:
            for name, share in placement.items():
                matrix[:, names.index(name)] += sign * np.asarray(share)
        return matrix

    rows: list[Array] = []
    vectors: list[Array] = []
    for name, model in models.items():
        bone, segment = armature_object.data.bones[name], segments[name]
        rows.append(factors((1.0, segment.end), (-1.0, segment.start)))
        vectors.append(model.axes[:, 1] * bone.length * scale)
        if model.parent is not None:
            joints = [(1.0, HUMAN.joints[i].placement) for i in model.chain]
            rows.append(factors(*joints, (1.0, segment.start), (-1.0, segments[model.parent].start)))
            local = bone.parent.matrix_local.inverted() @ bone.head_local
            vectors.append(models[model.parent].axes @ np.array(local) * scale)
    matrix, vector = np.concatenate(rows), np.concatenate(vectors)
    lengths = np.linalg.lstsq(matrix, vector, rcond=None)[0]
    body = Body(Actor(dict(zip(names, map(float, lengths), strict=True))))
    misfit = float(np.abs(matrix @ lengths - vector).max())
    if misfit > 0.01 * body.actor.stature_m:
        raise InputError(
            f"armature '{armature_object.name}' has bones {1000 * misfit:.0f} mm off Keymark's "
            "skeleton; build an actor with Keymark and change its lengths only"
        )
    return body


def set_lengths(armature_object: Object, body: Body) -> None:
    """Give an armature's bones the lengths of a body; hips, directions at rest and keyed poses stay."""
    axes = {model.name: model.axes for model in skeleton_bones(armature_object)}
    models = bone_models(body)
    scale = object_space(armature_object).scale
    data = armature_object.data
    if armature_object.library is not None or data.library is not None or data.override_library is not None:
        raise InputError(
            f"armature '{armature_object.name}' comes from another file; change its lengths there, or "
            "make it local (Object > Relations > Make Local)"
        )
    heads: dict[str, Array] = {}
    tails: dict[str, Array] = {}
    frames: dict[str, Array] = {}
    for model in models:
        name, bone = model.name, data.bones[model.name]
        frames[name] = np.array(bone.matrix_local, dtype=np.float64)[:3, :3] @ axes[name].T
        heads[name] = np.array(bone.head_local, dtype=np.float64)
        if model.parent is not None:
            local = model.start - body.local(HUMAN.segment(model.parent).start)
            local = local + sum(body.offsets[i] for i in model.chain)
            heads[name] = heads[model.parent] + frames[model.parent] @ local / scale
        tails[name] = heads[name] + frames[name] @ (model.end - model.start) / scale
    with editing(armature_object) as edit_bones:
        for name, head in heads.items():
            edit_bones[name].head, edit_bones[name].tail = head, tails[name]
        if has_fingers(armature_object):
            _place_fingers(edit_bones, body, axes, scale)


def has_fingers(armature_object: Object) -> bool:
    """Whether an actor has bones for its fingers."""
    return set(FINGER_BONES) <= set(armature_object.data.bones.keys())


def add_fingers(armature_object: Object, body: Body) -> None:
    """Give an actor bones for its fingers, each of which bends about its X alone, where it has none.

    One from another file, or one that is being edited, stays as it is.
    """
    data, active = armature_object.data, bpy.context.view_layer.objects.active
    kept = armature_object.library or data.library or data.override_library
    if has_fingers(armature_object) or kept or (active is not None and active.mode not in MODES):
        return
    axes = {model.name: model.axes for model in skeleton_bones(armature_object)}
    models = finger_models(body)
    with editing(armature_object) as edit_bones:
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
    edit_bones: "bpy_prop_collection[EditBone]", body: Body, axes: Mapping[str, Array], scale: float
) -> None:
    for model in finger_models(body):
        hand = edit_bones[f"hand.{model.name[-1]}"]
        frame = np.array(hand.matrix)[:3, :3] @ axes[hand.name].T
        wrist = body.local(HUMAN.segment(hand.name).start)
        bone = edit_bones[model.name]
        bone.head, bone.tail = (
            np.array(hand.head) + frame @ (end - wrist) / scale for end in (model.start, model.end)
        )
        bone.align_roll(Vector(frame @ model.axes[:, 2]))
