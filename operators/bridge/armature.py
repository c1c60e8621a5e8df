"""Bones of the skeleton: one for each segment, with axes an animator can turn by hand.

A bone's Y runs along its segment. Its X is the axis of the segment's first hinge, so that a positive
turn about local X raises the girdle, bends the elbow and bends the knee, and a positive turn about local
Y pronates the forearm or turns the shin. A segment without a hinge takes the X of the segment that
continues it in a straight line (upper arm from forearm, thigh from shin), a rigid leaf that of its
parent (hand, foot), and all others the body's left. Left and right are then mirror images as Blender
defines them, so that pasting a pose flipped works.

The bone's axes define the joint's frame: `frame = bone rotation @ axes.T`, whatever the armature's rest
pose is. Editing the rest pose to an A pose, or applying the object's rotation, changes nothing.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import lru_cache
from math import pi

import bpy
import numpy as np
from bpy.types import EditBone, Object, Scene, bpy_prop_collection
from mathutils import Vector

from ...core.arrays import Array
from ...core.body.actor import Actor
from ...core.body.fingers import FINGER_BONES, finger_bones
from ...core.body.human import HUMAN, side_of
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.body.rotations import hinge
from ...core.body.skeleton import SIDES, JointKind, Placement
from ...core.errors import InputError
from ...core.retarget.character import Similarity
from .actor_bones import color_bones, missing_bones, object_space

MODES = ("OBJECT", "POSE")  # from which bones may be edited for a moment
HINGE_ORDER = "YZX"  # Euler angles of bones that hinges turn; all others have quaternions


@dataclass(frozen=True, eq=False)
class BoneModel:
    """A segment as a bone."""

    name: str
    parent: str | None  # None of the root, which carries the body's location in the world
    joint: int  # the joint whose frame the bone moves with
    chain: tuple[int, ...]
    """Elementary joints between the parent's frame and this one's, outermost last; empty for rigid leaves."""
    axes: Array  # (3, 3) the bone's axes at rest as columns, in the joint's frame
    start: Array  # (3,) the bone's head in its joint's frame [m]
    end: Array  # (3,) the bone's tail in its joint's frame [m]


def bone_models(body: Body) -> tuple[BoneModel, ...]:
    """The body's bones, parents first."""
    skeleton = body.skeleton
    along = {s.name: body.local(s.end) - body.local(s.start) for s in skeleton.segments}
    along = {name: np.asarray(way / np.linalg.norm(way)) for name, way in along.items()}
    chains: dict[str, tuple[int, ...]] = {}
    for segment in skeleton.segments:
        above = skeleton.segment(segment.parent).joint if segment.parent else -1
        chain = [segment.joint] if segment.joint != above else []
        while chain and skeleton.joints[chain[0]].parent != above:
            chain.insert(0, skeleton.joints[chain[0]].parent)
        chains[segment.name] = tuple(chain)
    hinges = {  # the axis of the first hinge of those that have any
        name: np.asarray(skeleton.joints[joint].axis)
        for name, chain in chains.items()
        for joint in reversed(chain)
        if skeleton.joints[joint].kind is JointKind.HINGE
    }
    axes: dict[str, Array] = {}
    models = []
    for segment in skeleton.segments:
        name, parent = segment.name, segment.parent
        straight_on = [
            s.name for s in skeleton.segments if s.parent == name and along[s.name] @ along[name] > 1.0 - 1e-6
        ]
        bending = [hinges[each] for each in (name, *straight_on) if each in hinges]
        if not bending:
            is_leaf = parent is not None and not chains[name]
            bending = [axes[str(parent)][:, 0] if is_leaf else np.array([1.0, 0.0, 0.0])]
        axes[name] = np.column_stack([bending[0], along[name], np.cross(bending[0], along[name])])
        start, end = body.local(segment.start), body.local(segment.end)
        models.append(BoneModel(name, parent, segment.joint, chains[name], axes[name], start, end))
    return tuple(models)


@dataclass(frozen=True, eq=False)
class ActorBones:
    """An actor's bones, parents first, as they rest in an armature."""

    models: tuple[BoneModel, ...]
    rest: Mapping[str, Array]  # (4, 4) rest matrix of each in the object's space
    modes: Mapping[str, str]  # rotation mode of each
    space: Similarity


@lru_cache(maxsize=4)
def bones_at_rest(body: Body) -> ActorBones:
    """The bones as `build_armature` builds them: a T pose on z = 0 [m], the object at the world's origin."""
    models = bone_models(body)
    origins = body.pose(Posture.rest(body.skeleton)).origin
    floor = min(float((origins[model.joint] + model.end)[2]) for model in models)
    rest = {}
    for model in models:
        rest[model.name] = matrix = np.eye(4)
        matrix[:3, :3] = model.axes
        matrix[:3, 3] = origins[model.joint] + model.start - [0.0, 0.0, floor]
    hinges = set(body.skeleton.hinge_joints)
    modes = {model.name: HINGE_ORDER if hinges & {*model.chain} else "QUATERNION" for model in models}
    return ActorBones(models, rest, modes, Similarity(np.eye(3), np.zeros(3), 1.0))


