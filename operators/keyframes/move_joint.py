"""Move a joint of the actor to a place, as dragging does."""

import bpy
import numpy as np

from ...core.body.human import HUMAN
from ..keypoints.body_point_items import point_title
from ..shell.base_operator import BaseOperator
from ..shell.requirements import actor, idle
from ..shell.takes import active_take
from .corrections import set_corrected, shown_pose


class KEYMARK_OT_move_joint(BaseOperator, bpy.types.Operator):
    """Move a joint of the actor to a place; the limb follows, with its lengths and within its joint limits"""

    bl_idname = "keymark.move_joint"
    bl_label = "Move Joint"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, idle)

    joint: bpy.props.EnumProperty(
        name="Joint",
        description="The joint; left and right are the performer's own",
        items=[(name, point_title(name), "Move this joint") for name in HUMAN.point_names],
    )
    place: bpy.props.FloatVectorProperty(
        name="Place", description="Where to, in the world", subtype="TRANSLATION", size=3
    )
    sight: bpy.props.FloatVectorProperty(
        name="Line of Sight",
        description="Direction in which the view looks: along it the joint may end up elsewhere",
        subtype="DIRECTION",
        size=3,
        default=(0.0, 1.0, 0.0),
    )
    pushed: bpy.props.BoolProperty(
        name="In Depth", description="Whether the place along the line of sight counts as much as across it"
    )

    def run(self, context: bpy.types.Context) -> None:
        """Set the pose, and the keyframe of this frame if there is one."""
        from ...core.posing.dragged import dragged

        take = active_take(context.scene)
        body, posture = shown_pose(take)
        sight = np.array(self.sight, dtype=np.float64)
        sight /= max(float(np.linalg.norm(sight)), 1e-9)
        moved = dragged(body, posture, self.joint, np.array(self.place), sight, self.pushed)
        set_corrected(self, context, take, moved)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_move_joint,))
