"""Base of the panels of the steps: one line, with the state and what to press, or open with all of it."""

from abc import abstractmethod
from typing import ClassVar

import bpy
from bpy.types import Context, PropertyGroup, UILayout

from .notices import notices_of
from .panel import TakePanel, draw_progress, draw_sentence, is_roomy, property_column
from .steps import is_behind
from .takes import active_take


class StepPanel(TakePanel):
    """The panel of a step: a subclass names the step and gives `draw_step`.

    Panels inside it, which name it as their parent, are hidden while it is folded.
    """

    bl_options = {"HIDE_HEADER"}
    bl_label: str
    step: ClassVar[str]  # a name of `steps.STEPS`
    options: ClassVar[str] = ""  # the popover of what is rarely changed

    def draw(self, context: Context) -> None:
        """Draw the header; where it is open, the notices and the step."""
        take = active_take(context.scene)
        header, body = self.layout.panel_prop(context.window_manager.keymark_steps, self.step)
        header.label(text=self.bl_label)
        self._draw_state(header, context, take)
        if body is None:
            self._draw_action(header, context, take)
            return
        if self.options:
            header.popover(self.options, text="", icon="PREFERENCES")
        for sentence in notices_of(take, self.step):
            draw_sentence(body, context, sentence, "ERROR")
        property_column(body)
        self.draw_step(context, body, take)

    def _draw_state(self, header: UILayout, context: Context, take: PropertyGroup) -> None:
        """Draw at the header's end what the step has come to, if it fits, or that something is wrong."""
        state = header.row()
        state.alignment = "RIGHT"
        state.active = False
        wrong = bool(notices_of(take, self.step)) or self.is_wrong(take)
        icon = "ERROR" if wrong else "CHECKMARK" if is_behind(take, self.step) else "NONE"
        state.label(text=self.summary(take) if is_roomy(context) else "", icon=icon, translate=False)

    def _draw_action(self, header: UILayout, context: Context, take: PropertyGroup) -> None:
        """Draw what is next in a step that is folded, where it can be pressed; or that it runs."""
        action, text = self.action(take)
        if not action or draw_progress(header, context, action):
            return
        group, _, name = action.partition(".")
        if getattr(getattr(bpy.ops, group), name).poll():
            button = header.row()
            button.alignment = "RIGHT"  # else it is cut before the rest of the line
            button.operator(action, text=text if is_roomy(context) else "", icon="PLAY", translate=False)

    @abstractmethod
    def draw_step(self, context: Context, body: UILayout, take: PropertyGroup) -> None:
        """Draw the step below its header, with properties in Blender's two columns."""

    @classmethod
    def summary(cls, take: PropertyGroup) -> str:
        """What the step has come to, in few letters; nothing by default."""
        return ""

    @classmethod
    def is_wrong(cls, take: PropertyGroup) -> bool:
        """Whether something is wrong with the step that its body tells of."""
        return False

    @classmethod
    def action(cls, take: PropertyGroup) -> tuple[str, str]:
        """The operator that is next while the step is folded, and a short label; none by default."""
        return "", ""
