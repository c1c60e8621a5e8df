"""Properties of the overlays. Blender's own overlay switch hides all of them in the 3D viewport."""

import bpy

from . import registry


def _changed(_settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    registry.try_again()
    registry.redraw(context)


class KEYMARK_PG_overlays(bpy.types.PropertyGroup):
    """The overlays' switches and looks."""

    show_observed: bpy.props.BoolProperty(
        name="Observed Markers",
        description="Outline each marker's region as it was found in the footage: a solid line",
        default=True,
        update=_changed,
    )
    show_predicted: bpy.props.BoolProperty(
        name="Predicted Markers",
        description="Outline each marker where the reconstructed motion puts it: a dashed line; without "
        "markers, the limbs and the trunk",
        default=True,
        update=_changed,
    )
    show_keypoints: bpy.props.BoolProperty(
        name="Keypoints",
        description="Mark each keypoint with a cross where it is seen, with a ring where the motion puts it; "
        "a slanting cross is not believed, one in a square was seen on the other side of the body",
        default=True,
        update=_changed,
    )
    show_skeleton: bpy.props.BoolProperty(
        name="Skeleton",
        description="Draw the body: left limbs solid, right ones hollow, uncertain points as rings",
        default=True,
        update=_changed,
    )
    show_candidates: bpy.props.BoolProperty(
        name="Candidates",
        description="Draw what else a found keyframe may show as faint figures, in the colors and with the "
        "numbers of the buttons that take them",
        default=True,
        update=_changed,
    )
    show_paths: bpy.props.BoolProperty(
        name="Paths",
        description="Draw the paths of wrists and ankles: past solid, future dashed, diamonds at keyframes",
        default=False,
        update=_changed,
    )
    show_floor_grid: bpy.props.BoolProperty(
        name="Floor Grid",
        description="Draw the floor as a grid of meters over the footage, and the horizon; if the camera is "
        "right, feet stand on it, and what is parallel on the floor is parallel in the grid",
        default=False,
        update=_changed,
    )
    show_legend: bpy.props.BoolProperty(
        name="Legend",
        description="Explain lines and marks in a corner, and name the hidden markers",
        default=True,
        update=_changed,
    )
    show_timeline: bpy.props.BoolProperty(
        name="In the Timeline",
        description="Speed in the footage, proposed and found keyframes, confidence and weak frames, in "
        "Timeline and Dope Sheet",
        default=True,
        update=_changed,
    )
    opacity: bpy.props.FloatProperty(
        name="Opacity",
        description="Opacity of all overlays",
        subtype="FACTOR",
        default=1.0,
        min=0.0,
        max=1.0,
        update=_changed,
    )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PG_overlays,))
