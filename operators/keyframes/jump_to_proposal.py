"""Go to the next or the previous proposed keyframe."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.keyed_frames import invalidate_keyed_frames, proposed_frames, unposed_proposals
from ..shell.takes import find_take


def proposals(context: bpy.types.Context) -> str | None:
    """The take has proposed keyframes."""
    return None if proposed_frames(find_take(context.scene)) else "Propose keyframes first"


class KEYMARK_OT_jump_to_proposal(BaseOperator, bpy.types.Operator):
    """Go to the next or the previous proposed keyframe"""

    bl_idname = "keymark.jump_to_proposal"
    bl_label = "Jump to Proposed Keyframe"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (proposals,)

    direction: bpy.props.EnumProperty(
        name="Direction",
        description="Direction from the current frame",
        items=[
            ("NEXT", "Next", "Go to the next proposed keyframe"),
            ("PREVIOUS", "Previous", "Go to the previous proposed keyframe"),
        ],
    )
    skip_posed: bpy.props.BoolProperty(
        name="Skip Posed",
        description="Skip proposed keyframes that are posed; after the last one comes the first",
        default=False,
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return the tooltip for the direction."""
        if properties.skip_posed:
            return "Go to the next proposed keyframe that is not posed yet"
        if properties.direction == "NEXT":
            return "Go to the next proposed keyframe"
        return "Go to the previous proposed keyframe"

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Go to the frame; if there is none, stay and report it."""
        scene, take = context.scene, find_take(context.scene)
        invalidate_keyed_frames()
        frames = unposed_proposals(take) if self.skip_posed else proposed_frames(take)
        if not frames:
            self.report({"INFO"}, "All proposed keyframes are posed")
            return {"CANCELLED"}
        ahead = [frame for frame in frames if frame > scene.frame_current]
        behind = [frame for frame in frames if frame < scene.frame_current]
        if self.skip_posed:  # wraps around the ends
            ahead, behind = ahead or frames, behind or frames
        if self.direction == "NEXT" and ahead:
            scene.frame_set(ahead[0])
        elif self.direction == "PREVIOUS" and behind:
            scene.frame_set(behind[-1])
        elif self.direction == "NEXT":
            self.report({"INFO"}, "There is no proposed keyframe after this frame")
            return {"CANCELLED"}
        else:
            self.report({"INFO"}, "There is no proposed keyframe before this frame")
            return {"CANCELLED"}
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_jump_to_proposal,))
