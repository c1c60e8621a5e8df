"""Transfer of postures to an actor of other proportions."""

import re
from dataclasses import replace

from ..body.actor import Actor
from ..body.body_volume import lower_sole_m
from ..body.kinematics import Body
from ..body.mirror import mirrored, mirrored_actor
from ..body.posture import UP, Posture
from ..body.skeleton import SIDES
from .library import Library, LibraryMotion, MotionStep
from .texts import LONGEST_IDENTIFIER, LONGEST_NAME, unique_name

SAME_M = 1e-6  # lengths that differ by less are equal; files keep fewer digits than memory does


def transferred(posture: Posture, actor: Actor, body: Body) -> Posture:
    """Transfer postures to another body: the same joint angles, location and height scaled.

    Both scale with the length of the legs. Height is that of the lowest sole, so that a foot on the floor
    z = 0 stays on it.

    `actor`: the one it was posed on. The very same object where both have the same proportions.
    """
    if all(abs(body.actor.segments_m[name] - length) < SAME_M for name, length in actor.segments_m.items()):
        return posture
    scale = leg_length_m(body.actor) / leg_length_m(actor)
    moved = posture.translation * scale
    height = scale * lower_sole_m(Body(actor, posture.skeleton), posture)
    placed = Posture(posture.skeleton, moved, posture.rotations, posture.angles)
    lift = height - lower_sole_m(body, placed)
    return Posture(posture.skeleton, moved + lift[..., None] * UP, posture.rotations, posture.angles)


def leg_length_m(actor: Actor) -> float:
    """Mean length of the legs, from hip to ankle [m]."""
    return sum(actor.segments_m[f"{part}.{side}"] for part in ("thigh", "shin") for side in SIDES) / 2.0


# --- Mirrored libraries


MIRRORED = "mirrored"
_SIDE = re.compile(r"(?<![^\W_])((?i:left|right)|(?<=[._ -])[LR])(?![^\W_])")
_OPPOSITE = {"left": "right", "right": "left", "l": "r", "r": "l"}


def mirrored_name(name: str) -> str:
    """A name with the words left and right exchanged, or the letters L and R after a dot or space."""

    def opposite(found: re.Match[str]) -> str:
        word = _OPPOSITE[found[0].lower()]
        return word.upper() if found[0].isupper() else word.capitalize() if found[0][0].isupper() else word

    return _SIDE.sub(opposite, name)


def mirrored_library(library: Library) -> Library:
    """The mirror image of a library, under an identifier and title of its own.

    Mirroring twice gives the same library again.
    """
    names: dict[str, str] = {}
    for entry in library.postures:
        names[entry.name] = unique_name(mirrored_name(entry.name)[:LONGEST_NAME].strip(), names.values())
    return replace(
        library,
        identifier=_marked(library.identifier, f"_{MIRRORED}", LONGEST_IDENTIFIER),
        title=_marked(library.title, f" ({MIRRORED})", LONGEST_NAME),
        actor=mirrored_actor(library.actor),
        postures=tuple(
            replace(entry, name=names[entry.name], posture=mirrored(entry.posture))
            for entry in library.postures
        ),
        motions=tuple(_mirrored_motion(motion, names) for motion in library.motions),
    )


def _marked(text: str, mark: str, longest: int) -> str:
    """The text with the suffix added, or removed where it has it."""
    return text.removesuffix(mark) if text.endswith(mark) else text[: longest - len(mark)].strip() + mark


def _mirrored_motion(motion: LibraryMotion, names: dict[str, str]) -> LibraryMotion:
    x, y, heading = motion.travel
    steps = tuple(MotionStep(names[step.posture], step.time_s) for step in motion.steps)
    name = mirrored_name(motion.name)[:LONGEST_NAME].strip()
    return replace(motion, name=name, steps=steps, travel=(-x + 0.0, y, -heading + 0.0))
