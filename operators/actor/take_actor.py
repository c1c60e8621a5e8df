"""A take's actor in its scene: added, resized, and where the performer stands."""

from typing import TYPE_CHECKING

import bpy

from ...core.body.kinematics import Body
from ...core.errors import InputError
from ..bridge.actor_bones import hips_at_rest
from ..bridge.resize import set_lengths
from ..keypoints.evidence import scene_evidence
from ..shell.notices import give_notices
from ..shell.results import reading_of
from ..shell.takes import footage_of, has_lost_actor
from .properties import length_names, length_property
from .restored_actor import new_actor, restore_actor

if TYPE_CHECKING:
    from ...core.body.posture import Posture
    from ...core.footage.region_tracks import RegionTracks

SYMMETRY_TOLERANCE_M = 5e-4
"""Left and right count as equally long within this."""


def add_actor(context: bpy.types.Context, take: bpy.types.PropertyGroup, body: Body) -> bpy.types.Object:
    """Build a take's armature, selected and active, and return the armature object."""
    armature_object = new_actor(context, take, body)
    show_lengths(take, body)
    return armature_object


def size_actor(context: bpy.types.Context, take: bpy.types.PropertyGroup, body: Body) -> bool:
    """Give the take's actor a body's lengths, or the take an actor; return whether it had one.

    Pose and keyframes stay; one that was deleted is brought back with them.

    Raises:
        InputError: The take's armature cannot be changed.
    """
    if has_lost_actor(take):
        restore_actor(context, take)
    elif take.armature is None:
        add_actor(context, take, body)
        return False
    set_lengths(take.armature, body)
    show_lengths(take, body)
    return True


def show_lengths(take: bpy.types.PropertyGroup, body: Body) -> None:
    """Set the lengths in the panel to a body's."""
    segments = body.actor.segments_m
    take.rest_hips = hips_at_rest(take.armature)
    give_notices(take, "actor", "lengths")  # of other lengths
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
