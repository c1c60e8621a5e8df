"""`keymark mend`: mend a motion from elsewhere, without footage."""

import argparse
from dataclasses import replace
from pathlib import Path

from ....core.errors import InputError
from ....core.files.kinds import Number
from ....core.files.output_folder import output_folder
from ....core.files.paths import absolute_path, real_path
from ....core.mend.mend_motion import Mended, MendOptions, mend_motion, named_frames
from ....core.progress import run
from ....core.retarget.retarget_record import RECORD_FILE as RETARGET
from ....core.session.result import AS_MADE, changed_files, kept_note, write_made_digests
from ....core.take.conversion_record import BVH, CHARACTER_BLEND, CHARACTER_PICTURE, MOTION
from ....core.take.conversion_record import RECORD_FILE as CONVERSION
from ....core.take.conversion_settings import CharacterFile
from ....core.take.motion import write_motion
from ....core.take.reference import ARMATURE_ENDINGS, REFERENCE_ENDINGS, read_reference
from ..blender_silence import blender_silence
from ..console import Console, UsageError, argument, command, require_blender
from ..conversion import character_result
from ..conversion.blender_files import library_folders, refuse_unsupported_output
from ..conversion.character_result import EXPORTS, FORMAT
from ..options import character_options, character_settings, checked, output

FILES = (MOTION, BVH, CHARACTER_BLEND, RETARGET, CHARACTER_PICTURE, *(file for _, file in EXPORTS.values()))
USUAL_RATE = 30.0


@command(
    argument(
        "motion FILE[:OBJECT]",
        "an animated armature (.bvh, .fbx, .glb, .vrm, .usd, .blend), and after a colon its name "
        "where there are several; or points by name (.csv, .npy, .trc, .c3d), or a motion.json",
    ),
    *output("DIR", "folder for the result, new or old"),
    argument(
        "--subject NAME",
        "whose motion of several in the file: the prefix of points, a BVH's ROOT, or an armature "
        "(default: the most complete, which a note names)",
    ),
    argument(
        "--action NAME",
        "the Action of an armature that has several, as glTF, FBX and .blend files may "
        "(default: its own or the first, which a note names)",
    ),
    argument(
        "--posed FRAMES",
        "frames that you have posed, with commas between them; those with keys of their own are "
        "found. They stay, and the motion beside them follows",
        type=lambda text: named_frames(text, "--posed"),
        default=(),
    ),
    argument(
        "--fps RATE",
        "frames a second of points whose file does not tell (default: 30)",
        type=checked(Number(1.0, 1000.0, "frames a second"), "--fps"),
    ),
    argument("--no-floor", "leave the motion at its height"),
    FORMAT,
    *character_options(),
)
def mend_command(arguments: argparse.Namespace, console: Console) -> None:
    """Mends a motion that another program made: its jitter, exchanged sides, sliding feet and floor.

    No footage is needed. DIR then holds motion.json and motion.bvh, and character.blend: the armature of the
    file itself with its fingers, face and toes as they were, or the character that --character names. DIR
    changes only once all files are complete. Needs Blender.
    """
    require_blender("mending a motion needs")
    settings = character_settings(arguments)
    formats = character_result.export_formats(arguments.format)
    posed: tuple[int, ...] = arguments.posed
    file = CharacterFile.parse(arguments.motion, (*ARMATURE_ENDINGS, *REFERENCE_ENDINGS), "is no motion")
    file = replace(file, object=arguments.subject or file.object)
    folder: Path = arguments.output
    refuse_unsupported_output(folder)
    if (folder / CONVERSION).exists():
        raise InputError(f"{folder}: holds the result of a conversion; name another folder for the motion")
    kept: dict[str, str] = {}
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    with output_folder(folder, (*FILES, AS_MADE), MOTION, kept) as staging:
        if file.path.suffix.lower() in REFERENCE_ENDINGS:
            mended, notes = _mend_points(file, posed, arguments, console)
        else:
            own = None if settings is not None else (staging, real_path(folder), formats)
            mended, notes = _mend_armature(file, posed, arguments, console, own)
        motion = mended.motion
        console.stage("Writing the motion")
        write_motion(motion, staging / MOTION)
        with blender_silence(arguments.debug):
            from ...bridge.character.retarget import show_result
            from ...bridge.motions.mend_action import write_actor_bvh

            write_actor_bvh(motion, staging / BVH)
        if settings is not None:
            job = character_result.write_character_result(
                settings,
                motion,
                absolute_path(file.path).stem,
                lambda scene, shown: show_result(scene, None, shown),
                (staging, real_path(folder)),
                arguments.debug,
                formats,
                picture=False,
            )
            record = run(job, console.progress)
            notes, warnings = (*notes, *record.doubts, *record.notes), record.warnings
        made = [name for name in FILES if (staging / name).exists()]
        write_made_digests(staging, made)
        before = {MOTION: ""} if (folder / AS_MADE).exists() else {}
        kept.update(changed_files(folder, staging, FILES, (MOTION, BVH, CHARACTER_BLEND), before))
    notes = (*mended.notes, *notes, *(kept_note(*names) for names in kept.items()))
    files = [str(folder / name) for name in made]
    summary = {
        "frames": len(motion.time_s),
        "frame_start": motion.frame_start,
        "fps": motion.fps,
        "posed": [index + motion.frame_start for index in motion.keyframe_indices],
        "exchanged": int(mended.exchanged.sum()),
        "rests": len(mended.contacts),
        "notes": list(notes),
        "warnings": list(warnings),
        "files": files,
    }
    lines = [f"Note: {note.rstrip('.')}." for note in notes]
    lines.append(
        f"{len(motion.time_s)} frames at {motion.fps:g} a second, {len(mended.contacts)} rests of feet:"
    )
    console.finish(summary, "\n".join([*lines, *(f"  {name}" for name in files)]))
    console.warn(warnings)


