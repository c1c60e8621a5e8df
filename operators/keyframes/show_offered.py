"""Pose the actor as another of the poses that the current frame may show."""

import bpy

from ..matching.candidate_titles import candidate_title
from ..shell.base_operator import BaseOperator
from ..shell.contradictions import note_contradictions
from ..shell.found_frames import offered_at
from ..shell.keyframe_action import show_keyframes
from ..shell.requirements import actor, idle
from ..shell.takes import active_take, find_take


class KEYMARK_OT_show_offered(BaseOperator, bpy.types.Operator):
    """Pose the actor like this; nothing is keyed until you store it"""

    bl_idname = "keymark.show_offered"
    bl_label = "Show Candidate"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, idle)

    candidate: bpy.props.IntProperty(
        name="Candidate", description="Index of the pose; 0 is the likeliest", default=0, min=0
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Tooltip with the pose's whole name, which a narrow sidebar cuts off."""
        take = find_take(context.scene)
        offered = None if take is None else offered_at(take, context.scene.frame_current_final)
        if offered is None or properties.candidate >= len(offered.candidates):
            return str(cls.__doc__)
        said = candidate_title(offered, offered.candidates[properties.candidate])
        return f"{said}. Pose the actor like this; nothing is keyed until you store it"

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Set the pose."""
        from ..bridge.candidate_posture import candidate_posture
        from ..bridge.pose import write_posture

        take, frame = active_take(context.scene), context.scene.frame_current_final
        offered = offered_at(take, frame)
        if offered is None:
            self.report({"ERROR"}, f"Frame {frame:g} offers no poses; fit it to the footage first")
            return {"CANCELLED"}
        if self.candidate >= len(offered.candidates):
            self.report(
                {"ERROR"},
                f"Frame {frame:g} offers {len(offered.candidates)} poses; candidate must be 0 to "
                f"{len(offered.candidates) - 1}",
            )
            return {"CANCELLED"}
        show_keyframes(take)
        write_posture(take.armature, candidate_posture(offered.candidates[self.candidate]))
        if offered.chosen != self.candidate:
            note_contradictions(take, frame, ())
        offered.chosen = self.candidate
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_show_offered,))
