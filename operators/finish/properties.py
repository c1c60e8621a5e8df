"""Properties of the finish: options and result of the final Action, and details of the asset."""

import bpy
from bpy.types import PropertyGroup

from ..shell.fields import HIDDEN, TOLERANCE, Choice, Integer, Number, Pointer, Switch, Text
from ..shell.take_state import TakeState

KEYS = (
    ("TOLERANCE", "Within Tolerance", "As few keys as keep the body within the tolerance in every frame"),
    ("EVERY_FRAME", "Every Frame", "A key on every frame, as reconstructed"),
)
SHARED = (
    ("PER_BONE", "Per Bone", "Each bone has keys where it needs them; the fewest keys"),
    ("WHOLE_POSE", "Whole Pose", "All bones have keys on the same frames, pose by pose"),
)
_performers: list[tuple[str, str, str, str, int]] = []  # Blender keeps no copy of the strings


def _names(finish: PropertyGroup) -> list[str]:
    take = next(take for take in finish.id_data.keymark.takes if take.finish == finish)
    return [each.name for each, _ in TakeState(take).performers]


def _items(finish: PropertyGroup, _context: object) -> list[tuple[str, str, str, str, int]]:
    words = "Write what this armature performs, with what it moves"
    names = _names(finish) or ["Nobody"]  # Blender reads the choice before there is one
    _performers[:] = [(name, name, words, "ARMATURE_DATA", index) for index, name in enumerate(names)]
    return _performers


def _chosen(finish: PropertyGroup) -> int:
    names = _names(finish)
    return names.index(finish.performer) if finish.performer in names else 0


class KEYMARK_PG_finish(bpy.types.PropertyGroup):
    """Finish of a take's motion."""

    keys: Choice("Keys", "Number of keys of the final Action", items=KEYS)
    tolerance_mm: Number(
        "Tolerance (mm)",
        "Largest distance of any joint or end of the body from the reconstructed motion",
        default=5.0,
        **TOLERANCE,
    )
    shared: Choice("Keyed", "Whether bones are keyed each on its own or together", items=SHARED)
    plant_feet: Switch(
        "Plant Feet",
        "Hold resting feet at one place; the legs follow, and the hips a little where they must",
        default=True,
    )
    stray_mm: Number(
        "Feet May Sway (mm)",
        "Distance that a resting foot may stray and still be held; raise it to hold swaying feet",
        default=25.0,
        min=1.0,
        soft_max=100.0,
        max=500.0,
        precision=0,
        step=100,
    )
    performer: Text("Performer", "Whose motion is exported; empty for the first", options=HIDDEN)
    who: Choice(
        "Who",
        "Whose motion is exported",
        items=_items,
        get=_chosen,
        set=lambda finish, index: setattr(finish, "performer", _names(finish)[index] if index else ""),
    )
    action: Pointer(
        "Final", "The Action that holds the finished motion, in keys of your own to edit", bpy.types.Action
    )
    made_from: Text("Made From", "Digest of the motion it was made from", options=HIDDEN)
    keys_before: Integer("Keys Before", options=HIDDEN)
    keys_after: Integer("Keys After", options=HIDDEN)
    furthest_mm: Number("Furthest", options=HIDDEN)
    rests: Integer("Rests", options=HIDDEN)
    catalog: Text(
        "Catalog",
        "Catalog of the motion in the asset browser, such as Keymark/Walking; empty for none",
        default="Keymark/Motions",
    )
    tags: Text("Tags", "Words to find the motion by, with commas between them", default="keymark")
    author: Text("Author", "Author of the motion")
    license: Text("License", "Terms under which others may use the motion")
    description: Text("Description", "Description of the motion")
