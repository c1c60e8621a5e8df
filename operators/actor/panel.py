"""The panel of the second step: the performer's actor, and what of the performer is followed in the clip."""

import bpy
from bpy.types import Context, UILayout

from ..bridge.actor_bones import is_actor
from ..follow.load_keypoints import draw_network
from ..follow.panel import draw_evidence, followed
from ..shell.panel import Popover, StepPanel, draw_sentence
from ..shell.take_state import TakeState
from ..shell.takes import active_take
from .properties import DESCRIPTIONS, LENGTHS, MIDDLE, SIDED


class KEYMARK_PT_actor(StepPanel, bpy.types.Panel):
    """The performer's height and armature, and the kinds of evidence."""

    bl_label = "Performer"
    step = "actor"
    options = "KEYMARK_PT_actor_options"
    summary = staticmethod(lambda s: f"{s.take.stature:.4g} m" if s.take.armature else followed(s.take))
    is_wrong = staticmethod(
        lambda s: s.has_lost_actor or (s.take.armature is not None and not is_actor(s.take.armature))
    )
    action = staticmethod(lambda s: ("", "") if s.take.armature else ("keymark.build_actor", "Build Actor"))

    def draw_step(self, context: Context, body: UILayout, state: TakeState) -> None:
        take = state.take
        column = body.column()
        if state.has_lost_actor:
            box = column.box().column()
            sentence = "The actor is gone from the scene"
            if take.keyframe_action is not None and take.motion_action is not None:
                sentence += "; its keyframes and its motion are kept"
            elif state.kept_actions:
                sentence += "; its keyframes are kept"
            draw_sentence(box, context, sentence, "ERROR")
            box.operator("keymark.apply_lengths", text="Bring Actor Back", icon="LOOP_BACK")
        elif take.armature is None:
            column.prop(take, "stature")
            row = column.row()
            row.scale_y = 1.4
            row.operator("keymark.build_actor", icon="OUTLINER_OB_ARMATURE")
        elif not is_actor(take.armature):
            sentence = "This is no actor of Keymark's; choose it in the step Character instead"
            draw_sentence(column, context, sentence, "ERROR")
            column.prop(take, "armature")
        draw_evidence(body, context, take)


class KEYMARK_PT_actor_options(Popover, bpy.types.Panel):
    """The actor's height and lengths, and whether a detector's depths count."""

    bl_label = "Performer Options"

    def draw(self, context: Context) -> None:
        take, column = active_take(context.scene), self.column()
        column.operator("keymark.measure_actor", text="Measure in This Frame", icon="ARROW_LEFTRIGHT")
        column.prop(take.follow, "use_depth_hints")
        draw_network(column)
        column.prop(take.follow, "use_hands")
        column.prop(take, "armature")
        if take.armature is None:
            return
        column.prop(take, "stature")
        column.operator("keymark.build_actor", text="Resize to Height", icon="OUTLINER_OB_ARMATURE")
        column.separator()
        lengths = take.lengths
        column.prop(lengths, "symmetric")
        for name in MIDDLE:
            column.prop(lengths, LENGTHS[name])
        for part in SIDED:
            group = column.column(align=True)
            if lengths.symmetric:
                group.prop(lengths, LENGTHS[f"{part}.L"], text=DESCRIPTIONS[part][0])
                continue
            group.prop(lengths, LENGTHS[f"{part}.L"])
            group.prop(lengths, LENGTHS[f"{part}.R"])
        column.operator("keymark.apply_lengths", icon="CHECKMARK")
