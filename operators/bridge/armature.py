"""Build the actor's armature from a body's lengths.

At rest the actor stands in a T pose on the floor of the object's own space, the hips above its origin.
A bone that stands for balls turns by quaternions. One that stands for hinges turns by Euler angles in the
order YZX: with Z locked that is bending about X after turning about Y, so the forearm's X and Y *are*
elbow flexion and pronation (the shin's, knee flexion and axial rotation) and no pole is ever near.
Locks keep the animator within the skeleton's freedoms. Ranges of motion are IK limits and not constraints:
they guide inverse kinematics and leave the evaluation of a keyed pose alone.
"""

from math import pi

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import ArrayLike

from ...core.body.kinematics import Body
from ...core.body.side_colors import side_of
from ...core.body.skeleton import JointKind, Skeleton
from .bone_colors import color_bones
from .bones import BoneModel, bone_models, rest_matrices, usual_mode

COLLECTIONS = {"L": "Left", "R": "Right", "": "Middle"}
"""Bone collection of each side."""
CONNECTED_M = 1e-6


def build_armature(scene: bpy.types.Scene, body: Body, name: str = "Actor") -> bpy.types.Object:
    """Add an armature for `body` to a scene and make it the active object of its first view layer.

    Args:
        scene: The scene to link it to.
        body: Skeleton and sizes.
        name: Name of object and armature data; Blender makes it unique.
    """
    armature = bpy.data.armatures.new(name)
    armature_object = bpy.data.objects.new(name, armature)
    scene.collection.objects.link(armature_object)
    models = bone_models(body)
    _add_bones(scene, armature_object, body, models)
    armature.display_type = "OCTAHEDRAL"
    armature_object.show_in_front = True
    armature_object.display_type = "WIRE"  # the footage is to be seen through it
    for side, title in COLLECTIONS.items():
        collection = armature.collections.new(title)
        for model in models:
            if side_of(model.name) == side:
                collection.assign(armature.bones[model.name])
    color_bones(armature)
    for model in models:
        _set_freedoms(armature_object.pose.bones[model.name], body.skeleton, model)
    return armature_object


def _add_bones(
    scene: bpy.types.Scene, armature_object: bpy.types.Object, body: Body, models: tuple[BoneModel, ...]
) -> None:
    rest = rest_matrices(body)
    layer = scene.view_layers[0]
    layer.objects.active = armature_object
    # Edit bones exist in edit mode only, which Blender enters for the active object of the context's layer.
    with bpy.context.temp_override(
        scene=scene, view_layer=layer, object=armature_object, active_object=armature_object
    ):
        bpy.ops.object.mode_set(mode="EDIT")
        edit_bones = armature_object.data.edit_bones
        for model in models:
            bone = edit_bones.new(model.name)
            head = rest[model.name][:3, 3]
            bone.head = head
            bone.tail = head + model.end - model.start
            bone.align_roll(Vector(model.axes[:, 2]))
            if model.parent:
                bone.parent = edit_bones[model.parent]
                bone.use_connect = (bone.head - bone.parent.tail).length < CONNECTED_M
        bpy.ops.object.mode_set(mode="OBJECT")


def _set_freedoms(pose_bone: bpy.types.PoseBone, skeleton: Skeleton, model: BoneModel) -> None:
    hinges = [skeleton.joints[i] for i in model.chain if skeleton.joints[i].kind is JointKind.HINGE]
    pose_bone.rotation_mode = usual_mode(skeleton, model)
    pose_bone.lock_scale = (True, True, True)
    pose_bone.lock_location = (not model.is_root,) * 3
    if hinges:
        free = [any(abs(model.axes[:, axis] @ joint.axis) > 0.5 for joint in hinges) for axis in range(3)]
        pose_bone.lock_rotation = [not axis for axis in free]
        pose_bone.lock_ik_x, pose_bone.lock_ik_y, pose_bone.lock_ik_z = (not axis for axis in free)
        for joint in hinges:
            _limit_ik(pose_bone, model, joint.axis, joint.limits_deg[0])
        return
    for index in model.chain:
        joint = skeleton.joints[index]
        for axis, limits in zip(np.eye(3), joint.limits_deg, strict=False):
            _limit_ik(pose_bone, model, axis, limits)


def _limit_ik(
    pose_bone: bpy.types.PoseBone,
    model: BoneModel,
    axis: ArrayLike,
    limits_deg: tuple[float, float],
) -> None:
    along = model.axes.T @ np.asarray(axis)  # the bone's own axes are the joint's up to order and sign
    column = int(np.argmax(np.abs(along)))
    low, high = np.radians(limits_deg) if along[column] > 0.0 else -np.radians(limits_deg)[::-1]
    letter = "xyz"[column]
    setattr(pose_bone, f"use_ik_limit_{letter}", True)
    # Blender keeps IK limits on their own side of rest: the lower at most 0, the upper at least 0.
    setattr(pose_bone, f"ik_min_{letter}", max(-pi, min(0.0, low)))
    setattr(pose_bone, f"ik_max_{letter}", min(pi, max(0.0, high)))
