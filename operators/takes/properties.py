"""Properties of a take: a performer in a clip, what the animator enters and what Keymark finds."""

from contextlib import suppress
from math import pi

import bpy
from bpy.types import Context, PropertyGroup

from ...core.errors import InputError
from ..actor.properties import KEYMARK_PG_lengths, in_meters
from ..bridge.actions import action_of, assign_action
from ..bridge.actor_bones import is_actor
from ..bridge.footage import is_missing
from ..character.properties import KEYMARK_PG_character
from ..finish.properties import KEYMARK_PG_finish
from ..follow.properties import KEYMARK_PG_follow, KEYMARK_PG_ignored_region, KEYMARK_PG_marker
from ..footage.load_footage import camera_chosen, clip_chosen
from ..footage.properties import (
    KEYMARK_PG_camera_line,
    KEYMARK_PG_clip_state,
    KEYMARK_PG_part,
    placement_accessors,
)
from ..keyframes.found_properties import KEYMARK_PG_match, KEYMARK_PG_matching
from ..overlays.properties import KEYMARK_PG_overlays
from ..review.properties import KEYMARK_PG_review
from ..shell.fields import HIDDEN, Choice, Entries, Group, Integer, Number, Pointer, Switch, Text, Vector
from ..shell.notes import KEYMARK_PG_contradiction, KEYMARK_PG_notice
from ..shell.takes import find_take, show_active_take, unique_name

METHODS = (
    ("map", "Whole Clip", "Estimate all frames at once; the most accurate"),
    ("ekf", "Fuzzy Kalman Filter", "The published filter, frame after frame; for comparison"),
    ("interpolation", "Keyframes Only", "Interpolate the keyframes without looking at the footage"),
)


def _armature_chosen(take: PropertyGroup, context: Context) -> None:
    if not is_actor(take.armature):
        return
    with suppress(InputError, ModuleNotFoundError):  # another skeleton, or SciPy is missing
        from ..actor.take_actor import show_lengths
        from ..bridge.armature import read_body

        actions = [action for action in (take.motion_action, take.keyframe_action) if action is not None]
        if actions and action_of(take.armature) is None:
            assign_action(take.armature, actions[0])
        show_lengths(take, read_body(take.armature))


def _height_typed(take: PropertyGroup, _context: Context) -> None:
    in_meters(take)
    if take.stature > 3.0:
        take.stature = 3.0


def _renamed(take: PropertyGroup, context: Context) -> None:
    names = [other.name for other in take.id_data.keymark.takes if other != take]
    free = unique_name(take.name.strip() or "Take", names)
    if take.name != free:
        take.name = free


class KEYMARK_PG_proposal(bpy.types.PropertyGroup):
    """A frame worth posing."""

    frame: Integer("Frame", "The scene frame that is proposed")


class KEYMARK_PG_note(bpy.types.PropertyGroup):
    """A note of the last reconstruction."""

    text: Text("Note", "A sentence that the last reconstruction left")


