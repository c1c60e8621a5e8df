"""Jump through the frames worth another keyframe, the worst first."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.requirements import weak_frames
from ..shell.takes import active_take


class KEYMARK_OT_jump_to_weak_frame(BaseOperator, bpy.types.Operator):
    """Go to a frame that is worth another keyframe"""

    bl_idname = "keymark.jump_to_weak_frame"
    bl_label = "Jump to Weak Frame"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (weak_frames,)

    direction: bpy.props.EnumProperty(
        name="Direction",
        description="Listed frame to go to",
        items=[
            ("CHOSEN", "Chosen", "Go to the frame that is chosen in the list"),
            ("NEXT", "Next", "Go to the next frame of the list, which is less weak"),
            ("PREVIOUS", "Previous", "Go to the previous frame of the list, which is weaker"),
        ],
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Tooltip with the direction."""
        return {
            "CHOSEN": "Go to the frame that is chosen in the list",
            "NEXT": "Go to the next frame of the list; the worst comes first",
            "PREVIOUS": "Go to the previous frame of the list; the worst comes first",
        }[properties.direction]

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Go there; at the end of the list, stay and say so."""
        review = active_take(context.scene).review
        step = {"CHOSEN": 0, "NEXT": 1, "PREVIOUS": -1}[self.direction]
        # At first, the worst frame itself is the next one.
        chosen = review.weak_frames[min(review.active_weak_frame, len(review.weak_frames) - 1)]
        if self.direction == "NEXT" and abs(chosen.frame - context.scene.frame_current_final) > 1e-3:
            step = 0
        wanted = review.active_weak_frame + step
        if wanted < 0:
            self.report({"INFO"}, "This is the weakest frame")
            return {"CANCELLED"}
        if wanted >= len(review.weak_frames):
            self.report({"INFO"}, "This is the last frame of the list")
            return {"CANCELLED"}
        review.active_weak_frame = wanted  # which goes there
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_jump_to_weak_frame,))
