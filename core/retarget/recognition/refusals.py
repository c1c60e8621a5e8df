"""What is no character: too few bones, unusable numbers, Keymark's own actors, animals, half-built rigs."""

import numpy as np

from ...body.human import HUMAN
from ...errors import InputError
from ...files.json_file import shown
from ..character import Character
from ..roles import REQUIRED
from .figure import Figure
from .frame import Frame
from .names import CLEAR

FEWEST_BONES = len(REQUIRED)
LEAST_UPRIGHT = 0.6
"""Least cosine between the trunk and up."""
LEAST_LEG_DOWN = 0.7
"""Least cosine between a leg and down."""
HANDS_ABOVE = 0.1
"""Hands are at least so many lengths of a leg above the ankles."""
LEAST_FIT = -16.0
"""Least log-likelihood of a figure's places alone ..."""
LEAST_FIT_NAMED = -26.0
"""... and where names speak for its arms and legs."""
LIMB_WORDS = {"upper_arm": "arm", "forearm": "forearm", "thigh": "leg", "shin": "shin", "foot": "foot"}
"""Parts of limbs that a character must have, in words."""
VALID = "a character stands on two legs and has two arms"


def check_character(character: Character) -> None:
    """Refuse what is no character before its bones are looked at.

    Raises:
        InputError: Too few bones, numbers that cannot be used, no size, or an actor of Keymark.
    """
    name = f"armature {shown(character.name)}"
    if not character.bones:
        raise InputError(f"{name} has no bones; {VALID}")
    own = {segment.name for segment in HUMAN.segments}
    if own <= set(character.index):
        raise InputError(f"{name} is an actor of Keymark; choose the character that is to get its motion")
    if len(character.bones) < FEWEST_BONES:
        count = f"{len(character.bones)} bone{'s' if len(character.bones) > 1 else ''}"
        raise InputError(f"{name} has {count}, at least {FEWEST_BONES} are needed; {VALID}")
    if not np.isfinite(character.scale) or character.scale <= 0.0:
        raise InputError(f"{name}: its scale is {character.scale:g}; it must be one positive number")
    for bone in character.bones:
        if not np.isfinite(bone.rest).all() or not np.isfinite(bone.tail).all():
            raise InputError(
                f"{name}: bone {shown(bone.name)} has a place that is no number; all must be finite"
            )
    extent = float(np.max(np.ptp([bone.head for bone in character.bones], axis=0)))
    if not extent * character.scale > 1e-6:
        raise InputError(f"{name} has no size, all its bones begin at one point; {VALID}")


def why_no_figure(figure: Figure) -> str:
    """Why a figure is no character's, to follow the armature's name; empty for a character's."""
    places = figure.frame.place
    hip, ankle = (places[figure.limbs[part].bone] for part in ("thigh", "foot"))
    leg = max(float(np.linalg.norm(ankle - hip)), 1e-9)
    wrist = places[figure.bone("hand") if figure.bone("hand") >= 0 else figure.bone("forearm")]
    if figure.uprightness < LEAST_UPRIGHT or (hip[2] - ankle[2]) / leg < LEAST_LEG_DOWN:
        return "its trunk does not stand upright on its legs, like an animal's"
    if (wrist[2] - ankle[2]) / leg < HANDS_ABOVE:
        return "its hands are as low as its feet, like an animal's"
    least = LEAST_FIT_NAMED if _is_named(figure) else LEAST_FIT
    if figure.score - figure.names_score < least:
        return "its bones do not have the proportions of a body with two legs and two arms"
    return ""


def _is_named(figure: Figure) -> bool:
    """Whether the long bones of arms and legs are named after what they are."""
    readings = figure.frame.bones.readings
    parts = ("upper_arm", "forearm", "thigh", "shin")
    return all(readings[figure.limbs[part].bone].scores[part] >= CLEAR for part in parts)


def refusal(character: Character, frame: Frame | None, reason: str) -> InputError:
    """The error for a character that is refused.

    Args:
        character: The character.
        frame: A frame of its bones, to say what is missing; None where it has no two sides.
        reason: Why its best figure is refused; empty where there is none.
    """
    name = f"armature {shown(character.name)}"
    if frame is None:
        return InputError(f"{name} has no bones that mirror each other; {VALID}")
    missing = _one_sided(frame) or _footless(frame)
    if missing:
        return InputError(f"{name} has {missing}; {VALID}, so complete the rig or choose another")
    if reason:
        return InputError(f"{name} is not recognized as a character: {reason}; {VALID}")
    return InputError(f"{name} has no pair of legs and pair of arms on one trunk; {VALID}")


def _one_sided(frame: Frame) -> str:
    """A part of a limb that names know on one side only, in words; empty where there is none."""
    for part, word in LIMB_WORDS.items():
        sides = _named_sides(frame, part)
        if len(sides) == 1:
            side, other = ("left", "right") if "L" in sides else ("right", "left")
            return f"a {side} {word} but no {other} one"
    return ""


def _footless(frame: Frame) -> str:
    """Says that feet are missing where names know the other parts of limbs."""
    known = [part for part in LIMB_WORDS if _named_sides(frame, part)]
    return "legs without feet" if known == [part for part in LIMB_WORDS if part != "foot"] else ""


def _named_sides(frame: Frame, part: str) -> set[str]:
    """Sides on which a bone's name speaks for a part."""
    readings = frame.bones.readings
    return {reading.side for reading in readings if reading.side and reading.clear_part == part}
