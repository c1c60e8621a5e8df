"""Properties of a take: a performer in a clip, what the animator enters and what Keymark finds."""

from contextlib import suppress
from math import pi

import bpy

from ...core.body.human import HUMAN
from ...core.errors import InputError
from ..actor.properties import KEYMARK_PG_lengths
from ..bridge.actor_bones import is_actor
from ..character.properties import KEYMARK_PG_character
from ..finish.properties import KEYMARK_PG_finish
from ..follow.keypoint_properties import KEYMARK_PG_follow
from ..follow.marker_properties import KEYMARK_PG_ignored_region, KEYMARK_PG_marker
from ..footage.properties import KEYMARK_PG_camera_line, KEYMARK_PG_clip_state, placement_accessors
from ..footage.take_footage import camera_chosen, clip_chosen, is_missing
from ..keyframes.found_properties import KEYMARK_PG_match, KEYMARK_PG_matching
from ..overlays.properties import KEYMARK_PG_overlays
from ..review.properties import KEYMARK_PG_review
from ..shell.contradictions import KEYMARK_PG_contradiction
from ..shell.notices import KEYMARK_PG_notice
from ..shell.takes import find_take, show_active_take, unique_name

METHODS = (
    ("map", "Whole Clip", "Estimate all frames at once; the most accurate"),
    ("ekf", "Fuzzy Kalman Filter", "The published filter, frame after frame; for comparison"),
    ("interpolation", "Keyframes Only", "Interpolate the keyframes without looking at the footage"),
)


def _is_actor(take: bpy.types.PropertyGroup, candidate: bpy.types.Object) -> bool:
    """Whether an object may be the take's actor; deleted ones, which other takes still keep, may not."""
    return is_actor(candidate) and candidate.name in take.id_data.objects


