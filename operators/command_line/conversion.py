"""The unit of work: one take in, one complete folder of results out. Running it again changes nothing."""

import importlib.util
import os
from dataclasses import dataclass
from pathlib import Path

from ...core.errors import ConversionError
from ...core.files.output_folder import output_folder
from ...core.motion import Motion
from ...core.motion_file import write_motion
from ...core.progress import run
from ...core.reconstruct import Reconstruction, reconstruct
from ...core.report.pictures import PICTURES, write_pictures
from ...core.take import Take, read_take
from .blender_silence import blender_silence
from .console import Console

MOTION, BLEND, BVH, REPORT = "motion.json", "motion.blend", "motion.bvh", "report"
BELONGINGS = (MOTION, BLEND, BVH, *(f"{REPORT}/{name}" for name in PICTURES))
"""Every file that a conversion may make."""


@dataclass(frozen=True, eq=False)
class Conversion:
    """What a conversion made."""

    take: Take
    reconstruction: Reconstruction
    files: tuple[Path, ...]
    """In the order of `BELONGINGS`."""


def convert(
    folder: Path,
    output: Path,
    console: Console,
    *,
    keyframes: Path | None = None,
    method: str = "map",
    pictures: bool = True,
    debug: bool = False,
) -> Conversion:
    """Convert a take.

    Args:
        folder: The take's folder.
        output: Folder for the results; it changes only when all of them are complete.
        console: Learns of the progress.
        keyframes: The keyframe file; by default the take's own.
        method: `map`, `ekf` or `interpolation`.
        pictures: Whether to draw the report.
        debug: Whether to let Blender's messages through.

    Raises:
        InputError: The take or the output folder is unusable.
        ConversionError: No motion could be computed or written, or there is no Blender to write with.
    """
    console.stage("Reading the take")
    take = read_take(folder, keyframes)
    _require_blender()
    with output_folder(output, BELONGINGS) as place:
        reconstruction = run(reconstruct(take, method), console.progress)
        console.stage("Writing the motion")
        write_motion(reconstruction.motion, place / MOTION)
        console.stage("Writing Blender's files")
        _write_scene(take, reconstruction.motion, place, Path(os.path.realpath(output)), debug)
        if pictures:
            console.stage("Drawing the pictures")
            result = reconstruction
            write_pictures(place / REPORT, take, result.motion, result.tracks, result.speed)
        made = [name for name in BELONGINGS if (place / name).exists()]
    return Conversion(take, reconstruction, tuple(output / name for name in made))


def _require_blender() -> None:
    """Say so at once, not after minutes of work, where the .blend cannot be written."""
    if importlib.util.find_spec("bpy") is None:
        raise ConversionError(
            "writing motion.blend needs Blender: install its Python module (pip install 'keymark[blender]') "
            "or run blender --command keymark convert in a Blender that has Keymark"
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
