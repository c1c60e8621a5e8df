"""Take the reconstructed pose as a keyframe, so that the animator only corrects it."""

import bpy

from ...core.body.human import HUMAN
from ..bridge.actions import assign_action
from ..bridge.scene_frames import at_scene_frame, showing_action
from ..shell.base_operator import BaseOperator
from ..shell.keyed_frames import invalidate_keyed_frames
from ..shell.keyframe_action import new_keyframe_action, straighten_unposed
from ..shell.requirements import actor, idle, motion
from ..shell.takes import active_take


class KEYMARK_OT_pose_from_motion(BaseOperator, bpy.types.Operator):
    """Store the reconstructed pose as a keyframe and show the keyframes, so that it only needs correcting"""

    bl_idname = "keymark.pose_from_motion"
    bl_label = "Add Keyframe Here"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, motion, idle)

    where: bpy.props.EnumProperty(
        name="Where",
        description="The frame whose pose is stored",
        items=[
            ("CURRENT", "Current Frame", "Store the pose of the scene's current frame"),
            ("WEAK", "Chosen Weak Frame", "Store the pose of the frame chosen in the list of weak frames"),
        ],
    )

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Key the motion's pose in the keyframe Action, and let that animate the actor."""
        from ..bridge.keyframes import store_pose

        scene = context.scene
        take = active_take(scene)
        review, frame = take.review, float(scene.frame_current_final)
        if self.where == "WEAK":
            if not 0 <= review.active_weak_frame < len(review.weak_frames):
                self.report({"ERROR"}, "No weak frame is chosen; reconstruct the motion first")
                return {"CANCELLED"}
            frame = float(review.weak_frames[review.active_weak_frame].frame)
        action = take.keyframe_action or new_keyframe_action(take.armature)
        with showing_action(take.armature, take.motion_action), at_scene_frame(scene) as go_to:
            go_to(frame)
            straighten_unposed(take)
            store_pose(take.armature, action, HUMAN, frame)
        take.keyframe_action = action
        assign_action(take.armature, action)
        whole = int(frame // 1.0)
        scene.frame_set(whole, subframe=frame - whole)
        invalidate_keyed_frames()
        self.report({"INFO"}, f"Stored the reconstructed pose at frame {frame:g}; now correct it")
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_pose_from_motion,))