class KEYMARK_PG_take(bpy.types.PropertyGroup):
    """A performer in a clip."""

    name: Text("Name", "Your name for this take", default="Take", update=_renamed)
    identifier: Text("Identifier", "Tells takes apart, whatever their names", options=HIDDEN)
    clip: Pointer(
        "Clip",
        "The footage of the performer; the scene's size, rate and range follow it",
        bpy.types.MovieClip,
        update=lambda take, _: clip_chosen(take),
    )
    clip_state: Group(type=KEYMARK_PG_clip_state)
    part: Group(type=KEYMARK_PG_part)
    camera: Pointer(
        "Camera",
        "The camera that took the footage; its animation is used, if it moves",
        bpy.types.Object,
        poll=lambda _, candidate: candidate.type == "CAMERA",
        update=lambda take, _: camera_chosen(take),
    )
    guessed_lens_mm: Number(
        "Guessed Lens",
        "The focal length guessed because none was stated; 0 for none",
        min=0.0,
        options=HIDDEN,
    )
    guessed_placement: Vector(
        "Guessed Place",
        "Height, tilt and roll with which the camera was put there by guess; zeros for none",
        size=3,
        precision=6,
        options=HIDDEN,
    )
    camera_height: Number(
        "Height",
        "Height of the camera above the floor",
        subtype="DISTANCE",
        precision=3,
        step=1,
        min=0.01,
        soft_max=10.0,
        max=1000.0,
        **placement_accessors("height_m"),
    )
    camera_tilt: Number(
        "Tilt",
        "By how much the camera looks up; negative where it looks down, 0 where it is level",
        subtype="ANGLE",
        precision=2,
        step=10,
        min=-pi / 2,
        max=pi / 2,
        **placement_accessors("tilt_rad"),
    )
    camera_roll: Number(
        "Roll",
        "By how much the camera is turned about its view, counterclockwise from behind it; the "
        "picture then leans clockwise",
        subtype="ANGLE",
        precision=2,
        step=10,
        min=-pi,
        max=pi,
        **placement_accessors("roll_rad"),
    )
    camera_lines: Entries(type=KEYMARK_PG_camera_line)
    camera_findings: Text("Findings", "What the camera was found from, and how sure that is", options=HIDDEN)
    armature: Pointer(
        "Actor",
        "The performer's armature, as Keymark builds it; other characters come in the last step",
        bpy.types.Object,
        # Deleted ones, which other takes still keep, are none.
        poll=lambda take, chosen: is_actor(chosen) and chosen.name in take.id_data.objects,
        update=_armature_chosen,
    )
    stature: Number(
        "Height",
        "The performer's body height, from which an actor of average proportions is built",
        subtype="DISTANCE",
        precision=4,
        default=1.75,
        min=0.5,
        soft_max=3.0,
        max=300.0,
        update=_height_typed,
    )
    lengths: Group(type=KEYMARK_PG_lengths)
    rest_hips: Vector(
        "Hips at Rest",
        "Where the actor's hips are at rest in its own space, for one that is built anew",
        size=3,
        options=HIDDEN,
    )
    markers: Entries(type=KEYMARK_PG_marker)
    active_marker: Integer("Active Marker", "The marker that is chosen in the list", min=0)
    ignored_regions: Entries(type=KEYMARK_PG_ignored_region)
    active_ignored: Integer("Active Region", "The region without markers that is chosen in the list", min=0)
    follow: Group(type=KEYMARK_PG_follow)
    keyframe_action: Pointer("Keyframes", "The Action that holds the keyframes you pose", bpy.types.Action)
    keyframe_count: Integer("Count", "Keyframes to propose; 0 for 10 in 100 frames", min=0, soft_max=100)
    proposals: Entries(type=KEYMARK_PG_proposal)
    matching: Group(type=KEYMARK_PG_matching)
    contradictions: Entries(type=KEYMARK_PG_contradiction)
    offered: Group(type=KEYMARK_PG_match)
    method: Choice("Method", "How the frames between the keyframes are found", items=METHODS)
    motion_action: Pointer("Motion", "The Action that holds the reconstructed motion", bpy.types.Action)
    made_from: Text("Made From", "Digest of the keyframes that the motion was made from", options=HIDDEN)
    live_preview: Switch(
        "Live Preview",
        "Let the actor follow while frames are solved; without it the result comes sooner",
        default=True,
    )
    notes: Entries(type=KEYMARK_PG_note)
    notices: Entries(type=KEYMARK_PG_notice)
    reading_key: Text("Reading", "Key of the cached reading of the clip", options=HIDDEN)
    review_key: Text("Review", "Key of the cached review of the motion", options=HIDDEN)
    review: Group(type=KEYMARK_PG_review)
    finish: Group(type=KEYMARK_PG_finish)
    characters: Entries(type=KEYMARK_PG_character)
    active_character: Integer("Active Character", "The character that is chosen in the list", min=0)


def _active_take_changed(settings: PropertyGroup, context: Context) -> None:
    show_active_take(settings.id_data)
    take = find_take(settings.id_data)
    if take is not None:
        take.clip_state.missing = is_missing(take.clip)


class KEYMARK_PG_settings(bpy.types.PropertyGroup):
    """Keymark's properties of a scene."""

    version: Integer("Version", "Version of Keymark's properties in this file", options=HIDDEN)
    takes: Entries(type=KEYMARK_PG_take)
    active_take: Integer(
        "Active Take",
        "The take that is worked on; its footage and camera become the scene's",
        min=0,
        update=_active_take_changed,
    )
    overlays: Group(type=KEYMARK_PG_overlays)


ATTACHED = {"Scene.keymark": Group(type=KEYMARK_PG_settings)}
