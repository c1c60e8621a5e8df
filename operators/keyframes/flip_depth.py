"""Flip a limb's depth: its image stays, and what leans toward the camera leans away."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.job_progress import job_is_running
from ..shell.requirements import actor, camera, footage, idle
from ..shell.takes import active_take
from .corrections import DRAGGING, camera_now, set_corrected, shown_pose
from .limb_selection import TITLES, limb_selected, selected_limbs

SELECTED = "SELECTED"


def limb_chosen(context: bpy.types.Context) -> str | None:
    """A limb is selected, or joints are being dragged, where the one under the mouse counts."""
    return None if job_is_running(context, DRAGGING) else limb_selected(context)


class KEYMARK_OT_flip_depth(BaseOperator, bpy.types.Operator):
    """Lean the selected limb away from the camera, not toward it, or back; press again for other ways"""

    bl_idname = "keymark.flip_depth"
    bl_label = "Flip Depth"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, camera, actor, limb_chosen, idle)

    limb: bpy.props.EnumProperty(
        name="Part",
        description="The part of the body that is flipped",
        items=[
            (SELECTED, "Selected", "The part of which a bone is selected"),
            *((name, title, "This part of the body") for name, title in TITLES.items()),
        ],
        options={"SKIP_SAVE"},
    )

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Flip the parts, and say which of several ways they are shown in."""
        take, scene = active_take(context.scene), context.scene
        limbs = selected_limbs(take) if self.limb == SELECTED else [self.limb]
        if not limbs:
            self.report({"WARNING"}, "Select a bone of an arm, a leg or the trunk first")
            return {"CANCELLED"}
        from .flip_ways import next_way

        seen = camera_now(scene, take)
        body, posture = shown_pose(take)
        said = []
        for limb in limbs:
            found = next_way(take.armature, scene.frame_current_final, limb, body, posture, seen)
            if found is not None:
                posture, number, count = found
                said.append(_said(limb, number, count))
        if not said:
            self.report(
                {"WARNING"}, "The selected part lies flat in the picture, or its joints allow no other way"
            )
            return {"CANCELLED"}
        set_corrected(self, context, take, posture)
        self.report({"INFO"}, "; ".join(said))
        return None


def _said(limb: str, number: int, count: int) -> str:
    title = TITLES[limb]
    if number == 0:
        return f"{title} as it was"
    return f"{title}: way {number} of {count}"


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_flip_depth,))
