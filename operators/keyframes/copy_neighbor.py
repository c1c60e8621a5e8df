"""Copy the pose of the keyframe before or after this frame."""

import bpy

from ...core.body.human import HUMAN
from ..shell.base_operator import BaseOperator
from ..shell.keyed_frames import SAME_FRAME, invalidate_keyed_frames, keyframes_of
from ..shell.requirements import actor, idle, keyframes
from ..shell.takes import active_take
from .corrections import set_corrected, shown_pose

DIRECTIONS = (
    ("PREVIOUS", "Previous", "Copy the pose of the keyframe before this frame; the performer stays in place"),
    ("NEXT", "Next", "Copy the pose of the keyframe after this frame; the performer stays in place"),
)


class KEYMARK_OT_copy_neighbor(BaseOperator, bpy.types.Operator):
    """Copy the pose of the keyframe before or after this frame; the performer stays in place"""

    bl_idname = "keymark.copy_neighbor"
    bl_label = "Copy from Neighbor"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, keyframes, idle)

    direction: bpy.props.EnumProperty(
        name="Neighbor", description="The keyframe whose pose is copied", items=DIRECTIONS
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return the tooltip for the direction."""
        return next(text for name, _, text in DIRECTIONS if name == properties.direction)

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Copy everything but the place."""
        from ...core.body.posture import Posture
        from ..bridge.pose import read_posture
        from ..bridge.scene_frames import at_scene_frame, showing_action

        take, scene = active_take(context.scene), context.scene
        invalidate_keyed_frames()
        neighbor = _neighbor(keyframes_of(take), scene.frame_current_final, self.direction)
        if neighbor is None:
            if self.direction == "NEXT":
                self.report({"INFO"}, "There is no keyframe after this frame")
            else:
                self.report({"INFO"}, "There is no keyframe before this frame")
            return {"CANCELLED"}
        body, here = shown_pose(take)
        with showing_action(take.armature, take.keyframe_action), at_scene_frame(scene) as go_to:
            go_to(neighbor)
            there = read_posture(take.armature, body).posture
        set_corrected(self, context, take, Posture(HUMAN, here.translation, there.rotations, there.angles))
        self.report({"INFO"}, f"Pose of frame {neighbor:g}, at the place of this one")
        return None


def _neighbor(frames: tuple[float, ...], here: float, direction: str) -> float | None:
    """The nearest keyed frame on one side of a frame."""
    if direction == "NEXT":
        return min((frame for frame in frames if frame > here + SAME_FRAME), default=None)
    return max((frame for frame in frames if frame < here - SAME_FRAME), default=None)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_copy_neighbor,))
