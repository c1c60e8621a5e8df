"""The unit of work: one take in, one complete folder of results out. Running it again changes nothing."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from ....core.errors import InputError
from ....core.files.output_folder import output_folder, real_path
from ....core.library.library import Library
from ....core.library.library_file import library_digest
from ....core.matching.match_take import take_to_match
from ....core.progress import run
from ....core.report.pictures import MATCHES, PICTURES, write_pictures
from ....core.take.conversion_digest import conversion_digest
from ....core.take.conversion_record import NAME as RECORD
from ....core.take.conversion_record import is_finished, write_record
from ....core.take.conversion_settings import ConversionSettings
from ....core.take.description import Description
from ....core.take.keyframe_file import write_keyframes
from ....core.take.methods import METHODS
from ....core.take.motion import Motion
from ....core.take.motion_file import write_motion
from ....core.take.take import Take, read_described
from ..blender_silence import blender_silence
from ..console import Console
from ..library_search_path import requested_libraries
from ..require_blender import require_blender
from ..version import version
from .changed_files import AS_MADE, changed_files, kept_note, note_as_made
from .matched_keyframes import solve
from .result import Conversion, conversion_record
from .unsupported_paths import check_places

MOTION, BLEND, BVH, REPORT = "motion.json", "motion.blend", "motion.bvh", "report"
KEYFRAMES = "keyframes.json"
BELONGINGS = (RECORD, MOTION, BLEND, BVH, *(f"{REPORT}/{name}" for name in PICTURES), f"{REPORT}/{MATCHES}")
"""Every file that a conversion may make, but for the keyframes: these a person may have corrected meanwhile,
and only a conversion that makes them anew may replace them."""
WORKED_IN = (BLEND, KEYFRAMES)
"""What people go on working in; one that no record vouches for is taken to be theirs."""


def convert(
    description: Description,
    output: Path,
    console: Console,
    settings: ConversionSettings,
    debug: bool = False,
) -> Conversion:
    """Convert a take.

    Args:
        description: The take's.
        output: Folder for the results; it changes only when all of them are complete.
        console: Learns of the progress.
        settings: How; with a library only the keyframes that are named here count, else the take's own.
        debug: Whether to let Blender's messages through.

    Raises:
        InputError: The take or the output folder is unusable.
        ConversionError: No motion could be computed or written, no library fits a take that is not posed, or
            there is no Blender to write with.
    """
    with _work(description, output, console, settings) as work:
        return _convert(work, console, debug)


def convert_if_changed(
    description: Description,
    output: Path,
    console: Console,
    settings: ConversionSettings,
    debug: bool = False,
) -> Conversion | None:
    """Convert a take as `convert` does, but where the whole result of the very same input is there already.

    Returns:
        What was made; None where it was there.
    """
    with _work(description, output, console, settings) as work:
        return None if is_finished(output, work.digest) else _convert(work, console, debug)


@dataclass(frozen=True, eq=False)
class _Work:
    """One conversion: all that it follows from, and where it goes."""

    description: Description
    settings: ConversionSettings
    libraries: tuple[Library, ...]
    digest: str
    output: Path
    """Where the results will be."""
    place: Path
    """Where they are made."""
    aside: dict[str, str]
    """Files that a person has changed, and where each is kept."""


@contextmanager
def _work(
    description: Description, output: Path, console: Console, settings: ConversionSettings
) -> Iterator[_Work]:
    """The folder for a conversion while it is held, and what the take, its settings and libraries come to."""
    console.stage("Reading the take")
    require_blender("writing motion.blend needs")
    check_places(description, output)
    aside: dict[str, str] = {}
    with output_folder(output, (*BELONGINGS, AS_MADE), RECORD, aside) as place:
        libraries = () if settings.library is None else requested_libraries(settings.library)
        digests = [library_digest(library) for library in libraries]
        digest = conversion_digest(description, settings, digests, output, version())
        yield _Work(description, settings, libraries, digest, output, place, aside)


def _convert(work: _Work, console: Console, debug: bool) -> Conversion:
    description, settings, output, place = work.description, work.settings, work.output, work.place
    take = _take(description, settings, output)
    solving = solve(take, work.libraries, settings.method or METHODS[0], settings.floor_m)
    solved = run(solving, console.progress)
    take, result = solved.take, solved.reconstruction
    console.stage("Writing the motion")
    write_motion(result.motion, place / MOTION)
    if solved.choice is not None:
        write_keyframes(place / KEYFRAMES, take.keyframes, take.body, take.frame_start)
    console.stage("Writing Blender's files")
    curves = _write_scene(take, result.motion, place, real_path(output), debug)
    note_as_made(place, BLEND)
    if settings.pictures is not False:
        console.stage("Drawing the pictures")
        write_pictures(place / REPORT, take, result.motion, result.tracks, result.speed)
    made = [name for name in (*BELONGINGS, KEYFRAMES) if (place / name).exists()]
    files = tuple(output / name for name in (*made, RECORD))
    work.aside.update(changed_files(output, place, (*BELONGINGS, KEYFRAMES), WORKED_IN))
    kept = (kept_note(*names) for names in work.aside.items())
    left_aside = (*_left_aside(description, settings), *solved.unfit, *kept)
    conversion = Conversion(take, result, files, solved.choice, left_aside)
    write_record(place, conversion_record(conversion, work.digest, place, made, {BLEND: curves}))
    return conversion


def _take(description: Description, settings: ConversionSettings, output: Path) -> Take:
    if settings.library is None:
        return read_described(description, settings.keyframes)
    if os.path.realpath(description.folder) == os.path.realpath(output):
        raise InputError(
            f"{output}: is the take's own folder, whose {KEYFRAMES} the matched keyframes would replace; "
            "name another folder"
        )
    return take_to_match(description, settings.keyframes)


def _left_aside(description: Description, settings: ConversionSettings) -> tuple[str, ...]:
    """A sentence where a take has keyframes that a conversion with a library does not use."""
    own = description.keyframes
    if settings.library is None or settings.keyframes is not None or not os.path.exists(own):
        return ()
    return (f"{own} is left aside; --keyframes {own} would use it beside the library",)


def _write_scene(take: Take, motion: Motion, place: Path, output: Path, debug: bool) -> str:
    """Let Blender write into `place`; returns the digest of the curves in the .blend.

    Blender stores the clip's path relative to where it writes, which must therefore lie as deep as `output`:
    where `place` does not, the files are written into `output` under hidden names first.
    """
    level = place if place.parent == output.parent else output
    hidden = {name: level / f"{place.name}-{name}" for name in (BLEND, BVH)}
    try:
        with blender_silence(debug):
            from ...bridge.result_files import write_scene

            curves = write_scene(take, motion, hidden[BLEND], hidden[BVH])
        for name, file in hidden.items():
            os.replace(file, place / name)
        return curves
    finally:
        for file in hidden.values():
            file.unlink(missing_ok=True)
