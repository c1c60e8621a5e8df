"""Recognition of a character: roles from preset, names and shape together, or a refusal."""

from dataclasses import replace

from ..character import Character
from ..character_map import CharacterMap
from ..presets import Preset, find_preset
from .bones import candidate_bones
from .doubts import limb_doubts, missing_doubts, name_doubts, side_doubts, trunk_doubts
from .facing import find_facing
from .figure import Figure, find_figures
from .frame import Frame, frames
from .preset_check import merged_with_preset, swapped_sides
from .recognition import Recognition
from .refusals import check_character, refusal, why_no_figure
from .roles_of_figure import roles_of
from .root_bone import extra_ends, find_root
from .symmetry import find_symmetry


def recognize(character: Character, presets: tuple[Preset, ...] | None = None) -> Recognition:
    """Recognize a character's bones.

    Args:
        character: Its bones at rest.
        presets: Conventions of names to look for; by default the shipped ones.

    Raises:
        InputError: It is no character: too few bones, an animal, a prop, an actor of Keymark, a half-built
            rig, or numbers that cannot be used.
    """
    check_character(character)
    figure, frame, reason = _best_figure(character)
    if figure is None:
        raise refusal(character, frame, reason)
    facing = find_facing(figure)
    roles = roles_of(figure, facing)
    doubts = side_doubts(facing)
    preset = find_preset(character, presets)
    if preset is None:
        character_map = CharacterMap(character.name, roles)
        doubts += trunk_doubts(figure) + limb_doubts(figure, facing, roles)
        doubts += name_doubts(figure, roles)
    else:
        if facing.by_names < 0.0:
            preset = swapped_sides(preset)
        character_map, against = merged_with_preset(character, preset, roles, figure)
        doubts += against
    doubts += missing_doubts(character_map)
    if character_map.root is None:
        character_map = replace(character_map, root=find_root(character, character_map, figure.frame.up))
    extras = extra_ends(character, character_map)
    return Recognition(character_map, tuple(doubts), character_map.preset, extras)


def _best_figure(character: Character) -> tuple[Figure | None, Frame | None, str]:
    """The likeliest figure that is a character's; else a frame, and why the likeliest is none."""
    frame, reason = None, ""
    for bones in candidate_bones(character):
        symmetry = find_symmetry(bones)
        if symmetry is None:
            continue
        tried = frames(bones, symmetry)
        frame = frame or next(iter(tried), None)
        for figure in find_figures(tried):
            why = why_no_figure(figure)
            if not why:
                return figure, frame, ""
            reason = reason or why
    return None, frame, reason
