"""Frames worth another keyframe: drawn as a list, jumped to and posed; the actor seen from the side."""

import bpy
import numpy as np
from bpy.types import Context, Event, Object, OperatorProperties, PropertyGroup, SpaceView3D, UILayout
from mathutils import Matrix, Vector

from ...core.errors import InputError
from ..bridge.actions import assign_action
from ..bridge.actor_bones import evaluated
from ..bridge.keyframes import store_pose
from ..bridge.scene_frames import at_scene_frame, show_frame, showing_action
from ..footage.camera_view import look_through
from ..shell import need
from ..shell.base_operator import BaseOperator, Unchanged, call, capitalized, reported
from ..shell.fields import Choice
from ..shell.keyed_frames import new_keyframe_action, straighten_unposed
from ..shell.panel import RowList, draw_sentence
from ..shell.take_state import TakeState
from ..shell.takes import active_take, areas


class KEYMARK_UL_weak_frames(RowList, bpy.types.UIList):
    """Weak frames, the one that needs a keyframe most first: frame, and reason."""

    def draw_row(self, context: Context, layout: UILayout, item: PropertyGroup) -> None:
        row = layout.row(align=True)
        number = row.row()
        number.ui_units_x = 2.2
        number.label(text=f"{item.frame:g}")
        reason = item.bl_rna.properties["reason"].enum_items[item.reason]
        row.label(text=reason_words(item), icon=reason.icon, translate=False)
        if TakeState(active_take(context.scene)).is_posed(item.frame):
            row.label(text="", icon="KEYTYPE_KEYFRAME_VEC")


def reason_words(item: PropertyGroup) -> str:
    """The reason of a weak frame, short enough for a row of a narrow sidebar, with what it lies with."""
    name = item.marker or item.point
    stem, _, side = name.partition(".")
    what = {"L": f"left {stem}", "R": f"right {stem}"}.get(side, name).replace("_", " ") or "the motion"
    words = {"HIDDEN": "is hidden", "FAST": "is fast", "FOOTAGE": "is off"}
    return "Keyframes are far" if item.reason == "FAR" else capitalized(f"{what} {words[item.reason]}")


def draw_review(column: UILayout, context: Context, state: TakeState) -> None:
    """Draw how sure the motion is, and the frames worth another keyframe."""
    from ...core.review.confidence import TOLERANCE_SHARE

    review = state.take.review
    if state.sure_by_poses:
        draw_sentence(column, context, state.take.matching.reason, "INFO")
    elif review.confidence >= 0.0:
        near_cm = 100.0 * TOLERANCE_SHARE * state.take.stature
        words = f"Joints Within {near_cm:.0f} cm: {100.0 * review.confidence:.0f} %"
        column.progress(factor=review.confidence, text=words, type="BAR")
    if not len(review.weak_frames):
        draw_sentence(column, context, "No frame needs another keyframe", "CHECKMARK")
        return
    column.label(text="Worth Another Keyframe")
    column.template_list(
        "KEYMARK_UL_weak_frames", "", review, "weak_frames", review, "active_weak_frame", rows=4
    )
    row = column.row(align=True)
    row.operator("keymark.jump_to_weak_frame", text="", icon="TRIA_UP").direction = "PREVIOUS"
    row.operator("keymark.pose_from_motion", icon="KEY_HLT").where = "WEAK"
    row.operator("keymark.jump_to_weak_frame", text="", icon="TRIA_DOWN").direction = "NEXT"


class KEYMARK_OT_jump_to_weak_frame(BaseOperator, bpy.types.Operator):
    """Go to a frame that is worth another keyframe"""

    bl_label = "Jump to Weak Frame"
    requirements = (need.weak_frames,)

    direction: Choice(
        "Direction",
        "Listed frame to go to",
        items=[
            ("CHOSEN", "Chosen", "Go to the frame that is chosen in the list"),
            ("NEXT", "Next", "Go to the next frame of the list; the worst comes first"),
            ("PREVIOUS", "Previous", "Go to the previous frame of the list; the worst comes first"),
        ],
    )

    @classmethod
    def description(cls, context: Context, properties: OperatorProperties) -> str:
        return properties.bl_rna.properties["direction"].enum_items[properties.direction].description

    def run(self, context: Context) -> None:
        review = active_take(context.scene).review
        step = {"CHOSEN": 0, "NEXT": 1, "PREVIOUS": -1}[self.direction]
        # At first, the worst frame itself is the next one.
        chosen = review.weak_frames[min(review.active_weak_frame, len(review.weak_frames) - 1)]
        if self.direction == "NEXT" and abs(chosen.frame - context.scene.frame_current_final) > 1e-3:
            step = 0
        wanted = review.active_weak_frame + step
        if wanted < 0:
            raise Unchanged("this is the weakest frame")
        if wanted >= len(review.weak_frames):
            raise Unchanged("this is the last frame of the list")
        review.active_weak_frame = wanted  # which goes there


