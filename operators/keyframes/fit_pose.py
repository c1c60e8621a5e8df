"""Fit the actor's pose to the markers and keypoints of the current frame."""

import bpy
import numpy as np

from ..keypoints.evidence import scene_evidence
from ..keypoints.requirements import points_to_follow
from ..matching.matches import known_matches
from ..shell.base_operator import BaseOperator
from ..shell.contradictions import note_contradictions
from ..shell.keyframe_action import show_keyframes
from ..shell.requirements import actor, camera, footage, idle
from ..shell.results import reading_of
from ..shell.takes import active_take, footage_of
from .offered_poses import offer_poses


class KEYMARK_OT_fit_pose(BaseOperator, bpy.types.Operator):
    """Pose the actor so that markers and keypoints lie where this frame has them; you decide what is keyed"""

    bl_idname = "keymark.fit_pose"
    bl_label = "Fit Pose to Footage"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, camera, actor, points_to_follow, idle)

    start: bpy.props.EnumProperty(
        name="Start From",
        description="What the pose may depend on beside what this frame shows",
        items=[
            (
                "KEYFRAMES",
                "Nearest Keyframes",
                "Any pose that this frame shows, whichever way the performer faces; keyframes near it count "
                "as well",
            ),
            (
                "POSE",
                "Current Pose",
                "The pose as it is, set roughly by you or applied from a pose library, is changed as little "
                "as the footage allows",
            ),
            ("ANEW", "Nothing", "Any pose that this frame shows, whatever the keyframes say"),
        ],
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Fit the pose, and enter Pose Mode, so that the animator can correct it."""
        finished = self.execute(context)
        if finished == {"FINISHED"}:
            _to_pose_mode(context, active_take(context.scene).armature)
        return finished

    def run(self, context: bpy.types.Context) -> None:
        """Fit the pose, set it, offer the others that the frame may show, and say what contradicts."""
        from ..bridge.pose import write_posture
        from ..bridge.single_frame_fit import fit_to_frame, frame_in_footage
        from ..library.registry_files import all_libraries

        scene = context.scene
        take = active_take(scene)
        frame = frame_in_footage(footage_of(scene, take), scene_evidence(take), reading_of(take))
        libraries = () if self.start == "POSE" else all_libraries()
        found = fit_to_frame(
            frame,
            take.armature,
            take.keyframe_action,
            self.start,
            known_matches(take),
            libraries,
            _floor_m(take.matching),
        )
        show_keyframes(take)
        write_posture(take.armature, found.candidates[0].posture)
        offer_poses(take, scene.frame_current_final, found.candidates)
        note_contradictions(take, scene.frame_current_final, found.contradictions)
        if found.contradictions:
            self.report(
                {"WARNING"},
                f"No plausible pose explains {', '.join(found.contradictions)} here; check what else "
                "looks like it, or pose the frame",
            )
        elif not np.isfinite(found.residual_px).any():
            self.report(
                {"WARNING"},
                "Seen from the camera, the body hides the markers that this frame shows; check the pose",
            )
        elif len(found.candidates) > 1:
            self.report(
                {"INFO"},
                f"{found.candidates[0].confidence:.0%} sure, {len(found.candidates) - 1} more in the "
                "panel; look at it from the side too, then store it",
            )
        else:
            self.report(
                {"INFO"},
                f"Off by {float(np.nanmean(found.residual_px)):.1f} pixels; look at it from the side "
                "too, as little tells the depth, then store it",
            )


def _floor_m(matching: bpy.types.PropertyGroup) -> float | None:
    """Height of the floor where it is given or was found [m]."""
    if matching.floor == "HEIGHT":
        return float(matching.floor_height)
    return float(matching.floor_found) if matching.is_property_set("floor_found") else None


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
