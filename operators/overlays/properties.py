"""Properties of the overlays. Blender's own overlay switch hides all of them in the 3D viewport."""

from functools import partial

import bpy
from bpy.types import Context, PropertyGroup

from ..shell.fields import Number, Switch
from ..shell.takes import FOOTAGE_EDITORS, redraw_editors


def _changed(_settings: PropertyGroup, context: Context) -> None:
    from . import registry  # only now: panels and properties are registered before there is anything to draw

    registry.FAILURES.clear()
    redraw_editors(context, *FOOTAGE_EDITORS, "DOPESHEET_EDITOR")


def _only_character(settings: PropertyGroup, context: Context) -> None:
    for take in settings.id_data.keymark.takes:
        if take.armature is not None and take.armature.name in context.view_layer.objects:
            take.armature.hide_set(settings.only_character, view_layer=context.view_layer)
    _changed(settings, context)


_switch = partial(Switch, default=True, update=_changed)


class KEYMARK_PG_overlays(bpy.types.PropertyGroup):
    """The overlays' switches and looks."""

    only_character: Switch(
        "Just My Character",
        "Show the footage and the characters alone, without actors and what is drawn of them",
        update=_only_character,
    )
    show_observed: _switch("Observed Markers", "Outline each marker's region as found in the footage: solid")
    show_predicted: _switch(
        "Predicted Markers",
        "Outline each marker where the reconstructed motion puts it: a dashed line; without "
        "markers, the limbs and the trunk",
    )
    show_keypoints: _switch(
        "Keypoints",
        "Mark each keypoint with a cross where it is seen, with a ring where the motion puts it; "
        "a slanting cross is not believed, one in a square was seen on the other side of the body",
    )
    show_skeleton: _switch(
        "Skeleton", "Draw the body: left limbs solid, right ones hollow, uncertain points as rings"
    )
    show_candidates: _switch(
        "Candidates",
        "Draw the posture whose button the mouse is over, which a found keyframe may show too, as a faint "
        "figure in the button's color",
    )
    show_paths: _switch(
        "Paths",
        "Draw the paths of wrists and ankles: past solid, future dashed, diamonds at keyframes",
        default=False,
    )
    show_floor_grid: _switch(
        "Floor Grid",
        "Draw the floor as a grid of meters over the footage, and the horizon; if the camera is "
        "right, feet stand on it, and what is parallel on the floor is parallel in the grid",
        default=False,
    )
    show_timeline: _switch(
        "In the Timeline",
        "Speed in the footage, proposed and found keyframes, confidence and weak frames, in "
        "Timeline and Dope Sheet",
    )
    show_legend: _switch("Legend", "Explain lines and marks in a corner, and name the hidden markers")
    opacity: Number(
        "Opacity", "Opacity of all overlays", subtype="FACTOR", default=1.0, min=0.0, max=1.0, update=_changed
    )
