"""Properties of a keyframe library that is made in this file: its details, postures and motions.

Blender's numbers have single precision. Times and travel are stored as text too, to the last digit, so that
a library passes through a file unchanged.
"""

from collections.abc import Callable
from contextlib import suppress

import bpy

from ....core.errors import InputError
from ..licenses import suggest

KEPT_DIGITS = 6
"""Decimals of a number that was typed: single precision has no more."""


def _get(exact: str) -> Callable[[bpy.types.PropertyGroup], float]:
    def get(group: bpy.types.PropertyGroup) -> float:
        return float(getattr(group, exact) or 0.0)

    return get


def _set(exact: str) -> Callable[[bpy.types.PropertyGroup, float], None]:
    def put(group: bpy.types.PropertyGroup, value: float) -> None:
        setattr(group, exact, repr(round(value, KEPT_DIGITS) + 0.0))
        _details_changed(group, bpy.context)

    return put


def _exact() -> "bpy.types.AnyType":
    return bpy.props.StringProperty(options={"HIDDEN"})


def _details_changed(part: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Write the library's details into its pose assets."""
    _update_assets(part, is_posture=False)


def _posture_changed(posture: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Write a posture's name and tags into its pose asset and the motions."""
    _update_assets(posture, is_posture=True)


def _update_assets(part: bpy.types.PropertyGroup, *, is_posture: bool) -> None:
    with suppress(InputError, ModuleNotFoundError):  # half typed; an export or a publication checks it
        from .asset_updates import details_changed, posture_changed

        (posture_changed if is_posture else details_changed)(part)


class KEYMARK_PG_library_line(bpy.types.PropertyGroup):
    """A line of text."""

    text: bpy.props.StringProperty(
        name="Source",
        description="Source of the postures, such as literature",
        update=_details_changed,
    )


class KEYMARK_PG_library_posture(bpy.types.PropertyGroup):
    """A posture: its name, and the pose asset that holds it."""

    name: bpy.props.StringProperty(
        name="Name", description="The posture's name, unique in its library", update=_posture_changed
    )
    selected: bpy.props.BoolProperty(
        name="Selected", description="Mark the posture, for operators on marked ones only", default=False
    )
    named: bpy.props.StringProperty(
        name="Named", description="The name that the motions know it by", options={"HIDDEN"}
    )
    tags: bpy.props.StringProperty(
        name="Tags",
        description="Words to find the posture by, with commas between them",
        update=_posture_changed,
    )
    exact_tags: bpy.props.StringProperty(
        name="Exact Tags", description="The tags before they were edited, as JSON", options={"HIDDEN"}
    )
    action: bpy.props.PointerProperty(
        name="Pose Asset", description="The Action that holds the posture", type=bpy.types.Action
    )


class KEYMARK_PG_library_step(bpy.types.PropertyGroup):
    """A step of a motion: a posture and its time."""

    posture: bpy.props.StringProperty(
        name="Posture", description="Posture of the step", update=_details_changed
    )
    time_exact: _exact()
    time_s: bpy.props.FloatProperty(
        name="Time (s)",
        description="Time from the start of the motion",
        min=0.0,
        max=3600.0,
        precision=4,
        step=1,
        get=_get("time_exact"),
        set=_set("time_exact"),
    )


class KEYMARK_PG_library_motion(bpy.types.PropertyGroup):
    """A motion through postures."""

    name: bpy.props.StringProperty(name="Name", description="The motion's name", update=_details_changed)
    cyclic: bpy.props.BoolProperty(
        name="Cyclic",
        description="After the last posture the first comes again, as in walking",
        update=_details_changed,
    )
    duration_exact: _exact()
    duration_s: bpy.props.FloatProperty(
        name="Duration (s)",
        description="Duration of the motion; of a cyclic one until the first posture comes again",
        min=0.0,
        max=3600.0,
        precision=4,
        step=1,
        get=_get("duration_exact"),
        set=_set("duration_exact"),
    )
    travel_x_exact: _exact()
    travel_y_exact: _exact()
    travel_turn_exact: _exact()
    travel_x: bpy.props.FloatProperty(
        name="Travel X",
        description="Travel of a cycle to the performer's left",
        subtype="DISTANCE",
        precision=4,
        get=_get("travel_x_exact"),
        set=_set("travel_x_exact"),
    )
    travel_y: bpy.props.FloatProperty(
        name="Y",
        description="Travel of a cycle backwards; negative: straight ahead",
        subtype="DISTANCE",
        precision=4,
        get=_get("travel_y_exact"),
        set=_set("travel_y_exact"),
    )
    travel_turn: bpy.props.FloatProperty(
        name="Turn",
        description="Turn of the performer to the left in a cycle",
        subtype="ANGLE",
        get=_get("travel_turn_exact"),
        set=_set("travel_turn_exact"),
    )
    steps: bpy.props.CollectionProperty(type=KEYMARK_PG_library_step)
    active_step: bpy.props.IntProperty(
        name="Active Step", description="The step that is chosen in the list", default=0, min=0
    )


class KEYMARK_PG_library(bpy.types.PropertyGroup):
    """A library that is made in this file."""

    identifier: bpy.props.StringProperty(
        name="Identifier",
        description="Identifier of the library in all its copies: letters a to z, digits, - and _",
        update=_details_changed,
    )
    name: bpy.props.StringProperty(name="Title", description="Title of the library", update=_details_changed)
    version: bpy.props.IntProperty(
        name="Version",
        description="Raise it with every change that you publish, so that others know which is newer",
        default=1,
        min=1,
        update=_details_changed,
    )
    author: bpy.props.StringProperty(
        name="Author", description="Author of the library", update=_details_changed
    )
    license: bpy.props.StringProperty(
        name="License",
        description="Terms under which others may use it, an SPDX expression such as CC0-1.0 or CC-BY-4.0; "
        "by default none",
        default="LicenseRef-Proprietary",
        search=suggest,
        search_options={"SUGGESTION"},
        update=_details_changed,
    )
    description: bpy.props.StringProperty(
        name="Description", description="Purpose of the library", update=_details_changed
    )
    tags: bpy.props.StringProperty(
        name="Tags",
        description="Words to find the library by, with commas between them",
        update=_details_changed,
    )
    exact_tags: bpy.props.StringProperty(
        name="Exact Tags", description="The tags before they were edited, as JSON", options={"HIDDEN"}
    )
    sources: bpy.props.CollectionProperty(type=KEYMARK_PG_library_line)
    actor: bpy.props.StringProperty(
        name="Actor", description="The proportions that the postures were posed on", options={"HIDDEN"}
    )
    postures: bpy.props.CollectionProperty(type=KEYMARK_PG_library_posture)
    active_posture: bpy.props.IntProperty(
        name="Active Posture", description="The posture that is chosen in the list", default=0, min=0
    )
    motions: bpy.props.CollectionProperty(type=KEYMARK_PG_library_motion)
    active_motion: bpy.props.IntProperty(
        name="Active Motion", description="The motion that is chosen in the list", default=0, min=0
    )


register, unregister = bpy.utils.register_classes_factory(
    (
        KEYMARK_PG_library_line,
        KEYMARK_PG_library_posture,
        KEYMARK_PG_library_step,
        KEYMARK_PG_library_motion,
        KEYMARK_PG_library,
    )
)