class KEYMARK_OT_pose_from_motion(BaseOperator, bpy.types.Operator):
    """Store the reconstructed pose as a keyframe, and correct it at once by dragging its joints"""

    bl_label = "Add Keyframe Here"
    requirements = (need.actor, need.motion, need.idle)

    where: Choice(
        "Where",
        "The frame whose pose is stored",
        items=[
            ("CURRENT", "Current Frame", "Store the pose of the scene's current frame"),
            ("WEAK", "Chosen Weak Frame", "Store the pose of the frame chosen in the list of weak frames"),
        ],
    )

    def invoke(self, context: Context, event: Event) -> set[str]:
        done = self.execute(context)
        if done == {"FINISHED"}:
            with reported(self):
                call(bpy.ops.keymark.drag_joints, "INVOKE_DEFAULT")
        return done

    def run(self, context: Context) -> None:
        """Key the motion's pose in the keyframe Action, and let that animate the actor."""
        scene = context.scene
        take = active_take(scene)
        review, frame = take.review, float(scene.frame_current_final)
        if self.where == "WEAK":
            if not 0 <= review.active_weak_frame < len(review.weak_frames):
                raise InputError("no weak frame is chosen; reconstruct the motion first")
            left = TakeState(take).open_weak
            if left and review.active_weak_frame not in left:
                review.active_weak_frame = left[0]
            frame = float(review.weak_frames[review.active_weak_frame].frame)
        action = take.keyframe_action or new_keyframe_action(take.armature)
        with showing_action(take.armature, take.motion_action), at_scene_frame(scene) as go_to:
            go_to(frame)
            straighten_unposed(take)
            store_pose(take.armature, action, frame, TakeState(take).depth_is_found(frame))
        take.keyframe_action = action
        assign_action(take.armature, action)
        show_frame(scene, frame)
        self.report({"INFO"}, f"Stored the reconstructed pose at frame {frame:g}; now correct it")


class KEYMARK_OT_look_from_side(BaseOperator, bpy.types.Operator):
    """Look at the actor from the camera's right, where depth shows; once more, through the camera again"""

    bl_label = "Side View"
    bl_options = {"REGISTER"}
    requirements = (need.camera, need.actor)

    def run(self, context: Context) -> None:
        take, own = active_take(context.scene), context.space_data
        everywhere = [area.spaces.active for area in areas(context, "VIEW_3D")]
        spaces = [own] if isinstance(own, bpy.types.SpaceView3D) else everywhere
        for space in spaces:
            if space.region_3d.view_perspective != "CAMERA":
                look_through(space, context.scene, take.camera)
            else:
                look_from_side(space, take.camera, take.armature)


def look_from_side(space: SpaceView3D, camera_object: Object, armature_object: Object) -> None:
    """Let a viewport look at an actor across a camera's view, level, without perspective: depths show."""
    shown = evaluated(armature_object)
    ends = np.array([end for bone in shown.pose.bones for end in (bone.head, bone.tail)])
    center = shown.matrix_world @ Vector((ends.min(axis=0) + ends.max(axis=0)) / 2.0)
    height = max(float(bone.head_local.z) for bone in shown.data.bones) * max(shown.matrix_world.to_scale())
    right = Vector(evaluated(camera_object).matrix_world.to_3x3().col[0])
    right.z = 0.0
    backward, up = right.normalized(), Vector((0.0, 0.0, 1.0))
    view = space.region_3d
    view.view_perspective = "ORTHO"
    view.view_location = center
    view.view_rotation = Matrix((up.cross(backward), up, backward)).transposed().to_quaternion()
    view.view_distance = 2.6 * height  # all of it is seen, limbs stretched out too
