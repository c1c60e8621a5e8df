"""Resize an actor: its bones get other lengths; its pose, keyframes and location stay."""

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.kinematics import Body
from ...core.errors import InputError
from .actor_lengths import skeleton_bones
from .bones import bone_models
from .object_space import object_space


def set_lengths(armature_object: bpy.types.Object, body: Body) -> None:
    """Set the lengths of an armature's bones to those of a body.

    Every bone keeps its direction at rest, whatever the rest pose is, and the hips keep their location, so
    that keyed poses stay where they were posed.

    Args:
        armature_object: An armature with the skeleton's bones, of even scale.
        body: Skeleton and sizes in the world.

    Raises:
        InputError: A bone is missing, the object is scaled unevenly, or the armature is not the file's own.
    """
    axes = {model.name: model.axes for model in skeleton_bones(armature_object, body.skeleton)}
    models = bone_models(body)
    scale = object_space(armature_object).scale
    _check_own(armature_object)
    segments = {segment.name: segment for segment in body.skeleton.segments}
    bones = armature_object.data.bones
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
    with _editing(armature_object) as edit_bones:
        for model in models:
            edit_bones[model.name].head = heads[model.name]
            edit_bones[model.name].tail = tails[model.name]


def _check_own(armature_object: bpy.types.Object) -> None:
    data = armature_object.data
    if armature_object.library is not None or data.library is not None or data.override_library is not None:
        raise InputError(
            f"armature '{armature_object.name}' comes from another file; change its lengths there, or "
            "make it local (Object > Relations > Make Local)"
        )


@contextmanager
def _editing(
    armature_object: bpy.types.Object,
) -> "Iterator[bpy.types.bpy_prop_collection[bpy.types.EditBone]]":
    """The armature's edit bones; the mode and the active object are as before afterwards."""
    scene = armature_object.users_scene[0]
    layer = scene.view_layers[0]
    if bpy.context.scene == scene:
        layer = bpy.context.view_layer
    active = layer.objects.active
    if active is not None and active.mode not in ("OBJECT", "POSE"):
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