def finger_models(body: Body) -> tuple[BoneModel, ...]:
    """Bones of the fingers, which an actor has once a motion shows them; their X is what they bend about."""
    models = []
    for side in SIDES:
        hand = body.skeleton.segment(f"hand.{side}")
        wrist, parent = body.local(hand.start), hand.name
        length = float(np.linalg.norm(body.local(hand.end) - wrist))
        for name, start, end, axis in finger_bones(side):
            along = (end - start) / np.linalg.norm(end - start)
            axes = np.column_stack([axis, along, np.cross(axis, along)])
            ends = wrist + length * start, wrist + length * end
            above = hand.name if ".1." in name else parent
            models.append(BoneModel(name, above, hand.joint, (), axes, *ends))
            parent = name
    return tuple(models)


def build_armature(scene: Scene, body: Body, name: str = "Actor") -> Object:
    """Add an armature for `body` to a scene and make it the active object of its first view layer."""
    armature = bpy.data.armatures.new(name)
    armature_object = bpy.data.objects.new(name, armature)
    scene.collection.objects.link(armature_object)
    bones = bones_at_rest(body)
    with editing(armature_object) as edit_bones:
        for model in bones.models:
            bone = edit_bones.new(model.name)
            bone.head = bones.rest[model.name][:3, 3]
            bone.tail = bones.rest[model.name][:3, 3] + model.end - model.start
            bone.align_roll(Vector(model.axes[:, 2]))
            if model.parent:
                bone.parent = edit_bones[model.parent]
                bone.use_connect = (bone.head - bone.parent.tail).length < 1e-6
    scene.view_layers[0].objects.active = armature_object
    armature.display_type = "OCTAHEDRAL"
    armature_object.show_in_front = True
    armature_object.display_type = "WIRE"  # the footage is to be seen through it
    for side, title in {"L": "Left", "R": "Right", "": "Middle"}.items():
        collection = armature.collections.new(title)
        for model in bones.models:
            if side_of(model.name) == side:
                collection.assign(armature.bones[model.name])
    color_bones(armature.bones)
    for model in bones.models:
        pose_bone = armature_object.pose.bones[model.name]
        pose_bone.rotation_mode = bones.modes[model.name]
        # Locked is what a bone cannot do; its IK is limited to the joints' ranges.
        pose_bone.lock_scale, pose_bone.lock_location = (True,) * 3, (model.parent is not None,) * 3
        joints = [body.skeleton.joints[index] for index in model.chain]
        ranges = [pair for joint in joints for pair in zip(np.eye(3), joint.limits_deg, strict=False)]
        if bones.modes[model.name] == HINGE_ORDER:
            free = [any(abs(model.axes[:, axis] @ joint.axis) > 0.5 for joint in joints) for axis in range(3)]
            pose_bone.lock_rotation = [not axis for axis in free]
            pose_bone.lock_ik_x, pose_bone.lock_ik_y, pose_bone.lock_ik_z = (not axis for axis in free)
            ranges = [(joint.axis, joint.limits_deg[0]) for joint in joints]
        for axis, limits_deg in ranges:
            along = model.axes.T @ np.asarray(axis)  # the bone's axes are the joint's up to order and sign
            column = int(np.argmax(np.abs(along)))
            low, high = np.radians(limits_deg) if along[column] > 0.0 else -np.radians(limits_deg)[::-1]
            letter = "xyz"[column]
            setattr(pose_bone, f"use_ik_limit_{letter}", True)
            # Blender keeps IK limits on their own side of rest: the lower at most 0, the upper at least 0.
            setattr(pose_bone, f"ik_min_{letter}", max(-pi, min(0.0, low)))
            setattr(pose_bone, f"ik_max_{letter}", min(pi, max(0.0, high)))
    return armature_object


@contextmanager
def editing(armature_object: Object) -> "Iterator[bpy_prop_collection[EditBone]]":
    """The armature's edit bones, which exist in Edit Mode only; mode and active object are as before then."""
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
        with bpy.context.temp_override(object=armature_object, active_object=armature_object):
            bpy.ops.object.mode_set(mode="EDIT")
            try:
                yield armature_object.data.edit_bones
            finally:
                bpy.ops.object.mode_set(mode="OBJECT")
        armature_object.hide_set(hidden, view_layer=layer)
        layer.objects.active = active
        if mode != "OBJECT":
            with bpy.context.temp_override(object=active, active_object=active):
                bpy.ops.object.mode_set(mode=mode)


# --- An actor's lengths, read from an armature's bones in any rest pose, and set


ANY_BODY = Body(Actor.from_stature(1.7))  # bone axes are taken from it, and depend on no length


def skeleton_bones(armature_object: Object) -> tuple[BoneModel, ...]:
    """An actor's bones, parents first, rolled as they are where they rest in a T pose.

    Raises:
        InputError: It is no actor's armature.
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
    """Give an actor that can be edited bones for its fingers, which bend about X alone, where it has none."""
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
