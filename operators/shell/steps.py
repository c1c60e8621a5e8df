"""The steps of the work in the sidebar: one is open, the one that the work has come to or a person opened.

Blender folds its own panels by mouse alone. A step's panel therefore has no header of Blender's, but one
that follows a property. What a person opened holds until the work comes to another step; it is kept for the
session and not in the file, and undo does not touch it.
"""

from collections.abc import Callable

import bpy

from .fields import Group, Switch
from .takes import find_take, placement_is_guess, present_actor, redraw_sidebars_soon

_chosen: dict[str, tuple[str, str]] = {}
"""By a take's identifier: the step that the work had come to when a person chose, and the one they opened."""
_kinds: dict[str, str] = {}
"""By a take's identifier, the kind of evidence whose settings are open."""


def _clip_is_seen(take: bpy.types.PropertyGroup) -> bool:
    """The clip is there, seen by a camera whose place is known."""
    there = take.clip is not None and not take.clip_state.missing and take.camera is not None
    return there and not placement_is_guess(take)


def _is_given_on(take: bpy.types.PropertyGroup) -> bool:
    """A character performs the newest motion, or its final Action is made."""
    results = [result for each in take.characters for result in each.results if result.action is not None]
    finished = take.finish.action is not None and not take.finish.outdated
    return finished or (bool(results) and not any(result.outdated for result in results))


STEPS: dict[str, Callable[[bpy.types.PropertyGroup], bool]] = {
    "footage": _clip_is_seen,
    "actor": lambda take: present_actor(take) is not None,
    "keyframes": lambda take: take.motion_action is not None,
    "reconstruct": _is_given_on,
    "character": lambda _take: False,
    "finish": lambda _take: False,
}
"""Name of each step, and whether a take's work has left it behind."""
KINDS = ("markers", "keypoints", "tracks", "contours")
"""Kinds of evidence, whose settings fold in the same way."""


def is_behind(take: bpy.types.PropertyGroup, step: str) -> bool:
    """Whether a take's work has left a step behind."""
    return STEPS[step](take)


def is_open(take: bpy.types.PropertyGroup, name: str) -> bool:
    """Whether a step, or a kind of evidence, is open in the sidebar."""
    if name in KINDS:
        return name == _kinds.get(take.identifier, "markers" if len(take.markers) else "keypoints")
    reached = _reached(take)
    chosen_at, chosen = _chosen.get(take.identifier, (reached, reached))
    return name == (chosen if chosen_at == reached else reached)


def open_step(take: bpy.types.PropertyGroup, name: str, opened: bool) -> None:
    """Open a step, or a kind of evidence, in the sidebar, which folds the others; or fold it."""
    if opened == is_open(take, name):
        return
    if name in KINDS:
        _kinds[take.identifier] = name if opened else ""
    else:
        _chosen[take.identifier] = _reached(take), name if opened else ""


def _reached(take: bpy.types.PropertyGroup) -> str:
    return next(step for step in STEPS if not is_behind(take, step))


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
