"""The sidebar: which of its steps is open, bases of its panels, and their rows."""

from abc import abstractmethod
from collections.abc import Callable
from textwrap import wrap
from typing import ClassVar

import bpy
from bpy.types import AnyType, Context, PropertyGroup, UILayout

from .fields import Group, Switch
from .job_progress import job_is_running, steady_frame
from .take_state import STEPS, TakeState
from .takes import active_take, find_take, redraw_sidebars_soon

_chosen: dict[str, tuple[str, str]] = {}
"""By a take's identifier: the step that the work had come to when a person chose, and the one they opened."""
_kinds: dict[str, str] = {}
"""By a take's identifier, the kind of evidence whose settings are open."""


KINDS = ("markers", "keypoints", "tracks", "contours")
"""Kinds of evidence, whose settings fold in the same way."""


def is_open(take: PropertyGroup, name: str) -> bool:
    """Whether a step, or a kind of evidence, is open in the sidebar."""
    if name in KINDS:
        return name == _kinds.get(take.identifier, "markers" if len(take.markers) else "keypoints")
    reached = TakeState(take).next[0]
    chosen_at, chosen = _chosen.get(take.identifier, (reached, reached))
    return name == (chosen if chosen_at == reached else reached)


def _switch(name: str) -> bpy.types.AnyType:
    def get(_steps: PropertyGroup) -> bool:
        take = find_take(bpy.context.scene)
        return take is not None and is_open(take, name)

    def set_(_steps: PropertyGroup, opened: bool) -> None:
        take = find_take(bpy.context.scene)
        if take is None or opened == is_open(take, name):
            return
        if name in KINDS:
            _kinds[take.identifier] = name if opened else ""
        else:
            _chosen[take.identifier] = TakeState(take).next[0], name if opened else ""
        redraw_sidebars_soon()

    return Switch("Open", "Show this and fold the others", get=get, set=set_)


class KEYMARK_PG_steps(bpy.types.PropertyGroup):
    """Which steps of the active take are open; in the window manager, so that no file keeps it."""


KEYMARK_PG_steps.__annotations__ = {name: _switch(name) for name in (*STEPS, *KINDS)}


ATTACHED = {"WindowManager.keymark_steps": Group(type=KEYMARK_PG_steps)}


ROOMY_PX = 270.0
"""Width of a sidebar, at a UI scale of 1, in which names and values, or two buttons, fit side by side."""
LINE_HEIGHT = 0.8  # height of a line of a sentence, in rows
LETTER_PX, MARGIN_PX = 6.2, 80.0
"""Width of a label's letter, and of what stands beside its text, at a UI scale of 1."""


class SidebarPanel:
    """A panel in the 3D viewport's sidebar, under the tab Keymark."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Keymark"


class SubPanel(SidebarPanel):
    """A panel inside the main panel, with properties in Blender's two columns."""

    bl_parent_id = "KEYMARK_PT_main"
    layout: UILayout

    def column(self) -> UILayout:
        return property_column(self.layout)


class Popover(SubPanel):
    """A panel that a button opens beside itself."""

    bl_parent_id = ""
    bl_options = {"INSTANCED"}
    bl_ui_units_x = 14


class TakePanel(SubPanel):
    """A panel of the active take; hidden without a take, and in a step that is folded."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Whether there is a take, and the step that the panel is in, if it is in one, is open."""
        take = find_take(context.scene)
        if take is None:
            return False
        parent = bpy.types.Panel.bl_rna_get_subclass_py(cls.bl_parent_id)
        step = getattr(parent, "step", "")
        return not step or is_open(take, step)


class RowList:
    """Mixin of a list: a subclass gives `draw_row`."""

    def draw_item(
        self,
        context: Context,
        layout: UILayout,
        data: AnyType,
        item: PropertyGroup,
        icon: int,
        active_data: AnyType,
        active_property: str,
    ) -> None:
        self.draw_row(context, layout, item)

    @abstractmethod
    def draw_row(self, context: Context, layout: UILayout, item: PropertyGroup) -> None:
        """Draw one item."""


def draw_progress(layout: UILayout, context: Context, *jobs: str) -> bool:
    """Draw the progress of the job that runs, any or these operators', on a line; return whether one runs."""
    progress = context.window_manager.keymark_progress
    if not progress.stage or not any(job_is_running(context, job) for job in jobs or ("",)):
        return False
    row = layout.row(align=True)
    percent = f"{100.0 * progress.fraction:.0f}%  {progress.stage}"  # a narrow sidebar cuts the end off
    row.progress(factor=progress.fraction, text=(jobs and progress.time_left) or percent)
    escape = row.row()
    escape.ui_units_x = 2.9
    escape.label(text="Esc", icon="CANCEL")
    return True


