"""Keying the actor's pose: the keyframe is posed from then on, and found ones around it are improved."""

import bpy

from ...core.body.human import HUMAN
from ..bridge.actions import assign_action
from ..shell.base_operator import BaseOperator, warn
from ..shell.contradictions import note_contradictions
from ..shell.keyed_frames import (
    invalidate_keyed_frames,
    new_keyframe_action,
    shows_keyframes,
    straighten_unposed,
)
from ..shell.notices import give_notices
from ..shell.requirements import actor, idle
from ..shell.takes import active_take
from .found_keyframes import known_matches
from .improve_neighbors import improve_neighbors


def key_pose(context: bpy.types.Context, take: bpy.types.PropertyGroup) -> int:
    """Key the actor's pose as it stands, in the take's keyframe Action at the current frame.

    Returns how many found keyframes around it were posed anew.
    """
    from ..bridge.keyframes import store_pose

    frame = context.scene.frame_current_final
    store_pose(take.armature, take.keyframe_action, HUMAN, frame)
    assign_action(take.armature, take.keyframe_action)
    note_contradictions(take, frame, ())
    take.offered.candidates.clear()
    invalidate_keyed_frames()
    return improve_neighbors(context, take, frame)


class KEYMARK_OT_store_keyframe(BaseOperator, bpy.types.Operator):
    """Key the actor's whole pose at the current frame in the keyframe Action, and show that Action"""

    bl_idname = "keymark.store_keyframe"
    bl_label = "Store Keyframe"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, idle)

    def run(self, context: bpy.types.Context) -> None:
        from ..bridge.actor_lengths import read_body
        from ..bridge.keyframes import NOTICEABLE_M
        from ..bridge.pose import read_posture

        scene = context.scene
        take = active_take(scene)
        armature_object = take.armature
        read = read_posture(armature_object, read_body(armature_object, HUMAN))
        if take.keyframe_action is None:
            take.keyframe_action = new_keyframe_action(armature_object)
        frame = scene.frame_current_final
        switched = not shows_keyframes(take)
        straighten_unposed(take)
        was_found = frame in known_matches(take)
        about = f"pose at {frame:g}"
        give_notices(take, "keyframes", about)
        improved = key_pose(context, take)
        if read.furthest_m > NOTICEABLE_M:
            sentence = (
                f"Stored at frame {frame:g}; the pose goes {1000.0 * read.furthest_m:.0f} mm beyond "
                "what the skeleton can do, and its nearest posture will be used"
            )
            give_notices(take, "keyframes", about, (warn(self, sentence),), frame=frame)
            return
        also = ""
        if improved:
            also = f"; {improved} found ones around it were posed anew"
        elif was_found:
            also = "; it was found, and counts as posed now"
        elif switched:
            also = "; the actor shows the keyframes now"
        self.report({"INFO"}, f"Stored a keyframe at frame {frame:g}{also}")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_store_keyframe,))
