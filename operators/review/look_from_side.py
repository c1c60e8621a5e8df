"""Look at the actor from the footage's side, where depth shows, and back."""

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..bridge.object_space import evaluated
from ..footage.camera_view import look_through, viewports
from ..shell.base_operator import BaseOperator
from ..shell.requirements import actor, camera
from ..shell.takes import active_take

DISTANCE_HEIGHTS = 2.6
"""Distance of the view from the actor, in heights of its body: all of it is seen, limbs stretched out too."""


class KEYMARK_OT_look_from_side(BaseOperator, bpy.types.Operator):
    """Look at the actor from the camera's right, where depth shows; once more, through the camera again"""

    bl_idname = "keymark.look_from_side"
    bl_label = "Side View"
    bl_options = {"REGISTER"}
    requirements = (camera, actor)

    def run(self, context: bpy.types.Context) -> None:
        """Set the context's viewport, or all of them if the context is another editor."""
        take, own = active_take(context.scene), context.space_data
        spaces = [own] if isinstance(own, bpy.types.SpaceView3D) else list(viewports(context.window_manager))
        for space in spaces:
            if space.region_3d.view_perspective != "CAMERA":
                look_through(space, context.scene, take.camera)
            else:
                look_from_side(space, take.camera, take.armature)


def look_from_side(
    space: bpy.types.SpaceView3D, camera_object: bpy.types.Object, armature_object: bpy.types.Object
) -> None:
    """Let a viewport look at an actor across a camera's line of sight, the camera being on the left.

    The view is level and without perspective, so that depths can be compared.
    """
    shown = evaluated(armature_object)
    ends = np.array([end for bone in shown.pose.bones for end in (bone.head, bone.tail)])
    center = shown.matrix_world @ Vector((ends.min(axis=0) + ends.max(axis=0)) / 2.0)
    height = max(float(bone.head_local.z) for bone in shown.data.bones) * max(shown.matrix_world.to_scale())
    right = Vector(evaluated(camera_object).matrix_world.to_3x3().col[0])
    right.z = 0.0
    backward, up = right.normalized(), Vector((0.0, 0.0, 1.0))
    view = space.region_3d
    view.view_perspective = "ORTHO"
    view.view_location = center
    view.view_rotation = Matrix((up.cross(backward), up, backward)).transposed().to_quaternion()
    view.view_distance = DISTANCE_HEIGHTS * height


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_look_from_side,))
