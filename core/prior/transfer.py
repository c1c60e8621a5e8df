"""Transfer of postures to an actor of other proportions."""

import re
from dataclasses import replace

import numpy as np

from ..body.actor import Actor
from ..body.body_volume import lower_sole_m
from ..body.kinematics import Body
from ..body.mirror import mirrored, mirrored_actor
from ..body.posture import Posture
from ..body.skeleton import SIDES
from ..errors import InputError, shown
from .library import Library, LibraryMotion, LibraryPosture, MotionStep
from .texts import LONGEST_IDENTIFIER, LONGEST_NAME, unique_name

SAME_M = 1e-6  # lengths that differ by less are equal; files keep fewer digits than memory does


def transferred(posture: LibraryPosture | Posture, actor: Actor, body: Body) -> Posture:
    """Transfer a posture to another body: the same joint angles, location and height scaled.

    Both scale with the length of the legs. Height is that of the lowest sole, so that a foot on the floor
    z = 0 stays on it.

    `actor`: the one it was posed on. The very same object where both have the same proportions.
    """
    given = posture.posture if isinstance(posture, LibraryPosture) else posture
    if _same(actor, body.actor):
        return given
    scale = leg_length_m(body.actor) / leg_length_m(actor)
    moved = given.translation * scale
    height = scale * lower_sole_m(Body(actor, given.skeleton), given)
    placed = Posture(given.skeleton, moved, given.rotations, given.angles)
    lift = height - lower_sole_m(body, placed)
    return Posture(
        given.skeleton, moved + lift[..., None] * np.array([0.0, 0.0, 1.0]), given.rotations, given.angles
    )


def leg_length_m(actor: Actor) -> float:
    """Mean length of the legs, from hip to ankle [m]."""
    return sum(actor.segments_m[f"{part}.{side}"] for part in ("thigh", "shin") for side in SIDES) / 2.0


def _same(first: Actor, second: Actor) -> bool:
    return all(abs(first.segments_m[name] - second.segments_m[name]) < SAME_M for name in first.segments_m)


# --- Mirrored libraries


MIRRORED = "mirrored"
_SIDE = re.compile(r"(?<![^\W_])((?i:left|right)|(?<=[._ -])[LR])(?![^\W_])")
_OPPOSITE = {"left": "right", "right": "left", "l": "r", "r": "l"}
ALIKE = 1e-6  # tolerance of equal postures: meters, radians, and elements of rotation matrices


def mirrored_name(name: str) -> str:
    """A name with the words left and right exchanged, or the letters L and R after a dot or space."""
    return _SIDE.sub(lambda found: _as_written(_OPPOSITE[found[0].lower()], found[0]), name)


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
            LibraryPosture(names[entry.name], mirrored(entry.posture), entry.tags)
            for entry in library.postures
        ),
        motions=tuple(_motion(motion, mirrored_name(motion.name), names) for motion in library.motions),
    )


def with_mirrored(library: Library) -> Library:
    """A library extended by the mirror image of every posture and motion.

    Symmetric ones, and those whose mirror image is in the library already, are not added. A name without left
    or right gets the suffix `(mirrored)`.

    Raises:
        InputError: The actor's left and right differ in length, so mirrored postures do not fit.
    """
    other = mirrored_actor(library.actor).segments_m
    if any(abs(other[name] - length) > SAME_M for name, length in library.actor.segments_m.items()):
        raise InputError(
            f"library {shown(library.identifier)}: its actor's left and right differ in length, so mirrored "
            "postures do not fit; mirror the whole library instead, its actor with it"
        )
    names: dict[str, str] = {}
    added: list[LibraryPosture] = []
    taken = [entry.name for entry in library.postures]
    there = Posture.stack([entry.posture for entry in library.postures])
    for entry in library.postures:
        opposite = mirrored(entry.posture)
        found = _find(opposite, there)
        if found is not None:
            twin = library.postures[found].name
        else:
            twin = unique_name(_distinct(entry.name), [*taken, *(new.name for new in added)])
            added.append(LibraryPosture(twin, opposite, entry.tags))
        names[entry.name] = twin
    motions: list[LibraryMotion] = list(library.motions)
    for motion in library.motions:
        twin_motion = _motion(motion, _distinct(motion.name), names)
        if not any(_same_steps(old, twin_motion) for old in library.motions):
            title = unique_name(twin_motion.name, [old.name for old in motions])
            motions.append(replace(twin_motion, name=title))
    return replace(library, postures=(*library.postures, *added), motions=tuple(motions))


def _as_written(word: str, example: str) -> str:
    if example.isupper():
        return word.upper()
    return word.capitalize() if example[0].isupper() else word


def _distinct(name: str) -> str:
    swapped = mirrored_name(name)
    return swapped if swapped != name else _marked(name, f" ({MIRRORED})", LONGEST_NAME)


def _marked(text: str, mark: str, longest: int) -> str:
    """The text with the suffix added, or removed where it has it."""
    return text.removesuffix(mark) if text.endswith(mark) else text[: longest - len(mark)].strip() + mark


def _motion(motion: LibraryMotion, name: str, names: dict[str, str]) -> LibraryMotion:
    x, y, heading = motion.travel
    steps = tuple(MotionStep(names[step.posture], step.time_s) for step in motion.steps)
    return replace(
        motion, name=name[:LONGEST_NAME].strip(), steps=steps, travel=(-x + 0.0, y, -heading + 0.0)
    )


def _find(posture: Posture, among: Posture) -> int | None:
    far = [
        np.abs(getattr(among, name) - getattr(posture, name)).reshape(len(among.translation), -1).max(axis=1)
        for name in ("translation", "rotations", "angles")
    ]
    alike = np.flatnonzero(np.max(far, axis=0) < ALIKE)
    return int(alike[0]) if len(alike) else None


def _same_steps(first: LibraryMotion, second: LibraryMotion) -> bool:
    return replace(first, name="") == replace(second, name="")
