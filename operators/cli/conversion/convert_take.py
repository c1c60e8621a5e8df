"""Conversion of one take into one complete folder of results."""

import os
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from ....core.errors import InputError
from ....core.estimate.reconstruct import check_method
from ....core.files.commit import backup_name
from ....core.files.digest import content_digest
from ....core.files.json_file import read_json, write_json
from ....core.files.output_folder import output_folder
from ....core.files.paths import real_path
from ....core.pipeline.convert import find_and_reconstruct, take_to_convert
from ....core.pipeline.result import Conversion, conversion_record
from ....core.prior.library import Library, library_digest
from ....core.progress import run
from ....core.report.overlay_sheet import performer_contours
from ....core.report.pictures import EARLIER_PICTURES, PICTURES, write_pictures
from ....core.retarget.maps.map_registry import map_digests
from ....core.retarget.retarget_record import RECORD_FILE as RETARGET
from ....core.retarget.retarget_record import RetargetRecord
from ....core.review.frame_evidence import compare_keypoints
from ....core.take.conversion_digest import conversion_digest
from ....core.take.conversion_record import RECORD_FILE, find_record, is_up_to_date, write_record
from ....core.take.conversion_record import RECORD_FILE as RECORD
from ....core.take.conversion_settings import METHODS, ConversionSettings
from ....core.take.description import Description
from ....core.take.keyframe_file import write_keyframes
from ....core.take.motion import Motion, write_motion
from ....core.take.take import Take
from ..console import Console
from ..library_search_path import library_folders, requested_libraries
from ..parser import require_blender, version
from .blender_files import BLEND, BVH, refuse_unsupported_paths, write_blender_files
from .character_result import CHARACTER_BLEND, CHARACTER_PICTURE, opened_character, write_character_result

AS_MADE = ".as_made.json"
"""File with the SHA-256 of files as they were made, beside the results. It has those whose bytes differ from
run to run though their content does not, so that the record itself is always the same."""
LARGEST_BYTES = 2**16
RECORDS = (RECORD_FILE, RETARGET)
"""Files that nobody edits."""


def changed_files(
    output: Path,
    staging_folder: Path,
    names: Iterable[str],
    editable: Collection[str],
    recorded: Mapping[str, str],
) -> dict[str, str]:
    """Files of a result that are no longer as they were made, though new ones are about to replace them.

    Args:
        output: Folder of the result.
        staging_folder: Folder of the new files.
        names: Files that the new result replaces or removes, as paths in the folder. Of those in `editable`
            only the ones that are made anew are replaced.
        editable: Files that belong to a person where no record says that a conversion has made them.
        recorded: Digests of the files that the folder's record lists; empty where there is none.

    Returns:
        The names under which these files are to be kept, by their present names.

    Raises:
        InputError: A file cannot be read.
    """
    try:
        made = {**recorded, **read_json(output / AS_MADE, LARGEST_BYTES)} if recorded else {}
    except InputError:
        made = {}
    kept = {}
    for name in names:
        old, new = output / name, staging_folder / name
        replaced = new.is_file() or (name in made and name not in editable)
        if name in RECORDS or not replaced or not old.is_file() or not (name in made or name in editable):
            continue
        digest = content_digest(old)
        if digest != made.get(name) and not (new.is_file() and content_digest(new) == digest):
            kept[name] = backup_name(old).relative_to(output).as_posix()
    return kept


def write_made_digests(staging_folder: Path, names: Iterable[str]) -> None:
    """Record the digests of files as they were made, by which a later conversion notices changes."""
    write_json(staging_folder / AS_MADE, {name: content_digest(staging_folder / name) for name in names})


def kept_note(name: str, other: str) -> str:
    """The note on a file that is kept under another name."""
    return f"{name} was changed after Keymark had made it and is kept as {other}"


MOTION, REPORT, KEYFRAMES = "motion.json", "report", "keyframes.json"
RESULT_FILES = (
    RECORD,
    MOTION,
    BLEND,
    BVH,
    CHARACTER_BLEND,
    RETARGET,
    CHARACTER_PICTURE,
    *(f"{REPORT}/{name}" for name in (*PICTURES, *EARLIER_PICTURES)),
)
"""Every file that a conversion may make, but for the keyframes: a person may have corrected these meanwhile,
so that only a conversion that makes them anew may replace them."""
EDITABLE_FILES = (BLEND, CHARACTER_BLEND, KEYFRAMES)
"""Files that people go on working in; one that no record vouches for is taken to be theirs."""


@dataclass(frozen=True, eq=False)
class _Prepared:
    """One conversion before it runs: its whole input, and the output folder, which is locked meanwhile."""

    description: Description
    settings: ConversionSettings
    libraries: tuple[Library, ...]
    digest: str
    output: Path
    staging_folder: Path
    kept_names: dict[str, str]
    """Files in `output` that a person has changed, with the names under which they are kept; filled once the
    new files are made."""