def _mend_points(
    file: CharacterFile, posed: tuple[int, ...], arguments: argparse.Namespace, console: Console
) -> tuple[Mended, tuple[str, ...]]:
    console.stage("Reading the motion")
    if arguments.action is not None:
        raise UsageError(f"--action is {arguments.action}; {file.path} holds points, which have no Actions")
    reference = read_reference(file.path, file.object)
    rate = arguments.fps or reference.fps or USUAL_RATE
    options = MendOptions(
        tuple(frame - 1 for frame in posed), arguments.plant_feet is not False, not arguments.no_floor
    )
    try:
        return run(mend_motion(reference.points_m, rate, options), console.progress), reference.notes
    except InputError as error:
        raise InputError(f"{file.path}: {error}") from error


def _mend_armature(
    file: CharacterFile,
    posed: tuple[int, ...],
    arguments: argparse.Namespace,
    console: Console,
    own: tuple[Path, Path, tuple[str, ...]] | None,
) -> tuple[Mended, tuple[str, ...]]:
    """Mend an armature's motion; where `own` says so, it is written on the same armature."""
    debug: bool = arguments.debug
    console.stage("Reading the motion")
    with blender_silence(debug):
        from ...bridge.blend_files import own_scene, showing_scene
        from ...bridge.motions.import_motion import import_motion
        from ...bridge.motions.mend_action import mend_action, write_mended
    character_result.check_exporters(own[2] if own is not None else ())
    with own_scene("Motion") as scene, showing_scene(scene):
        with blender_silence(debug):
            imported, chosen = import_motion(file, scene, library_folders(), arguments.action)
        plant, floor = arguments.plant_feet is not False, not arguments.no_floor
        job = mend_action(imported.armature, chosen.character_map, posed, plant, floor)
        try:
            found = run(character_result.silenced(job, debug), console.progress)
        except InputError as error:
            raise InputError(f"{file.path}: {error}") from error
        if own is not None:
            with blender_silence(debug):
                action = write_mended(imported.armature, found)
                character_result.write_character(scene, imported, action, own[:2], own[2])
    return found.mended, (*imported.notes, *chosen.doubts)