def _armature_chosen(take: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Show the lengths of the chosen armature in the panel, and animate it by what the take has."""
    if not is_actor(take.armature):
        return
    with suppress(InputError, ModuleNotFoundError):  # another skeleton, or SciPy is missing
        from ..actor.take_actor import reattach, show_lengths
        from ..bridge.actor_lengths import read_body

        reattach(take)
        show_lengths(take, read_body(take.armature, HUMAN))


def _renamed(take: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    others = [other.name for other in take.id_data.keymark.takes if other != take]
    free = unique_name(take.name.strip() or "Take", others)
    if take.name != free:
        take.name = free


class KEYMARK_PG_proposal(bpy.types.PropertyGroup):
    """A frame worth posing."""

    frame: bpy.props.IntProperty(name="Frame", description="The scene frame that is proposed")


class KEYMARK_PG_note(bpy.types.PropertyGroup):
    """A note of the last reconstruction."""

    text: bpy.props.StringProperty(name="Note", description="A sentence that the last reconstruction left")


class KEYMARK_PG_take(bpy.types.PropertyGroup):
    """A performer in a clip."""

    name: bpy.props.StringProperty(
        name="Name", description="Your name for this take", default="Take", update=_renamed
    )
    identifier: bpy.props.StringProperty(
        name="Identifier", description="Tells takes apart, whatever their names", options={"HIDDEN"}
    )
    clip: bpy.props.PointerProperty(
        name="Clip",
        description="The footage of the performer; the scene's size, rate and range follow it",
        type=bpy.types.MovieClip,
        update=lambda take, _: clip_chosen(take),
    )
    clip_state: bpy.props.PointerProperty(type=KEYMARK_PG_clip_state)
    camera: bpy.props.PointerProperty(
        name="Camera",
        description="The camera that took the footage; its animation is used, if it moves",
        type=bpy.types.Object,
        poll=lambda _, candidate: candidate.type == "CAMERA",
        update=lambda take, _: camera_chosen(take),
    )
    guessed_lens_mm: bpy.props.FloatProperty(
        name="Guessed Lens",
        description="The focal length guessed because none was stated; 0 for none",
        min=0.0,
        options={"HIDDEN"},
    )
    guessed_placement: bpy.props.FloatVectorProperty(
        name="Guessed Place",
        description="Height, tilt and roll with which the camera was put there by guess; zeros for none",
        size=3,
        precision=6,
        options={"HIDDEN"},
    )
    camera_height: bpy.props.FloatProperty(
        name="Height",
        description="Height of the camera above the floor",
        subtype="DISTANCE",
        precision=3,
        step=1,
        min=0.01,
        soft_max=10.0,
        max=1000.0,
        **placement_accessors("height_m"),
    )
    camera_tilt: bpy.props.FloatProperty(
        name="Tilt",
        description="By how much the camera looks up; negative where it looks down, 0 where it is level",
        subtype="ANGLE",
        precision=2,
        step=10,
        min=-pi / 2,
        max=pi / 2,
        **placement_accessors("tilt_rad"),
    )
    camera_roll: bpy.props.FloatProperty(
        name="Roll",
        description="By how much the camera is turned about its view, counterclockwise from behind it; the "
        "picture then leans clockwise",
        subtype="ANGLE",
        precision=2,
        step=10,
        min=-pi,
        max=pi,
        **placement_accessors("roll_rad"),
    )
    camera_lines: bpy.props.CollectionProperty(type=KEYMARK_PG_camera_line)
    camera_findings: bpy.props.StringProperty(
        name="Findings",
        description="What the camera was found from, and how sure that is",
        options={"HIDDEN"},
    )
    armature: bpy.props.PointerProperty(
        name="Actor",
        description="The performer's armature, as Keymark builds it; other characters come in the last step",
        type=bpy.types.Object,
        poll=_is_actor,
        update=_armature_chosen,
    )
    stature: bpy.props.FloatProperty(
        name="Height",
        description="The performer's body height, from which an actor of average proportions is built",
        subtype="DISTANCE",
        precision=4,
        default=1.75,
        min=0.5,
        max=3.0,
    )
    lengths: bpy.props.PointerProperty(type=KEYMARK_PG_lengths)
    rest_hips: bpy.props.FloatVectorProperty(
        name="Hips at Rest",
        description="Where the actor's hips are at rest in its own space, for one that is built anew",
        size=3,
        options={"HIDDEN"},
    )
    markers: bpy.props.CollectionProperty(type=KEYMARK_PG_marker)
    active_marker: bpy.props.IntProperty(
        name="Active Marker", description="The marker that is chosen in the list", default=0, min=0
    )
    ignored_regions: bpy.props.CollectionProperty(type=KEYMARK_PG_ignored_region)
    active_ignored: bpy.props.IntProperty(
        name="Active Region",
        description="The region without markers that is chosen in the list",
        default=0,
        min=0,
    )
    follow: bpy.props.PointerProperty(type=KEYMARK_PG_follow)
    keyframe_action: bpy.props.PointerProperty(
        name="Keyframes", description="The Action that holds the keyframes you pose", type=bpy.types.Action
    )
    keyframe_count: bpy.props.IntProperty(
        name="Count",
        description="How many keyframes to propose; 0 for 10 in 100 frames",
        default=0,
        min=0,
        soft_max=100,
    )
    proposals: bpy.props.CollectionProperty(type=KEYMARK_PG_proposal)
    matching: bpy.props.PointerProperty(type=KEYMARK_PG_matching)
    contradictions: bpy.props.CollectionProperty(type=KEYMARK_PG_contradiction)
    offered: bpy.props.PointerProperty(type=KEYMARK_PG_match)
    method: bpy.props.EnumProperty(
        name="Method", description="How the frames between the keyframes are found", items=METHODS
    )
    motion_action: bpy.props.PointerProperty(
        name="Motion", description="The Action that holds the reconstructed motion", type=bpy.types.Action
    )
    live_preview: bpy.props.BoolProperty(
        name="Live Preview",
        description="Let the actor follow while frames are solved; without it the result comes sooner",
        default=True,
    )
    notes: bpy.props.CollectionProperty(type=KEYMARK_PG_note)
    notices: bpy.props.CollectionProperty(type=KEYMARK_PG_notice)
    reading_key: bpy.props.StringProperty(
        name="Reading", description="Key of the cached reading of the clip", options={"HIDDEN"}
    )
    review_key: bpy.props.StringProperty(
        name="Review", description="Key of the cached review of the motion", options={"HIDDEN"}
    )
    review: bpy.props.PointerProperty(type=KEYMARK_PG_review)
    finish: bpy.props.PointerProperty(type=KEYMARK_PG_finish)
    characters: bpy.props.CollectionProperty(type=KEYMARK_PG_character)
    active_character: bpy.props.IntProperty(
        name="Active Character", description="The character that is chosen in the list", default=0, min=0
    )


def _active_take_changed(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    show_active_take(settings.id_data)
    take = find_take(settings.id_data)
    if take is not None:
        take.clip_state.missing = is_missing(take.clip)


class KEYMARK_PG_settings(bpy.types.PropertyGroup):
    """Keymark's properties of a scene."""

    version: bpy.props.IntProperty(
        name="Version", description="Version of Keymark's properties in this file", options={"HIDDEN"}
    )
    takes: bpy.props.CollectionProperty(type=KEYMARK_PG_take)
    active_take: bpy.props.IntProperty(
        name="Active Take",
        description="The take that is worked on; its footage and camera become the scene's",
        default=0,
        min=0,
        update=_active_take_changed,
    )
    overlays: bpy.props.PointerProperty(type=KEYMARK_PG_overlays)


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (KEYMARK_PG_proposal, KEYMARK_PG_note, KEYMARK_PG_take, KEYMARK_PG_settings)
)


def register() -> None:
    """Register the groups, and add Keymark's properties to scenes."""
    _register_classes()
    bpy.types.Scene.keymark = bpy.props.PointerProperty(type=KEYMARK_PG_settings)


def unregister() -> None:
    """Take it all back."""
    del bpy.types.Scene.keymark
    _unregister_classes()