def property_column(layout: UILayout) -> UILayout:
    """A column of properties in Blender's two columns; in a narrow sidebar names are in the fields."""
    layout.use_property_split = is_roomy(bpy.context)
    layout.use_property_decorate = False
    return layout.column()


def side_by_side(layout: UILayout) -> UILayout:
    """Where buttons stand side by side; in a narrow sidebar, which cuts names, in a column."""
    return layout.row(align=True) if is_roomy(bpy.context) else layout.column(align=True)


def is_roomy(context: Context) -> bool:
    """Whether the sidebar that is drawn has room for two things in a row."""
    return context.region is None or unscaled_width(context) >= ROOMY_PX


def unscaled_width(context: Context) -> float:
    """Width of the sidebar that is drawn, at a UI scale of 1 [px]."""
    return float(context.region.width / (context.preferences.system.ui_scale or 1.0))


def draw_sentence(
    layout: UILayout,
    context: Context,
    sentence: str,
    icon: str = "DOT",
    most_lines: int | None = None,
    beside_px: float = 0.0,
) -> None:
    """Draw a sentence, wrapped to the sidebar less what is beside it; beyond the most lines are dots."""
    column = layout.column(align=True)
    column.scale_y = LINE_HEIGHT
    lines = _lines(context, sentence, most_lines, beside_px)
    for number, line in enumerate(lines):
        column.label(text=line, icon=icon if number == 0 else "BLANK1", translate=False)


def sentence_height(context: Context, sentence: str, beside_px: float = 0.0) -> float:
    """Height of what `draw_sentence` draws, in rows."""
    return LINE_HEIGHT * len(_lines(context, sentence, None, beside_px))


def _lines(context: Context, sentence: str, most_lines: int | None, beside_px: float) -> list[str]:
    letters = max(16, int((unscaled_width(context) - MARGIN_PX - beside_px) / LETTER_PX))
    kept = sentence.replace(" %", "\N{NO-BREAK SPACE}%")
    return wrap(kept, letters, max_lines=most_lines, placeholder=" ...")


def draw_contradictions(layout: UILayout, context: Context, state: TakeState) -> None:
    """Draw what no plausible pose explains in the current frame, in a line, if there is anything."""
    names = state.contradictions_at(steady_frame(context))
    if names:
        draw_sentence(layout, context, f"Unexplained: {', '.join(names)}", "ERROR", most_lines=1)


def right_end(layout: UILayout) -> UILayout:
    """The right end of a row."""
    row = layout.row()
    row.alignment = "RIGHT"
    return row


class StepPanel(TakePanel):
    """The panel of a step: a subclass names it and gives `draw_step`; folded, it hides those inside."""

    bl_options = {"HIDE_HEADER"}
    bl_label: str
    step: ClassVar[str]  # a name of `STEPS`
    options: ClassVar[str] = ""  # the popover of what is rarely changed
    summary: Callable[[TakeState], str] = staticmethod(
        lambda state: ""
    )  # what it has come to, in few letters
    is_wrong: Callable[[TakeState], bool] = staticmethod(lambda state: False)  # as its body tells
    action: Callable[[TakeState], tuple[str, str]] = staticmethod(lambda state: ("", ""))
    """The operator that is next while the step is folded, and a short label."""

    def draw(self, context: Context) -> None:
        """Draw the header; where it is open, the notices and the step."""
        state = TakeState(active_take(context.scene))
        header, body = self.layout.panel_prop(context.window_manager.keymark_steps, self.step)
        header.label(text=self.bl_label)
        # What the step has come to, if it fits, or that something is wrong.
        right = right_end(header)
        right.active = False
        wrong = bool(state.notices(self.step)) or self.is_wrong(state)
        is_behind = STEPS.index(self.step) < STEPS.index(state.next[0])
        icon = "ERROR" if wrong else "CHECKMARK" if is_behind else "NONE"
        right.label(text=self.summary(state) if is_roomy(context) else "", icon=icon, translate=False)
        if body is None:  # what is next in a folded step, where it can be pressed; or that it runs
            action, text = self.action(state)
            if action and not draw_progress(header, context, action):
                group, _, name = action.partition(".")
                if getattr(getattr(bpy.ops, group), name).poll():
                    words = text if is_roomy(context) else ""
                    # At the end, else it is cut before the rest of the line.
                    right_end(header).operator(action, text=words, icon="PLAY", translate=False)
            return
        if self.options:
            header.popover(self.options, text="", icon="PREFERENCES")
        for sentence in state.notices(self.step):
            draw_sentence(body, context, sentence, "ERROR")
        property_column(body)
        self.draw_step(context, body, state)

    @abstractmethod
    def draw_step(self, context: Context, body: UILayout, state: TakeState) -> None:
        """Draw the step below its header, with properties in Blender's two columns."""
