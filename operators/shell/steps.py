"""The steps of the work, and which are folded in the sidebar: those that the work has left behind.

Blender folds its own panels by mouse alone. A step's panel therefore has no header of Blender's, but one
that follows a property: folded once the step is behind, until a person opens it. What a person chose holds
until the step's state changes; it is kept for the session and not in the file, and undo does not touch it.
"""

from collections.abc import Callable

import bpy

from .takes import find_take, placement_is_guess, present_actor

_chosen: dict[tuple[str, str], tuple[bool, bool]] = {}
"""By a take's identifier and a step: whether it was behind when a person chose, and whether it is open."""


def _footage_is_behind(take: bpy.types.PropertyGroup) -> bool:
    """Something is followed in a clip that is there, seen by a camera whose place is known."""
    if take.clip is None or take.clip_state.missing or take.camera is None or placement_is_guess(take):
        return False
    follow = take.follow
    picked = any(marker.is_picked for marker in take.markers)
    return picked or bool(len(follow.files) or len(follow.clicks)) or present_actor(take) is not None


def _posing_has_begun(take: bpy.types.PropertyGroup) -> bool:
    """Frames are proposed or keyed, be the actor there or gone."""
    return bool(len(take.proposals)) or take.keyframe_action is not None


def _is_posed(take: bpy.types.PropertyGroup) -> bool:
    """The same with the actor in the scene."""
    return present_actor(take) is not None and _posing_has_begun(take)


def _is_finished(take: bpy.types.PropertyGroup) -> bool:
    """There is a final Action of the newest motion: until then posing and reviewing go round."""
    return take.finish.action is not None and not take.finish.outdated and present_actor(take) is not None


def _is_on_a_character(take: bpy.types.PropertyGroup) -> bool:
    """A character performs the newest motion."""
    results = [result for each in take.characters for result in each.results if result.action is not None]
    return _is_finished(take) and bool(results) and not any(result.outdated for result in results)


STEPS: dict[str, Callable[[bpy.types.PropertyGroup], bool]] = {
    "footage": _footage_is_behind,
    "follow": _posing_has_begun,
    "actor": _is_posed,
    "keyframes": _is_finished,
    "reconstruct": _is_finished,
    "review": _is_finished,
    "finish": _is_on_a_character,
    "character": lambda _take: False,
}
"""Name of each step, and whether a take's work has left it behind."""


def is_behind(take: bpy.types.PropertyGroup, step: str) -> bool:
    """Whether a take's work has left a step behind."""
    return STEPS[step](take)


def is_open(take: bpy.types.PropertyGroup, step: str) -> bool:
    """Whether a step is open in the sidebar: as a person chose, else until it is behind."""
    behind = is_behind(take, step)
    chosen_behind, chosen = _chosen.get((take.identifier, step), (behind, not behind))
    return chosen if chosen_behind == behind else not behind


def open_step(take: bpy.types.PropertyGroup, step: str, opened: bool) -> None:
    """Open or fold a step in the sidebar."""
    _chosen[take.identifier, step] = is_behind(take, step), opened


def _switch(step: str) -> "bpy.types.AnyType":
    def get(_steps: bpy.types.PropertyGroup) -> bool:
        take = find_take(bpy.context.scene)
        return take is not None and is_open(take, step)

    def set_(_steps: bpy.types.PropertyGroup, opened: bool) -> None:
        take = find_take(bpy.context.scene)
        if take is not None:
            open_step(take, step, opened)

    return bpy.props.BoolProperty(
        name="Open", description="Show this step; one that is behind folds by itself", get=get, set=set_
    )


class KEYMARK_PG_steps(bpy.types.PropertyGroup):
    """Which steps of the active take are open; in the window manager, so that no file keeps it."""


KEYMARK_PG_steps.__annotations__ = {step: _switch(step) for step in STEPS}


def register() -> None:
    """Add the switches to the window manager."""
    bpy.utils.register_class(KEYMARK_PG_steps)
    bpy.types.WindowManager.keymark_steps = bpy.props.PointerProperty(type=KEYMARK_PG_steps)


def unregister() -> None:
    """Remove them."""
    del bpy.types.WindowManager.keymark_steps
    bpy.utils.unregister_class(KEYMARK_PG_steps)
