"""Fit the actor's pose to the markers and keypoints of the current frame."""

import bpy
import numpy as np

from ..keypoints.evidence import scene_evidence
from ..keypoints.requirements import points_to_follow
from ..matching.matches import known_matches
from ..shell.base_operator import BaseOperator
from ..shell.keyframe_action import show_keyframes
from ..shell.messages import say
from ..shell.requirements import actor, camera, footage, idle
from ..shell.results import reading_of
from ..shell.takes import active_take, footage_of


class KEYMARK_OT_fit_pose(BaseOperator, bpy.types.Operator):
    """Pose the actor so that markers and keypoints lie where this frame has them; you decide what is keyed"""

    bl_idname = "keymark.fit_pose"
    bl_label = "Fit Pose to Footage"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, camera, actor, points_to_follow, idle)

    start: bpy.props.EnumProperty(
        name="Start From",
        description="The pose that is changed as little as the footage allows",
        items=[
            (
                "KEYFRAMES",
                "Nearest Keyframes",
                "The keyframes before and after this frame; standing where none is stored yet",
            ),
            (
                "POSE",
                "Current Pose",
                "The pose as it is: set roughly by you, or applied from a pose library",
            ),
            ("STANDING", "Standing", "A body that stands where the performer is"),
        ],
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Fit the pose, and enter Pose Mode, so that the animator can correct it."""
        finished = self.execute(context)
        if finished == {"FINISHED"}:
            _to_pose_mode(context, active_take(context.scene).armature)
        return finished

    def run(self, context: bpy.types.Context) -> None:
        """Fit the pose, set it, and report its distance from the markers."""
        from ..bridge.pose import write_posture
        from ..bridge.single_frame_fit import fit_to_frame, frame_in_footage

        take = active_take(context.scene)
        frame = frame_in_footage(footage_of(context.scene, take), scene_evidence(take), reading_of(take))
        matches = known_matches(take)
        fit = fit_to_frame(frame, take.armature, take.keyframe_action, self.start, matches)
        show_keyframes(take)
        write_posture(take.armature, fit.posture)
        before, after = (
            np.concatenate(each)
            for each in ((fit.before_px, fit.keypoint_before_px), (fit.residual_px, fit.keypoint_residual_px))
        )
        if fit.misplaced:
            names = ", ".join(frame.styles[marker].name for marker in fit.misplaced)
            say(
                self,
                "WARNING",
                "No pose near the start explains the marker(s) {names}; correct the pose there by hand",
                names=names,
            )
        elif fit.misplaced_points:
            say(
                self,
                "WARNING",
                "No pose near the start explains the keypoint(s) {names}; correct the pose there by hand",
                names=", ".join(fit.misplaced_points),
            )
        elif not (np.isfinite(before).any() and np.isfinite(after).any()):
            say(
                self,
                "WARNING",
                "Seen from the camera, the body hides the markers that this frame shows; check the pose",
            )
        else:
            say(
                self,
                "INFO",
                "Off by {before:.1f} pixels before, {after:.1f} now; "
                "look at it from the side too, as little tells the depth, then store it",
                before=float(np.nanmean(before)),
                after=float(np.nanmean(after)),
            )


def _to_pose_mode(context: bpy.types.Context, armature_object: bpy.types.Object) -> None:
    """Make the actor active, in Pose Mode, if it is visible and no other object is being edited."""
    layer = context.view_layer
    active = layer.objects.active
    if armature_object.mode == "POSE" or (active is not None and active.mode != "OBJECT"):
        return
    if armature_object.visible_get(view_layer=layer):
        layer.objects.active = armature_object
        bpy.ops.object.mode_set(mode="POSE")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_fit_pose,))
