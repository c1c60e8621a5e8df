"""Properties of a take's characters: armature, map, options of retargeting, and the results."""

import bpy

from ...core.take.conversion_settings import RetargetOptions
from ..bridge.actor_bones import is_actor, moves_an_actor
from ..shell.fields import HIDDEN, Choice, Entries, Group, Integer, Pointer, Switch, Text, declared_property
from .characters import may_be_character
from .map_properties import KEYMARK_PG_character_map
from .recognition import armature_chosen

KEYS = (
    ("TOLERANCE", "Within Tolerance", "The fewest keys that keep the character within the tolerance"),
    ("EVERY_FRAME", "Every Frame", "A key on every frame"),
)
SOURCES = (
    ("NEWEST", "Newest", "The final Action, unless there is none or the reconstructed motion is newer"),
    ("FINAL", "Final", "The take's final Action"),
    ("MOTION", "Motion", "The take's reconstructed motion"),
    ("ACTION", "Other Action", "Any Action of a Keymark actor in this file"),
)
LEVELS = (("INFO", "Note", "What was done"), ("ERROR", "Warning", "What to look at"))


class KEYMARK_PG_result_line(bpy.types.PropertyGroup):
    """A sentence on a result."""

    text: Text("Line", "What is said of the result")
    level: Choice("Kind", "Kind of the line", items=LEVELS)


class KEYMARK_PG_retargeted(bpy.types.PropertyGroup):
    """A result: the motion on the character as an Action."""

    action: Pointer("Action", "The Action that holds the character's motion", bpy.types.Action)
    armature: Pointer("Armature", "The armature that it moves", bpy.types.Object)
    source: Choice("Motion", "Which motion it was made from", items=SOURCES[1:])
    source_action: Pointer("Source Action", "The Action it was made from", bpy.types.Action)
    source_actor: Pointer("Of Actor", "The actor that the source Action moves", bpy.types.Object)
    made_from: Text("Made From", "Digest of the motion it was made from", options=HIDDEN)
    lines: Entries(type=KEYMARK_PG_result_line)


class KEYMARK_PG_retarget_options(bpy.types.PropertyGroup):
    """Options of retargeting, as `RetargetOptions` declares them."""

    arms: declared_property(RetargetOptions, "arms")
    legs: declared_property(RetargetOptions, "legs")
    root_motion: declared_property(RetargetOptions, "root_motion")
    placement: declared_property(RetargetOptions, "place")
    plant_feet: declared_property(RetargetOptions, "plant_feet")
    reach_hands: declared_property(RetargetOptions, "reach_hands", name="Reach With Hands")
    keys: Choice("Keys", "Number of keys of the Action", items=KEYS)
    tolerance_mm: declared_property(
        RetargetOptions,
        "tolerance_mm",
        name="Tolerance (mm)",
        min=0.1,
        soft_min=1.0,
        soft_max=50.0,
        max=500.0,
        precision=1,
        step=50,
    )


class KEYMARK_PG_character(bpy.types.PropertyGroup):
    """A character that performs a take's motion."""

    armature: Pointer(
        "Armature",
        "The character's armature; any but Keymark's own actors",
        bpy.types.Object,
        poll=lambda _character, candidate: may_be_character(candidate),
        update=lambda character, _context: armature_chosen(character),
    )
    problem: Text("Problem", "Why the armature's bones could not be recognized")
    doubts: Entries(type=KEYMARK_PG_result_line)
    suggested: Text("Map at Hand", "Title of a map in your library folder for this armature's bones")
    character_map: Group(type=KEYMARK_PG_character_map)
    source: Choice("Motion", "Which motion the character performs", items=SOURCES)
    source_action: Pointer(
        "Action",
        "The Action of a Keymark actor that the character performs",
        bpy.types.Action,
        poll=lambda _character, action: moves_an_actor(action),
    )
    source_actor: Pointer(
        "Of Actor",
        "The actor that the Action moves; empty for the take's own",
        bpy.types.Object,
        poll=lambda _character, candidate: is_actor(candidate),
    )
    options: Group(type=KEYMARK_PG_retarget_options)
    keep_earlier: Switch(
        "Keep Earlier", "Make another Action and keep the earlier result, instead of replacing what it holds"
    )
    results: Entries(type=KEYMARK_PG_retargeted)
    active_result: Integer("Active Result", "The result that is chosen", min=0)
