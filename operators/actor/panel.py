"""The panels of step 3: the actor and its lengths."""

import bpy

from ..bridge.actor_bones import is_actor
from ..shell.panel import TakePanel, draw_sentence
from ..shell.step_panel import StepPanel
from ..shell.takes import active_take, has_lost_actor, kept_actions
from .properties import MIDDLE, SIDED, length_property


class KEYMARK_PT_actor(StepPanel, bpy.types.Panel):
    """The armature, and the operators that build or measure it."""

    bl_label = "Actor"
    step = "actor"

    @classmethod
    def summary(cls, take: bpy.types.PropertyGroup) -> str:
        return "" if take.armature is None else f"{take.stature:.4g} m"

    @classmethod
    def is_wrong(cls, take: bpy.types.PropertyGroup) -> bool:
        return has_lost_actor(take) or (take.armature is not None and not is_actor(take.armature))

    def draw_step(self, context: bpy.types.Context) -> None:
        take, column = active_take(context.scene), self.column()
        if has_lost_actor(take):
            _draw_lost(column, context, take)
        column.prop(take, "stature")
        row = column.row(align=True)
        row.scale_y = 1.2
        text = "Build Actor" if take.armature is None else "Use Average Proportions"
        row.operator("keymark.build_actor", text=text, icon="OUTLINER_OB_ARMATURE", translate=False)
        column.operator("keymark.measure_actor", text="Measure in This Frame", icon="ARROW_LEFTRIGHT")
        column.separator()
        column.prop(take, "armature")
        if take.armature is not None and not is_actor(take.armature):
            sentence = "This is no actor of Keymark's; choose it in the step Character instead"
            draw_sentence(column, context, sentence, "ERROR")


def _draw_lost(layout: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup) -> None:
    """Draw that the actor is gone, what of it is kept, and the button that brings it back."""
    box = layout.box().column()
    if take.keyframe_action is not None and take.motion_action is not None:
        sentence = "The actor is gone from the scene; its keyframes and its motion are kept"
    elif kept_actions(take):
        sentence = "The actor is gone from the scene; its keyframes are kept"
    else:
        sentence = "The actor is gone from the scene"
    draw_sentence(box, context, sentence, "ERROR")
    box.operator("keymark.apply_lengths", text="Bring Actor Back", icon="LOOP_BACK")


class KEYMARK_PT_actor_lengths(TakePanel, bpy.types.Panel):
    """The lengths of the actor's segments."""

    bl_label = "Lengths"
    bl_parent_id = "KEYMARK_PT_actor"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and active_take(context.scene).armature is not None

    def draw(self, context: bpy.types.Context) -> None:
        lengths, column = active_take(context.scene).lengths, self.column()
        column.prop(lengths, "symmetric")
        for name in MIDDLE:
            column.prop(lengths, length_property(name))
        for part in SIDED:
            group = column.column(align=True)
            if lengths.symmetric:
                group.prop(lengths, length_property(f"{part}.L"), text=part.replace("_", " ").title())
                continue
            group.prop(lengths, length_property(f"{part}.L"))
            group.prop(lengths, length_property(f"{part}.R"))
        column.separator()
        column.operator("keymark.apply_lengths", icon="CHECKMARK")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PT_actor, KEYMARK_PT_actor_lengths))
