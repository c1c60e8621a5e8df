"""A take's actor in its scene: added, resized, and where the performer stands."""

from typing import TYPE_CHECKING

import bpy

from ...core.body.kinematics import Body
from ...core.errors import InputError
from ..bridge.armature import build_armature
from ..bridge.resize import set_lengths
from ..keypoints.evidence import scene_evidence
from ..shell.results import reading_of
from ..shell.takes import footage_of
from .properties import length_names, length_property

if TYPE_CHECKING:
    from ...core.body.posture import Posture
    from ...core.footage.region_tracks import RegionTracks

SYMMETRY_TOLERANCE_M = 5e-4
"""Left and right count as equally long within this."""


def add_actor(context: bpy.types.Context, take: bpy.types.PropertyGroup, body: Body) -> bpy.types.Object:
    """Build a take's armature, selected and active, and return the armature object.

    The take's keyframe Action and motion Action, those of another armature, are unset.
    """
    scene, layer = context.scene, context.view_layer
    if layer.objects.active is not None and layer.objects.active.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for selected in list(layer.objects.selected):
        selected.select_set(False, view_layer=layer)
    armature_object = build_armature(scene, body, f"{take.name} Actor")
    armature_object.select_set(True, view_layer=layer)
    layer.objects.active = armature_object
    take.armature = armature_object
    take.keyframe_action = take.motion_action = None
    show_lengths(take, body)
    return armature_object


def size_actor(context: bpy.types.Context, take: bpy.types.PropertyGroup, body: Body) -> bool:
    """Give the take's actor a body's lengths, or the take an actor; return whether it had one.

    Pose and keyframes stay.

    Raises:
        InputError: The take's armature cannot be changed.
    """
    if take.armature is None or take.armature.name not in context.scene.objects:
        add_actor(context, take, body)
        return False
    set_lengths(take.armature, body)
    show_lengths(take, body)
    return True


def show_lengths(take: bpy.types.PropertyGroup, body: Body) -> None:
    """Set the lengths in the panel to a body's."""
    segments = body.actor.segments_m
    lengths = take.lengths
    pairs = [(f"{part}.L", f"{part}.R") for part in {name.split(".")[0] for name in segments if "." in name}]
    lengths.symmetric = all(
        abs(segments[left] - segments[right]) < SYMMETRY_TOLERANCE_M for left, right in pairs
    )
    for name in length_names():
        setattr(lengths, length_property(name), segments[name])


def performers_stance(
    scene: bpy.types.Scene, take: bpy.types.PropertyGroup, body: Body
) -> "tuple[Posture, bool] | None":
    """Return the posture of a performer who stands in the current frame, and whether evidence located them.

    None without footage and camera, or if the current frame is not one of the footage's.
    """
    from ..bridge.single_frame_fit import frame_in_footage, posed_standing

    if take.clip is None or take.camera is None:
        return None
    regions: RegionTracks | None = None
    try:
        frame = frame_in_footage(footage_of(scene, take), scene_evidence(take), reading_of(take))
        keypoints = frame.keypoints(body)
    except InputError:
        return None
    if frame.styles:
        try:
            regions = frame.regions()
        except InputError:  # a color that is not found yet must not prevent building the actor
            regions = None
    seen = regions is not None and bool(regions.visible.any())
    seen |= bool(keypoints.frame(frame.index).seen.any())
    return posed_standing(frame, body, regions, keypoints), seen


def has_keyframes(take: bpy.types.PropertyGroup) -> bool:
    """Whether the animator has keyed the actor already, so that its pose must stay."""
    return take.keyframe_action is not None and len(take.keyframe_action.slots) > 0
