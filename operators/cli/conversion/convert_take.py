"""Conversion of one take into one complete folder of results."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from ....core.api import convert
from ....core.errors import pluralize
from ....core.estimate.reconstruct import Reconstruction
from ....core.files.output_folder import output_folder
from ....core.files.paths import real_path
from ....core.prior.library import library_digest
from ....core.progress import Job, run
from ....core.report.pictures import performer_contours, write_pictures
from ....core.retarget.maps.map_registry import map_digests
from ....core.retarget.retarget_record import RetargetRecord
from ....core.review.frame_evidence import compare_keypoints
from ....core.session import result as results
from ....core.session.result import Conversion
from ....core.session.session import Keep, Posed, Session, keep_nothing
from ....core.take import conversion_record
from ....core.take.conversion_record import BLEND, CHARACTER_BLEND, RECORD_FILE, REPORT
from ....core.take.conversion_settings import ConversionSettings
from ....core.take.description import Description
from ....core.take.reference import ReferenceMotion
from ....core.take.steady_camera import followed_camera
from ....core.take.take import Take
from ..blender_silence import blender_silence
from ..console import Console, require_blender, version
from .blender_files import library_folders, refuse_unsupported_paths, requested_libraries, write_blender_files
from .character_result import opened_character, write_character_result


class UpToDate(Exception):  # noqa: N818
    """The folder holds the result already."""


def convert_take(
    description: Description,
    output: Path,
    console: Console,
    settings: ConversionSettings,
    debug: bool = False,
    formats: tuple[str, ...] = (),
    keep: Keep = keep_nothing,
    notes: tuple[str, ...] = (),
    again: bool = True,
) -> Conversion:
    """Convert a take; `output` changes only when all results are complete.

    Where keyframes are found, only posed ones that the settings name count beside them. `formats` are words
    of `EXPORTS`; `keep` gets each stage (`advance`); `notes` are sentences on how the clip was read. UpToDate
    is raised where, without `again`, the record there is of this input and all of its files are there.
    """
    console.stage("Reading the take")
    require_blender("writing motion.blend needs")
    refuse_unsupported_paths(description, output)
    character, kept_names = settings.character, dict[str, str]()
    own = results.own_files(description, output)
    with output_folder(output, own, RECORD_FILE, kept_names) as staging_folder:
        libraries = () if settings.library is None else requested_libraries(settings.library)
        digests = [library_digest(library) for library in libraries]
        maps = () if character is None else map_digests(character.map, library_folders())
        digest = conversion_record.conversion_digest(description, settings, digests, output, version(), maps)
        if not again and conversion_record.is_up_to_date(output, digest):
            raise UpToDate
        if settings.library is not None:
            results.refuse_own_folder(description, output)
        if character is not None:
            console.stage("Opening the character")
            with opened_character(character.character_file, character.map, debug):
                pass  # what is wrong with it is better known before the work
        real_output = real_path(output)

        def retarget(session: Session) -> Job[RetargetRecord]:
            from ...bridge.result_files import show_take

            assert character is not None
            return write_character_result(
                character,
                session[Reconstruction].motion,
                session.inputs.take.name,
                lambda scene, shown: show_take(scene, _filmed(session), shown),
                (staging_folder, real_output),
                debug,
                formats,
                picture=settings.pictures is not False,
            )

        bridge = {} if character is None else {"retarget": retarget}

        def read_armature(file: Path, subject: str | None) -> ReferenceMotion:
            from ...bridge.motions.import_motion import armature_reference

            with blender_silence(debug):
                return armature_reference(file, subject, library_folders())

        way = convert(description, settings, libraries, read_armature, bridge, keep)
        session = run(way, console.progress)
        take, result = session[Posed].seen.take, session[Reconstruction]
        console.stage("Writing the motion")
        results.write_motion_files(staging_folder, session)
        if session.inputs.open_lens is not None:
            results.write_take_files(staging_folder, session, description, settings.evidence)
        console.stage("Writing Blender's files")
        filmed = _filmed(session)
        beside = staging_folder / filmed.clip.name
        if beside.is_file() and staging_folder.parent == real_output.parent:
            filmed = replace(filmed, clip=beside)  # so that the folder may be moved
        curves = {BLEND: write_blender_files(filmed, result.motion, staging_folder, real_output, debug)}
        if character is not None:
            record = session[RetargetRecord]
            curves[CHARACTER_BLEND] = record.files[CHARACTER_BLEND]
            notes = (*notes, *record.doubts, *record.notes)
        results.write_made_digests(staging_folder, curves)
        if settings.pictures is not False:
            console.stage("Drawing the pictures")
            seen, contours = compare_keypoints(result), performer_contours(result)
            report = staging_folder / REPORT
            write_pictures(report, take, result.motion, result.reading.tracks, seen, contours, result.reading)
        source, folders = (description, settings, digest), (staging_folder, output)
        return results.finish_result(session, notes, source, version(), folders, curves, kept_names)


def _filmed(session: Session) -> Take:
    """The take as it was filmed: its camera turns where it was seen to."""
    seen = session[Posed].seen
    return replace(seen.take, camera=followed_camera(seen.take, seen.reading))


def conversion_summary(conversion: Conversion) -> dict[str, Any]:
    """The result of a conversion as an object for `--json`."""
    motion, found, first = conversion.reconstruction.motion, conversion.found, conversion.take.frame_start
    summary: dict[str, Any] = {
        "files": [str(file) for file in conversion.files],
        "method": motion.method,
        "frames": len(motion.time_s),
        "frame_start": motion.frame_start,
        "fps": motion.fps,
        "keyframes": [index + motion.frame_start for index in motion.keyframe_indices],
        "notes": list(conversion.notes),
        "warnings": list(conversion.warnings),
    }
    if found is None:
        return summary
    return summary | {
        "library": found.library,
        "fit": round(float(found.fit), 4),
        "reason": found.reason,
        "floor_m": found.floor_m,
        "matches": [
            {
                "frame": key.index + first,
                "posture": key.matched.posture,
                "mirrored": key.matched.mirrored,
                "confidence": round(float(key.matched.confidence), 4),
                "doubtful": key.matched.is_doubtful,
            }
            for key in conversion.take.keyframes
            if key.matched is not None
        ],
        "contradictions": [
            {"frame": index + first, "evidence": list(names)}
            for index, names in sorted(found.contradictions.items())
        ],
    }


def conversion_text(conversion: Conversion) -> str:
    """The result of a conversion in words."""
    motion = conversion.reconstruction.motion
    notes = [f"Note: {note}." for note in conversion.notes]
    count = pluralize(len(motion.keyframe_indices), "keyframe")
    if conversion.found is not None:
        posed = sum(keyframe.matched is None for keyframe in conversion.take.keyframes)
        count = f"{posed} posed and {len(motion.keyframe_indices) - posed} found keyframes"
    lines = [f"{len(motion.time_s)} frames from {count} ({motion.method}):"]
    return "\n".join([*notes, *lines, *(f"  {file}" for file in conversion.files)])
