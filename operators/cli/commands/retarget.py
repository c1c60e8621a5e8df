"""`keymark retarget`: put a motion onto a character."""

import argparse
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from ....core.errors import InputError
from ....core.files.output_folder import output_folder
from ....core.files.paths import absolute_path, real_path
from ....core.progress import run
from ....core.retarget.retarget_record import RECORD_FILE, read_retarget_record
from ....core.session.result import AS_MADE, changed_files, kept_note, write_made_digests
from ....core.take.conversion_record import BLEND, CHARACTER_BLEND, CHARACTER_PICTURE, MOTION
from ....core.take.conversion_record import RECORD_FILE as CONVERSION
from ....core.take.motion import read_motion
from ..console import Console, argument, command, require_blender
from ..conversion import character_result
from ..conversion.blender_files import refuse_unsupported_output
from ..conversion.character_result import EXPORTS, FORMAT
from ..options import character_options, character_settings, output

RESULT_FILES = (RECORD_FILE, CHARACTER_BLEND, CHARACTER_PICTURE, *(file for _, file in EXPORTS.values()))
FIGURES = {
    "arms_deg": "arms are {:.1f} degrees from the performer's on average",
    "legs_deg": "legs are {:.1f} degrees from the performer's on average",
    "skate_mm": "resting feet slide {:.2f} mm a frame",
    "penetration_mm": "soles are at most {:.1f} mm below the floor",
    "lifted_mm": "resting feet are {:.1f} mm above the floor on average",
    "hands_mm": "hands are {:.0f} mm from what they reach on average",
    "ik_fk_mm": "FK and IK are at most {:.1f} mm apart",
}


@command(
    argument("motion OUT|motion.json", "folder of a result, as convert writes it, or its motion", type=Path),
    *output("DIR", "folder for the result, new or old"),
    FORMAT,
    *character_options(required=True),
)
def retarget_command(arguments: argparse.Namespace, console: Console) -> None:
    """Puts the motion of a finished conversion onto a character.

    DIR then holds character.blend, the character with the motion as its Action in front of the camera
    that filmed it, and retarget.json, which says what was recognized, how surely, and how good the result
    is. DIR changes only once all files are complete. Needs Blender.
    """
    require_blender("a character needs")
    settings = character_settings(arguments)
    assert settings is not None, "the option is required"
    formats = character_result.export_formats(arguments.format)
    path: Path = arguments.motion
    motion_file, blend = (path / MOTION, path / BLEND) if path.is_dir() else (path, None)
    if path.is_dir() and not motion_file.exists():
        raise InputError(
            f"{path}: holds no {MOTION}; it must be a folder that convert has written, or a motion's file"
        )
    output: Path = arguments.output
    refuse_unsupported_output(output)
    if (output / CONVERSION).exists():
        raise InputError(f"{output}: holds the result of a conversion; name another folder for the character")
    from ...bridge.character.retarget import show_result

    console.stage("Reading the motion")
    motion = read_motion(motion_file)
    character_result.check_exporters(formats)
    lost: list[str] = []
    footage = blend if blend is not None and blend.is_file() else None
    kept: dict[str, str] = {}
    with output_folder(output, (*RESULT_FILES, AS_MADE), RECORD_FILE, kept) as staging_folder:
        job = character_result.write_character_result(
            settings,
            motion,
            absolute_path(motion_file).parent.name,
            lambda scene, shown: show_result(scene, footage, shown, lost),
            (staging_folder, real_path(output)),
            arguments.debug,
            formats,
        )
        record = run(job, console.progress)
        made = [name for name in RESULT_FILES[1:] if (staging_folder / name).exists()]
        write_made_digests(staging_folder, made)
        before: Mapping[str, str] = {}
        with suppress(InputError):
            before = read_retarget_record(output).files
        kept.update(changed_files(output, staging_folder, RESULT_FILES, (CHARACTER_BLEND,), before))
    files = [str(output / name) for name in (*made, RECORD_FILE)]
    notes = (*lost, *record.notes, *(kept_note(*names) for names in kept.items()))
    lines = [f"Doubtful: {doubt.rstrip('.')}." for doubt in record.doubts]
    lines += [f"Note: {note.rstrip('.')}." for note in notes]
    character = f"'{record.character.object}' of {record.character.file}"
    lines.append(f"{record.frames} frames on {character} ({record.map.title}, {record.map.origin}):")
    figures = {name: record.quality.get(name) for name in FIGURES}
    lines += [f"  {FIGURES[name].format(value)}" for name, value in figures.items() if value is not None]
    result = {**record.to_json(), "notes": list(notes), "files": files}
    console.finish(result, "\n".join([*lines, *(f"  {file}" for file in files)]))
    console.warn(record.warnings)
