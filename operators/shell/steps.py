"""The steps of the work in the sidebar: one is open, the one that the work has come to or a person opened.

Blender folds its own panels by mouse alone. A step's panel therefore has no header of Blender's, but one
that follows a property. What a person opened holds until the work comes to another step; it is kept for the
session and not in the file, and undo does not touch it.
"""

import bpy

from .fields import Group, Switch
from .take_state import STEPS, TakeState
from .takes import find_take, redraw_sidebars_soon

_chosen: dict[str, tuple[str, str]] = {}
"""By a take's identifier: the step that the work had come to when a person chose, and the one they opened."""
_kinds: dict[str, str] = {}
"""By a take's identifier, the kind of evidence whose settings are open."""


KINDS = ("markers", "keypoints", "tracks", "contours")
"""Kinds of evidence, whose settings fold in the same way."""


def is_open(take: bpy.types.PropertyGroup, name: str) -> bool:
    """Whether a step, or a kind of evidence, is open in the sidebar."""
    if name in KINDS:
        return name == _kinds.get(take.identifier, "markers" if len(take.markers) else "keypoints")
    reached = TakeState(take).next[0]
    chosen_at, chosen = _chosen.get(take.identifier, (reached, reached))
    return name == (chosen if chosen_at == reached else reached)


def open_step(take: bpy.types.PropertyGroup, name: str, opened: bool) -> None:
    """Open a step, or a kind of evidence, in the sidebar, which folds the others; or fold it."""
    if opened == is_open(take, name):
        return
    if name in KINDS:
        _kinds[take.identifier] = name if opened else ""
    else:
        _chosen[take.identifier] = TakeState(take).next[0], name if opened else ""


def _switch(name: str) -> "bpy.types.AnyType":
    def get(_steps: bpy.types.PropertyGroup) -> bool:
        take = find_take(bpy.context.scene)
        return take is not None and is_open(take, name)

    def set_(_steps: bpy.types.PropertyGroup, opened: bool) -> None:
        take = find_take(bpy.context.scene)
        if take is not None:
            open_step(take, name, opened)
            redraw_sidebars_soon()

    return Switch("Open", "Show this and fold the others", get=get, set=set_)


class KEYMARK_PG_steps(bpy.types.PropertyGroup):
    """Which steps of the active take are open; in the window manager, so that no file keeps it."""


KEYMARK_PG_steps.__annotations__ = {name: _switch(name) for name in (*STEPS, *KINDS)}


ATTACHED = {"WindowManager.keymark_steps": Group(type=KEYMARK_PG_steps)}
