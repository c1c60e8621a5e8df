"""The unit of work: one take in, one complete folder of results out. Running it again changes nothing."""

import importlib.util
import os
from dataclasses import dataclass
from pathlib import Path

from ...core.errors import ConversionError, InputError
from ...core.files.output_folder import output_folder
from ...core.keyframe_file import write_keyframes
from ...core.library.library import Library
from ...core.match_take import LibraryChoice
from ...core.motion import Motion
from ...core.motion_file import write_motion
from ...core.progress import run
from ...core.reconstruct import Reconstruction
from ...core.report.pictures import MATCHES, PICTURES, write_pictures
from ...core.take import Take, read_take
from .blender_silence import blender_silence
from .console import Console
from .matching import chosen_libraries, solve, take_to_match

MOTION, BLEND, BVH, REPORT = "motion.json", "motion.blend", "motion.bvh", "report"
KEYFRAMES = "keyframes.json"
BELONGINGS = (MOTION, BLEND, BVH, *(f"{REPORT}/{name}" for name in PICTURES), f"{REPORT}/{MATCHES}")
"""Every file that a conversion may make, but for the keyframes: these a person may have corrected meanwhile,
and only a conversion that makes them anew may replace them."""


@dataclass(frozen=True, eq=False)
class Conversion:
    """What a conversion made."""

    take: Take
    reconstruction: Reconstruction
    files: tuple[Path, ...]
    """In the order of `BELONGINGS`, keyframes last."""
    choice: LibraryChoice | None = None
    """Which library was matched, and how well, where one was."""
    left_aside: tuple[str, ...] = ()
    """A sentence about what of the take was not used."""

    @property
    def notes(self) -> tuple[str, ...]:
        """What a person should know of the result, one sentence each."""
        reason = () if self.choice is None else (self.choice.reason.rstrip("."),)
        return (*self.left_aside, *reason, *self.reconstruction.notes)


def convert(
    folder: Path,
    output: Path,
    console: Console,
    *,
    keyframes: Path | None = None,
    library: str | None = None,
    floor_m: float | None = None,
    method: str = "map",
    pictures: bool = True,
    debug: bool = False,
) -> Conversion:
    """Convert a take.

    Args:
        folder: The take's folder.
        output: Folder for the results; it changes only when all of them are complete.
        console: Learns of the progress.
        keyframes: The keyframe file; by default the take's own, or with a library none.
        library: Name or file of the library to match with, or `auto`; None where all is posed.
        floor_m: Height of the floor where it is known [m]; for matching.
        method: `map`, `ekf` or `interpolation`.
        pictures: Whether to draw the report.
        debug: Whether to let Blender's messages through.

    Raises:
        InputError: The take or the output folder is unusable.
        ConversionError: No motion could be computed or written, no library fits, or there is no Blender to
            write with.
    """
    console.stage("Reading the take")
    take, libraries = _inputs(folder, output, keyframes, library)
    require_blender("writing motion.blend needs")
    with output_folder(output, BELONGINGS) as place:
        solved = run(solve(take, libraries, method, floor_m), console.progress)
        take, result = solved.take, solved.reconstruction
        console.stage("Writing the motion")
        write_motion(result.motion, place / MOTION)
        if solved.choice is not None:
            write_keyframes(place / KEYFRAMES, take.keyframes, take.body, take.frame_start)
        console.stage("Writing Blender's files")
        _write_scene(take, result.motion, place, Path(os.path.realpath(output)), debug)
        if pictures:
            console.stage("Drawing the pictures")
            write_pictures(place / REPORT, take, result.motion, result.tracks, result.speed)
        made = [name for name in (*BELONGINGS, KEYFRAMES) if (place / name).exists()]
    files = tuple(output / name for name in made)
    left_aside = _left_aside(folder, keyframes) if libraries else ()
    return Conversion(take, result, files, solved.choice, left_aside)


def _inputs(
    folder: Path, output: Path, keyframes: Path | None, library: str | None
) -> tuple[Take, tuple[Library, ...]]:
    """The take, and the libraries to match it with, if it is to be matched."""
    if library is None:
        return read_take(folder, keyframes), ()
    if os.path.realpath(folder) == os.path.realpath(output):
        raise InputError(
            f"{output}: is the take's own folder, whose {KEYFRAMES} the matched keyframes would replace; "
            "name another folder"
        )
    return take_to_match(folder, keyframes), chosen_libraries(library)


def _left_aside(folder: Path, keyframes: Path | None) -> tuple[str, ...]:
    """A sentence where a take has keyframes that a conversion with a library does not use."""
    own = folder / KEYFRAMES
    if keyframes is not None or not own.exists():
        return ()
    return (f"{own} is left aside; --keyframes {own} would use it beside the library",)


def require_blender(what: str) -> None:
    """Say so at once, not after minutes of work, where a .blend cannot be written or read.

    Raises:
        ConversionError: There is no Blender; the sentence begins with `what`.
    """
    if importlib.util.find_spec("bpy") is None:
        raise ConversionError(
            f"{what} Blender: install its Python module (pip install 'keymark[blender]') "
            "or run blender --command keymark in a Blender that has Keymark"
        )


def _write_scene(take: Take, motion: Motion, place: Path, output: Path, debug: bool) -> None:
    """Let Blender write into `place`.

    Blender stores the clip's path relative to where it writes, which must therefore lie as deep as `output`:
    where `place` does not, the files are written into `output` under hidden names first.
    """
    level = place if place.parent == output.parent else output
    hidden = {name: level / f"{place.name}-{name}" for name in (BLEND, BVH)}
    try:
        with blender_silence(debug):
            from ..bridge.scene_file import write_scene

            write_scene(take, motion, hidden[BLEND], hidden[BVH])
        for name, file in hidden.items():
            os.replace(file, place / name)
    finally:
        for file in hidden.values():
            file.unlink(missing_ok=True)
