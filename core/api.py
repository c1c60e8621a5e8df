"""Keymark from Python: a clip or a take in, its motion out; the command line and Blender go the same way.

`docs/api.md` shows a whole clip in ten lines. Every function returns a job, which `run` runs to its end.
"""

from collections.abc import Sequence
from pathlib import Path

from .estimate.reconstruct import Reconstruction
from .markers.reading import Reading
from .prior.library import Library
from .progress import Job, run
from .session.described import ReadArmature, described
from .session.session import Inputs, Session
from .session.stages import reach
from .take.conversion_settings import NO_SETTINGS, ConversionSettings
from .take.description import ASSUMED, Description, describe
from .take.take import Take

__all__ = ["animate", "convert", "reconstruct", "run"]


def animate(clip: Path, height_m: float, libraries: Sequence[Library]) -> Job[Session]:
    """From a clip and the performer's height to a motion; its poses are found in the libraries.

    Raises:
        InputError: The clip cannot be used, nobody is seen in it, or there is no library with a posture.
        ConversionError: No motion could be computed.
    """
    fields = {"actor": {"height_m": height_m}, "keyframes": "auto"}
    description = describe(clip, fields, ASSUMED)
    return convert(description, description.settings, libraries)


def convert(
    description: Description,
    settings: ConversionSettings = NO_SETTINGS,
    libraries: Sequence[Library] = (),
    read_armature: ReadArmature | None = None,
) -> Job[Session]:
    """From a described take to its motion; `read_armature` reads a reference motion that only Blender can.

    Raises:
        InputError: The take or its clip cannot be used, or there is no library with a posture.
        ConversionError: No motion could be computed.
    """
    return reach(Session(described(description, settings, libraries, read_armature)), "reconstruct")


def reconstruct(
    take: Take,
    method: str = "map",
    reading: Reading | None = None,
    libraries: Sequence[Library] | None = None,
    floor_m: float | None = None,
) -> Job[Reconstruction]:
    """The motion of a take that was read, from its keyframes or from poses that are found in libraries.

    `reading` is one of its clip, which is then not opened again.

    Raises:
        InputError: The clip cannot be used, a color matches nothing in it, or the method is unknown.
        ConversionError: No motion could be computed.
        ValueError: The reading is one of other markers.
    """
    inputs = Inputs(take, method, libraries=libraries, floor_m=floor_m)
    session = yield from reach(Session(inputs, {} if reading is None else {"read": reading}), "reconstruct")
    return session[Reconstruction]
