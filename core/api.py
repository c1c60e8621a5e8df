"""Keymark from Python: a clip or a take in, its motion out; the command line goes the same way.

`docs/api.md` shows a whole clip in ten lines. What takes long is a job, which `run` runs to its end.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from .estimate.reconstruct import Reconstruction
from .markers.reading import Reading
from .prior.library import Library
from .prior.registry import SHIPPED, find_libraries
from .prior.texts import EVERY_LIBRARY
from .progress import Job, run
from .session.described import described
from .session.session import NO_BRIDGE, Bridge, Inputs, Keep, Session, keep_nothing
from .session.stages import reach
from .take.conversion_settings import NO_SETTINGS, ConversionSettings
from .take.description import Description, describe
from .take.motion import write_motion
from .take.reference import ReadArmature
from .take.take import Take

__all__ = ["Reconstruction", "animate", "convert", "reconstruct", "run", "write_motion"]


def animate(clip: Path, height_m: float, libraries: Sequence[Library] | None = None) -> Job[Session]:
    """From a clip and the performer's height to a motion; poses are found in libraries, by default all.

    Raises:
        InputError: The clip cannot be used, nobody is seen in it, or there is no library with a posture.
        ConversionError: No motion could be computed.
    """
    fields = {"actor": {"height_m": height_m}, "keyframes": EVERY_LIBRARY}
    description = describe(clip, fields, "height_m")
    if libraries is None:
        libraries = find_libraries(EVERY_LIBRARY, [SHIPPED])
    return convert(description, description.settings, libraries)


def convert(
    description: Description,
    settings: ConversionSettings = NO_SETTINGS,
    libraries: Sequence[Library] = (),
    read_armature: ReadArmature | None = None,
    bridge: Bridge = NO_BRIDGE,
    keep: Keep = keep_nothing,
) -> Job[Session]:
    """From a described take to its motion, and on with what only Blender can do, by the names of stages.

    `read_armature` reads a reference motion that only Blender can; `keep` gets each stage, see `advance`.

    Raises:
        InputError: The take or its clip cannot be used, or there is no library with a posture.
        ConversionError: No motion could be computed.
    """
    inputs = described(description, settings, libraries, read_armature)
    return reach(Session(replace(inputs, bridge=bridge)), "retarget", None, keep)


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