def convert_take(
    description: Description,
    output: Path,
    console: Console,
    settings: ConversionSettings,
    debug: bool = False,
) -> Conversion:
    """Convert a take."""
    made = convert_if_changed(description, output, console, settings, debug, again=True)
    assert made is not None
    return made


def convert_if_changed(
    description: Description,
    output: Path,
    console: Console,
    settings: ConversionSettings,
    debug: bool = False,
    again: bool = False,
) -> Conversion | None:
    """Convert a take as `convert_take` does, but return None where `output` holds the result already.

    That is so where the digest of the input (`core/take/conversion_digest`) is that in the result's record,
    and every file of the record is there; times of files do not count. `again`: convert it nevertheless.
    """
    console.stage("Reading the take")
    require_blender("writing motion.blend needs")
    refuse_unsupported_paths(description, output)
    kept_names: dict[str, str] = {}
    with output_folder(output, (*RESULT_FILES, AS_MADE), RECORD, kept_names) as staging_folder:
        libraries = () if settings.library is None else requested_libraries(settings.library)
        digests = [library_digest(library) for library in libraries]
        maps = () if settings.character is None else map_digests(settings.character.map, library_folders())
        digest = conversion_digest(description, settings, digests, output, version(), maps)
        if not again and is_up_to_date(output, digest):
            return None
        prepared = _Prepared(description, settings, libraries, digest, output, staging_folder, kept_names)
        return _convert(prepared, console, debug)


def _convert(prepared: _Prepared, console: Console, debug: bool) -> Conversion:
    """Make every file of the result in the staging folder; the record comes last."""
    settings, output, staging_folder = prepared.settings, prepared.output, prepared.staging_folder
    if settings.library is not None:
        _refuse_own_folder(prepared.description, output)
    take = take_to_convert(prepared.description, settings)
    method = settings.method or METHODS[0]
    check_method(take, method)
    if settings.character is not None:
        console.stage("Opening the character")
        with opened_character(settings.character.file, settings.character.map, debug):
            pass  # what is wrong with it is better known before the work
    libraries = None if settings.library is None else prepared.libraries
    job = find_and_reconstruct(take, libraries, method, settings.floor_m)
    reconstructed = run(job, console.progress)
    take, result = reconstructed.take, reconstructed.reconstruction
    console.stage("Writing the motion")
    write_motion(result.motion, staging_folder / MOTION)
    if reconstructed.found is not None:
        write_keyframes(staging_folder / KEYFRAMES, take.keyframes, take.body, take.frame_start)
    console.stage("Writing Blender's files")
    curves = {BLEND: write_blender_files(take, result.motion, staging_folder, real_path(output), debug)}
    character = _write_character(prepared, take, result.motion, console, debug)
    curves |= {} if character is None else {CHARACTER_BLEND: character.files[CHARACTER_BLEND]}
    write_made_digests(staging_folder, curves)
    if settings.pictures is not False:
        console.stage("Drawing the pictures")
        write_pictures(
            staging_folder / REPORT,
            take,
            result.motion,
            result.tracks,
            compare_keypoints(result),
            performer_contours(result),
        )
    made = [name for name in (*RESULT_FILES, KEYFRAMES) if (staging_folder / name).exists()]
    prepared.kept_names.update(
        changed_files(
            output, staging_folder, (*RESULT_FILES, KEYFRAMES), EDITABLE_FILES, _recorded_files(output)
        )
    )
    conversion = Conversion(
        take,
        result,
        files=tuple(output / name for name in (*made, RECORD)),
        found=reconstructed.found,
        libraries=prepared.libraries,
        conversion_notes=(
            *_unused_keyframes_note(prepared.description, settings),
            *(() if character is None else (*character.doubts, *character.notes)),
            *(kept_note(*names) for names in prepared.kept_names.items()),
        ),
    )
    write_record(
        staging_folder,
        conversion_record(conversion, version(), prepared.digest, staging_folder, made, curves),
    )
    return conversion


def _write_character(
    prepared: _Prepared, take: Take, motion: Motion, console: Console, debug: bool
) -> RetargetRecord | None:
    if prepared.settings.character is None:
        return None
    from ...bridge.result_files import show_take

    return write_character_result(
        prepared.settings.character,
        motion,
        take.name,
        lambda scene, shown: show_take(scene, take, shown),
        (prepared.staging_folder, real_path(prepared.output)),
        console,
        debug,
        picture=prepared.settings.pictures is not False,
    )


def _recorded_files(output: Path) -> Mapping[str, str]:
    record = find_record(output)
    return {} if record is None else record.files


def _refuse_own_folder(description: Description, output: Path) -> None:
    if os.path.realpath(description.folder) == os.path.realpath(output):
        raise InputError(
            f"{output}: is the take's own folder, whose {KEYFRAMES} the found keyframes would replace; "
            "name another folder"
        )


def _unused_keyframes_note(description: Description, settings: ConversionSettings) -> tuple[str, ...]:
    own = description.keyframes
    if settings.library is None or settings.keyframes is not None or not os.path.exists(own):
        return ()
    return (f"{own} is left aside; --keyframes {own} --library {settings.library} would use it too",)
