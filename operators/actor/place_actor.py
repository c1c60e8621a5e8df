"""Giving a take its actor's sizes and place: a new armature, or the one it has, changed."""

from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ...core.footage.region_tracks import RegionTracks
from ..markers.marker_styles import marker_styles
from ..shell.results import reading_of
from ..shell.takes import footage_of
from .new_actor import add_actor, show_lengths

if TYPE_CHECKING:
    from ...core.body.kinematics import Body
    from ...core.body.posture import Posture


def has_actor(context: bpy.types.Context, take: bpy.types.PropertyGroup) -> bool:
    """Whether the take has an armature in the scene."""
    return take.armature is not None and take.armature.name in context.scene.objects


def size_actor(context: bpy.types.Context, take: bpy.types.PropertyGroup, body: "Body") -> bool:
    """Give the take's actor a body's lengths, or the take an actor; whether it had one.

    Pose and keyframes stay.

    Raises:
        InputError: The armature the take has cannot be changed.
    """
    from ..bridge.resize import set_lengths

    if not has_actor(context, take):
        add_actor(context, take, body)
        return False
    set_lengths(take.armature, body)
    show_lengths(take, body)
    return True


def performers_place(
    scene: bpy.types.Scene, take: bpy.types.PropertyGroup, body: "Body"
) -> "tuple[Posture, bool] | None":
    """Where the performer stands in the current frame, and whether markers told it.

    None without footage and camera, or where the current frame is none of the footage's.
    """
    from ..bridge.single_frame_fit import frame_in_footage, posed_standing

    if take.clip is None or take.camera is None:
        return None
    regions: RegionTracks | None = None
    try:
        frame = frame_in_footage(footage_of(scene, take), marker_styles(take), reading_of(take))
    except InputError:
        return None
    if frame.styles:
        try:
            regions = frame.regions()
        except InputError:  # a color that is nowhere yet is no reason not to build
            regions = None
    seen = regions is not None and bool(regions.visible.any())
    return posed_standing(frame, body, regions), seen


def is_posed(take: bpy.types.PropertyGroup) -> bool:
    """Whether the animator has keyed the actor already, so that its pose is not to be touched."""
    return take.keyframe_action is not None and len(take.keyframe_action.slots) > 0
