"""A camera that was found: given to the take's camera, and said in words."""

from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ..bridge.camera_placement import still_camera, write_found_camera
from ..shell.takes import footage_of
from .properties import confirm_placement
from .take_footage import lens_is_guess

if TYPE_CHECKING:
    from ...core.camera.camera_evidence import CameraEvidence
    from ...core.camera.camera_fit import CameraFit

HINTS = {
    "height": "Height is kept: draw something of known height, or the performer nearer and farther away",
    "tilt": "Tilt is kept: draw verticals farther apart, or the performer nearer and farther away",
    "roll": "Roll is kept: draw verticals, or the performer at both sides of the picture",
    "lens": "Lens is kept: level lines that run away from a tilted camera would tell it",
}
"""What would determine each part of the camera that a picture does not determine."""
MOST_EXCESS = 3.0
"""Ratio of the variance of the distances to the expected one beyond which lines contradict each other."""
NOTHING_FOUND = (
    "the picture says nothing of its camera yet; draw longer lines, farther apart, or a known height, or the "
    "performer at two places, nearer and farther away"
)
CONTRADICTION = "The lines are {px:.1f} px off: one of them is not what it is said to be, or lies wrong"


def fit_take(take: bpy.types.PropertyGroup, evidence: "CameraEvidence") -> "CameraFit":
    """Find a take's camera from what its picture shows; a lens that nobody guessed is kept."""
    from ...core.camera.camera_fit import fit_camera

    camera = still_camera(footage_of(take.id_data, take))
    return fit_camera(camera, evidence, lens_is_known=not lens_is_guess(take))


def is_found(fit: "CameraFit") -> bool:
    """Whether a picture determines anything of its camera."""
    return len(fit.kept) < len(fit.std)


def write_fit(take: bpy.types.PropertyGroup, fit: "CameraFit") -> None:
    """Give the take's camera what was found, and keep in words how sure it is."""
    if not is_found(fit):
        raise InputError(NOTHING_FOUND)
    lens_was_guess = lens_is_guess(take)
    write_found_camera(footage_of(take.id_data, take), fit.camera)
    confirm_placement(take)
    if "lens" not in fit.kept:
        for other in take.id_data.keymark.takes:
            if other.camera == take.camera:
                other.guessed_lens_mm = 0.0
    take.camera_findings = "\n".join((deviations(fit), *doubts(fit, lens_was_guess)))


def values(fit: "CameraFit") -> str:
    """The camera found, with the deviations of what the picture determines."""
    kept = {name: " (kept)" if name in fit.kept else "" for name in HINTS}
    said = (fit.in_words(name) + kept[name] for name in HINTS)
    return "   ".join(part[:1].upper() + part[1:] for part in said)


def deviations(fit: "CameraFit") -> str:
    """The deviations alone, of what the picture determines."""
    from ...core.camera.camera_fit import UNITS

    found = (f"{name} ± {fit.spread(name)}{UNITS[name][1]}" for name in UNITS if name not in fit.kept)
    return f"Found: {', '.join(found)}"


def doubts(fit: "CameraFit", lens_is_guess: bool) -> list[str]:
    """Sentences on what was not found and how it would be, and on a contradiction."""
    open_ones = [name for name in HINTS if name in fit.kept and (name != "lens" or lens_is_guess)]
    sentences = [HINTS[name] for name in open_ones]
    if fit.excess > MOST_EXCESS:
        sentences.insert(0, CONTRADICTION.format(px=fit.misfit_px))
    return sentences
