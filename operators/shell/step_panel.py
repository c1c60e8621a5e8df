"""Base of the panels of the steps: a header that folds by itself, a summary in it, and the step's notices."""

from abc import abstractmethod
from typing import ClassVar

import bpy

from .notices import notices_of
from .panel import TakePanel, draw_sentence, is_roomy, property_column
from .steps import is_behind
from .takes import active_take


class StepPanel(TakePanel):
    """The panel of a step: a subclass names the step and gives `draw_step`.

    Panels inside it, which name it as their parent, are hidden while it is folded.
    """

    bl_options = {"HIDE_HEADER"}
    bl_label: str
    step: ClassVar[str]  # a name of `steps.STEPS`

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the header; where it is open, the notices and the step."""
        take = active_take(context.scene)
        header, body = self.layout.panel_prop(context.window_manager.keymark_steps, self.step)
        header.label(text=self.bl_label)
        self._draw_state(header, context, take)
        if body is None:
            return
        column = body.column()
        for sentence in notices_of(take, self.step):
            draw_sentence(column, context, sentence, "ERROR")
        self._body = body
        self.draw_step(context)

    def _draw_state(
        self, header: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
    ) -> None:
        """Draw at the header's end what the step has come to, if it fits, or that something is wrong."""
        state = header.row()
        state.alignment = "RIGHT"
        state.active = False
        wrong = bool(notices_of(take, self.step)) or self.is_wrong(take)
        icon = "ERROR" if wrong else "CHECKMARK" if is_behind(take, self.step) else "NONE"
        state.label(text=self.summary(take) if is_roomy(context) else "", icon=icon, translate=False)

    def column(self) -> bpy.types.UILayout:
        """The step's column of properties."""
        return property_column(self._body)

    @property
    def body(self) -> bpy.types.UILayout:
        """The layout below the header."""
        return self._body

    @abstractmethod
    def draw_step(self, context: bpy.types.Context) -> None:
        """Draw the step."""

    @classmethod
    def summary(cls, take: bpy.types.PropertyGroup) -> str:
        """What the step has come to, in few letters; nothing by default."""
        return ""

    @classmethod
    def is_wrong(cls, take: bpy.types.PropertyGroup) -> bool:
        """Whether something is wrong with the step that its body tells of."""
        return False
