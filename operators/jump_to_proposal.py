"""Go to the next or the previous proposed keyframe."""

import bpy

from .takes import find_take


class KEYMARK_OT_jump_to_proposal(bpy.types.Operator):
    """Go to the next or the previous proposed keyframe"""

    bl_idname = "keymark.jump_to_proposal"
    bl_label = "Jump to Proposed Keyframe"
    bl_options = {"REGISTER", "UNDO"}

    direction: bpy.props.EnumProperty(
        name="Direction",
        description="Which way to go from the current frame",
        items=[
            ("NEXT", "Next", "Go to the next proposed keyframe"),
            ("PREVIOUS", "Previous", "Go to the previous proposed keyframe"),
        ],
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """The tooltip says which way."""
        return f"Go to the {properties.direction.lower()} proposed keyframe"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be proposals."""
        if _proposed(context.scene):
            return True
        cls.poll_message_set("Propose keyframes first")
        return False

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Go there; at the end, stay and say so."""
        scene = context.scene
        proposed = _proposed(scene)
        ahead = [frame for frame in proposed if frame > scene.frame_current]
        behind = [frame for frame in proposed if frame < scene.frame_current]
        if self.direction == "NEXT" and ahead:
            scene.frame_set(ahead[0])
        elif self.direction == "PREVIOUS" and behind:
            scene.frame_set(behind[-1])
        else:
            self.report({"INFO"}, f"There is no {self.direction.lower()} proposed keyframe")
            return {"CANCELLED"}
        return {"FINISHED"}


def _proposed(scene: bpy.types.Scene) -> list[int]:
    """The proposed scene frames, in order."""
    take = find_take(scene)
    return sorted({proposal.frame for proposal in take.proposals}) if take else []


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_jump_to_proposal,))
