"""Properties of a take's characters: armature, map, options of retargeting, and the results."""

import bpy

from ...core.retarget.options import RetargetOptions
from ..bridge.actor_bones import is_actor, moves_an_actor
from .map_properties import KEYMARK_PG_character_map

MM = 1000.0
DEFAULTS = RetargetOptions()
LIMB_KEYS = (
    ("FK", "FK", "Key the bones of the chain, or their FK controls, and show FK"),
    ("IK", "IK", "Key the IK controls and show IK; a limb that has none is keyed in FK"),
    ("BOTH", "Both", "Key FK and IK alike and show IK, so that you may switch between them"),
)
ROOT_MOTIONS = (
    ("AS_FILMED", "As Filmed", "The character goes where the performer went, by its hips"),
    ("IN_PLACE", "In Place", "The character stays where it begins, as on a treadmill"),
    ("ROOT_BONE", "Root Bone", "The way over the ground is keyed on the root bone, for games and loops"),
)
PLACEMENTS = (
    (
        "PERFORMER",
        "Performer's Place",
        "The character is placed and turned to where the performer stands and faces in the footage",
    ),
    ("CHARACTER", "Character's Place", "The character stays where it stands, and the motion begins there"),
)
KEYS = (
    ("TOLERANCE", "Within Tolerance", "The fewest keys that keep the character within the tolerance"),
    ("EVERY_FRAME", "Every Frame", "A key on every frame"),
)
SOURCES = (
    (
        "NEWEST",
        "Newest",
        "The final Action, unless there is none or the reconstructed motion is newer",
    ),
    ("FINAL", "Final", "The take's final Action"),
    ("MOTION", "Motion", "The take's reconstructed motion"),
    ("ACTION", "Other Action", "Any Action of a Keymark actor in this file"),
)
LEVELS = (("INFO", "Note", "What was done"), ("ERROR", "Warning", "What to look at"))


def _is_character(_character: bpy.types.PropertyGroup, candidate: bpy.types.Object) -> bool:
    from .characters import may_be_character

    return may_be_character(candidate)


def _armature_chosen(character: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    from .recognition import armature_chosen

    armature_chosen(character)


class KEYMARK_PG_result_line(bpy.types.PropertyGroup):
    """A sentence on a result."""

    text: bpy.props.StringProperty(name="Line", description="What is said of the result")
    level: bpy.props.EnumProperty(name="Kind", description="Kind of the line", items=LEVELS)


class KEYMARK_PG_retargeted(bpy.types.PropertyGroup):
    """A result: the motion on the character as an Action."""

    action: bpy.props.PointerProperty(
        name="Action", description="The Action that holds the character's motion", type=bpy.types.Action
    )
    armature: bpy.props.PointerProperty(
        name="Armature", description="The armature that it moves", type=bpy.types.Object
    )
    source: bpy.props.EnumProperty(
        name="Motion", description="Which motion it was made from", items=SOURCES[1:]
    )
    source_action: bpy.props.PointerProperty(
        name="Source Action", description="The Action it was made from", type=bpy.types.Action
    )
    source_actor: bpy.props.PointerProperty(
        name="Of Actor", description="The actor that the source Action moves", type=bpy.types.Object
    )
    outdated: bpy.props.BoolProperty(
        name="Outdated",
        description="Whether the take's motion was changed after this was made from it",
        options={"HIDDEN"},
    )
    lines: bpy.props.CollectionProperty(type=KEYMARK_PG_result_line)


class KEYMARK_PG_retarget_options(bpy.types.PropertyGroup):
    """Options of retargeting; the defaults are those of `core/retarget/options`."""

    arms: bpy.props.EnumProperty(
        name="Arms",
        description="Controls of the arms that are keyed",
        items=LIMB_KEYS,
        default=DEFAULTS.arms.name,
    )
    legs: bpy.props.EnumProperty(
        name="Legs",
        description="Controls of the legs that are keyed",
        items=LIMB_KEYS,
        default=DEFAULTS.legs.name,
    )
    root_motion: bpy.props.EnumProperty(
        name="Root Motion",
        description="Where the way over the ground goes",
        items=ROOT_MOTIONS,
        default=DEFAULTS.root_motion.name,
    )
    placement: bpy.props.EnumProperty(
        name="Place",
        description="Where the character performs",
        items=PLACEMENTS,
        default=DEFAULTS.placement.name,
    )
    plant_feet: bpy.props.BoolProperty(
        name="Plant Feet",
        description="Hold resting feet at one place, flat on the floor; the legs follow",
        default=DEFAULTS.plant_feet,
    )
    reach_hands: bpy.props.BoolProperty(
        name="Reach With Hands",
        description="Let the hands reach what the performer's reached: each other, the body, the floor",
        default=DEFAULTS.reach_hands,
    )
    keys: bpy.props.EnumProperty(name="Keys", description="Number of keys of the Action", items=KEYS)
    tolerance_mm: bpy.props.FloatProperty(
        name="Tolerance (mm)",
        description="Largest distance of any joint, end or sole of the character from its full motion",
        default=MM * (DEFAULTS.tolerance_m or 0.0),
        min=0.1,
        soft_min=1.0,
        soft_max=50.0,
        max=500.0,
        precision=1,
        step=50,
    )


class KEYMARK_PG_character(bpy.types.PropertyGroup):
    """A character that performs a take's motion."""

    armature: bpy.props.PointerProperty(
        name="Armature",
        description="The character's armature; any but Keymark's own actors",
        type=bpy.types.Object,
        poll=_is_character,
        update=_armature_chosen,
    )
    problem: bpy.props.StringProperty(
        name="Problem", description="Why the armature's bones could not be recognized"
    )
    doubts: bpy.props.CollectionProperty(type=KEYMARK_PG_result_line)
    suggested: bpy.props.StringProperty(
        name="Map at Hand", description="Title of a map in your library folder for this armature's bones"
    )
    character_map: bpy.props.PointerProperty(type=KEYMARK_PG_character_map)
    source: bpy.props.EnumProperty(
        name="Motion", description="Which motion the character performs", items=SOURCES
    )
    source_action: bpy.props.PointerProperty(
        name="Action",
        description="The Action of a Keymark actor that the character performs",
        type=bpy.types.Action,
        poll=lambda _character, action: moves_an_actor(action),
    )
    source_actor: bpy.props.PointerProperty(
        name="Of Actor",
        description="The actor that the Action moves; empty for the take's own",
        type=bpy.types.Object,
        poll=lambda _character, candidate: is_actor(candidate),
    )
    options: bpy.props.PointerProperty(type=KEYMARK_PG_retarget_options)
    keep_earlier: bpy.props.BoolProperty(
        name="Keep Earlier",
        description="Make another Action and keep the earlier result, instead of replacing what it holds",
        default=False,
    )
    results: bpy.props.CollectionProperty(type=KEYMARK_PG_retargeted)
    active_result: bpy.props.IntProperty(
        name="Active Result", description="The result that is chosen", default=0, min=0
    )


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_PG_result_line, KEYMARK_PG_retargeted, KEYMARK_PG_retarget_options, KEYMARK_PG_character)
)
