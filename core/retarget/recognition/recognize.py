"""Recognition of a character: roles from preset, names and shape together, or a refusal."""

from dataclasses import replace

from ...text import Sentence
from ..character import Character
from ..maps.character_map import CharacterMap
from ..maps.presets import Preset, find_preset
from ..stance import find_stance
from .bones import candidate_bones
from .doubts import limb_doubts, missing_doubts, name_doubts, side_doubts, trunk_doubts
from .facing import find_facing
from .figure import Figure, find_figures
from .frame import Frame, frames
from .preset_check import UNSEEN, merged_with_preset, stands_upright, swapped_sides, with_confidence
from .recognition import Recognition
from .refusals import check_character, refusal, why_no_figure
from .roles_of_figure import roles_of
from .root_bone import extra_ends, find_root
from .symmetry import find_symmetries

CLEAR_FIT = -6.0
"""Log-likelihood of a figure's places from which no other plane of symmetry is tried."""


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
    preset = find_preset(character, presets)
    figure, frame, reason = _best_figure(character)
    if figure is not None:
        character_map, doubts = _of_figure(character, figure, preset)
    elif preset is not None and stands_upright(character, preset):
        character_map = replace(preset, roles=with_confidence(preset.roles, UNSEEN))
        doubts = [
            Sentence(
                "no body was recognized by shape: all roles are those of the names of {preset}",
                preset=preset.title,
            )
        ]
    else:
        raise refusal(character, frame, reason)
    doubts += missing_doubts(character_map)
    if character_map.root is None:
        up = find_stance(character, character_map)[2]
        character_map = replace(character_map, root=find_root(character, character_map, up))
    extras = extra_ends(character, character_map)
    return Recognition(character_map, tuple(doubts), character_map.preset, extras)


def _of_figure(
    character: Character, figure: Figure, preset: CharacterMap | None
) -> tuple[CharacterMap, list[str]]:
    """The map of a figure, with a preset held against it where there is one, and the doubts."""
    facing = find_facing(figure)
    roles = roles_of(figure, facing)
    doubts = side_doubts(facing)
    if preset is None:
        doubts += trunk_doubts(figure) + limb_doubts(figure, facing, roles) + name_doubts(figure, roles)
        return CharacterMap(character.name, roles), doubts
    if facing.by_names < 0.0:
        preset = swapped_sides(preset)
    character_map, against = merged_with_preset(character, preset, roles, figure)
    return character_map, doubts + against


def _best_figure(character: Character) -> tuple[Figure | None, Frame | None, str]:
    """The likeliest figure that is a character's; else a frame, and why the likeliest is none."""
    frame, reason = None, ""
    for bones in candidate_bones(character):
        best: Figure | None = None
        for symmetry in find_symmetries(bones):
            tried = frames(bones, symmetry)
            frame = frame or next(iter(tried), None)
            for figure in find_figures(tried):
                why = why_no_figure(figure)
                reason = reason or why
                if not why and (best is None or figure.score > best.score):
                    best = figure
            if best is not None and best.score - best.names_score > CLEAR_FIT:
                break
        if best is not None:
            return best, frame, ""
    return None, frame, reason
