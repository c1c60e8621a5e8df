"""A motion on a character as files in a staging folder: character.blend, retarget.json and exports."""

import importlib.util
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from ....core.body.fingers import finger_flexions, finger_turns
from ....core.body.kinematics import SegmentMotion, segment_motion
from ....core.errors import ConversionError, InputError, KeymarkError, describe_unexpected
from ....core.feet.natural_extremities import natural_extremities
from ....core.files.digest import content_digest
from ....core.files.fields import listed
from ....core.files.json_file import write_readable_json
from ....core.files.paths import regular_file_size
from ....core.progress import Job, Progress
from ....core.report.canvas import write_png
from ....core.retarget.character import LIMBS, Character
from ....core.retarget.maps.character_map import CharacterMap
from ....core.retarget.maps.map_registry import ChosenMap, choose_map, map_digests
from ....core.retarget.quality import warnings_of
from ....core.retarget.retarget_record import RECORD_FILE, RetargetRecord, UsedCharacter, UsedMap
from ....core.shoot.discovery import Shoot
from ....core.take.conversion_record import CHARACTER_BLEND, CHARACTER_PICTURE
from ....core.take.conversion_settings import CharacterFile, CharacterSettings
from ....core.take.motion import Motion
from ....core.take.presence import named_limbs
from ..blender_silence import blender_silence
from ..console import UsageError, argument, version
from .blender_files import hidden_files, library_folders

if TYPE_CHECKING:
    import bpy

    from ....core.arrays import Array
    from ...bridge.character.import_character import ImportedCharacter
    from ...bridge.character.retarget import Retargeted


EXPORTS = {"bvh": ("BVH", "character.bvh"), "fbx": ("FBX", "character.fbx")}
EXPORTS |= {"glb": ("GLTF", "character.glb"), "usd": ("USD", "character.usdc")}
EXPORTS |= {"trc": ("TRC", "character.trc"), "c3d": ("C3D", "character.c3d")}
"""By the word for it: the format of `bridge/export_formats`, and the file."""
FORMAT = argument(
    f"--format {','.join(EXPORTS)}",
    "further files of the character with its motion, separated by commas",
    default="",
)
Result = TypeVar("Result")
ShowFootage = Callable[["bpy.types.Scene", Motion], "Array"]
"""Puts camera, clip, rate and range into a scene and returns the motion's scene frames (F,)."""


def export_formats(text: str) -> tuple[str, ...]:
    """The words of `EXPORTS` in a text, separated by commas."""
    words = [word.strip().lower() for word in text.split(",") if word.strip()]
    unknown = [word for word in words if word not in EXPORTS]
    if unknown:
        raise UsageError(f"--format is {text}; {listed(EXPORTS)} are valid, with commas between them")
    return tuple(dict.fromkeys(words))


def check_exporters(formats: tuple[str, ...]) -> None:
    """Refuse, before the work, formats that this Blender cannot write."""
    from ...bridge.export_formats import FORMATS

    for word in formats:
        why = FORMATS[EXPORTS[word][0]].missing()
        if why:
            raise ConversionError(f"--format {word} cannot be written: {why[:1].lower()}{why[1:]}")


@dataclass(frozen=True, eq=False)
class OpenedCharacter:
    """A character in a scene of its own, with its map."""

    imported: "ImportedCharacter"
    character: Character
    chosen: ChosenMap

    def completed(self, debug: bool) -> tuple[CharacterMap, tuple[str, ...]]:
        """The map with the controls and soles that only Blender finds, and notes on them."""
        with blender_silence(debug):
            from ...bridge.character.retarget import complete_map

            return complete_map(self.imported.armature, self.character, self.chosen.character_map)


@contextmanager
def opened_character(
    file: CharacterFile, wanted_map: str, debug: bool
) -> Iterator[tuple["bpy.types.Scene", OpenedCharacter]]:
    """Open a character and choose its map, in a scene that is removed again with all that is in it."""
    with blender_silence(debug):
        from ...bridge.blend_files import own_scene, showing_scene
        from ...bridge.character.import_character import import_character
        from ...bridge.character.read_character import read_character

    with own_scene("Character") as scene, showing_scene(scene):
        with blender_silence(debug):
            imported = import_character(file, scene)
            try:
                character = read_character(imported.armature)
            except InputError as error:
                raise InputError(f"{file.path}: {error}") from error
        try:
            chosen = choose_map(character, wanted_map, library_folders())
        except InputError as error:
            named = str(error).startswith(wanted_map) or str(file.path) in str(error)
            raise InputError(str(error) if named else f"{file.path}: {error}") from error
        yield scene, OpenedCharacter(imported, character, chosen)


def write_character_result(
    settings: CharacterSettings,
    motion: Motion,
    take: str,
    show_footage: ShowFootage,
    folders: tuple[Path, Path],
    debug: bool,
    formats: tuple[str, ...] = (),
    picture: bool = True,
) -> Job[RetargetRecord]:
    """Put a motion onto a character and write the files of a take's name.

    `folders` are the staging folder and that of the result, as a real path; `formats` are words of `EXPORTS`.
    The character is drawn if `picture` is wanted and `show_footage`, which shows what was filmed, shows some.
    """
    staging_folder, _ = folders
    yield Progress("Opening the character", 0.0)
    with opened_character(settings.character_file, settings.map, debug) as (scene, opened):
        from ...bridge.character.retarget import retarget

        with blender_silence(debug):
            frames = show_footage(scene, motion)[motion.there]
        character_map, options = opened.chosen.character_map, settings.options
        note: tuple[str, ...] = ()
        if motion.unseen:  # limbs that the footage never shows are left alone, and their figures unmeasured
            roles = [role for limb in motion.unseen for role in LIMBS[limb] if role in character_map.roles]
            alone = tuple(dict.fromkeys((*character_map.left_alone, *roles)))
            character_map = replace(character_map, left_alone=alone)
            seen = "never seen in the footage, so that the character keeps its own"
            note = (f"{named_limbs(motion.unseen)} {seen}",)
        armature = opened.imported.armature
        job = retarget(armature, motion_segments(motion), frames, character_map, options)
        try:
            retargeted = yield from silenced(job, debug)
        except InputError as error:
            raise InputError(f"{settings.file}: {error}") from error
        yield Progress("Writing the character", 1.0)
        with blender_silence(debug):
            action = retargeted.write(scene, f"{take} {armature.name}")
            curves = write_character(scene, opened.imported, action, folders, formats)
            action_name, rate = action.name, scene.render.fps / scene.render.fps_base
        if picture:
            _draw(scene, armature, retargeted, staging_folder / CHARACTER_PICTURE)
        unmeasured = {f"{limb.partition('.')[0]}s_deg": None for limb in motion.unseen}
        quality = {**retargeted.quality.to_dict(), **unmeasured}
        record = RetargetRecord(
            keymark=version(),
            take=take,
            character=UsedCharacter(settings.file.name, opened.character.name, content_digest(settings.file)),
            map=UsedMap(character_map.title, opened.chosen.origin, character_map.preset),
            action=action_name,
            frames=len(frames),
            frame_start=motion.frame_start,
            fps=rate,
            size=retargeted.size,
            options=options,
            roles=character_map.roles,
            limbs=keyed_limbs(retargeted.character_map, settings),
            quality=quality,
            warnings=warnings_of(quality, retargeted.size),
            doubts=opened.chosen.doubts,
            notes=(*opened.imported.notes, *note, *retargeted.notes),
            files={CHARACTER_BLEND: curves},
        )
        write_readable_json(staging_folder / RECORD_FILE, record.to_json())
        return record


def write_character(
    scene: "bpy.types.Scene",
    imported: "ImportedCharacter",
    action: "bpy.types.Action",
    folders: tuple[Path, Path],
    formats: tuple[str, ...],
) -> str:
    """Write character.blend and the files of further formats; returns the digest of the Action's curves."""
    from ...bridge.actions import curve_digest
    from ...bridge.blend_files import write_blend
    from ...bridge.export_formats import FORMATS, export_motion

    exports, armature = dict(EXPORTS[word] for word in formats), imported.armature
    frames = scene.frame_start, scene.frame_end
    with hidden_files((CHARACTER_BLEND, *exports.values()), *folders) as hidden:
        scene.frame_set(scene.frame_start)
        blocks = {scene, *imported.texts}
        write_blend(hidden[CHARACTER_BLEND], blocks, path_remap="RELATIVE_ALL", fake_user=False)
        for kind, file in exports.items():
            export_motion(scene, armature, action, frames, FORMATS[kind], hidden[file], imported.objects)
        return curve_digest(armature)


def _draw(scene: "bpy.types.Scene", armature: "bpy.types.Object", done: "Retargeted", file: Path) -> None:
    from ...bridge.character.figure import character_picture

    motion = done.motion
    ground_m = [float(np.median(heights)) for heights in motion.ground_m.values()]  # none of feet not planted
    floor_m = float(motion.to_world.location[2]) + min(ground_m, default=0.0)
    image = character_picture(scene, armature, done.character_map, done.keys.frames, floor_m)
    if image is not None:
        file.parent.mkdir(exist_ok=True)
        write_png(str(file), image)


def motion_segments(motion: Motion) -> SegmentMotion:
    """The segments of a motion, with natural feet and hands, in frames in which the performer is there."""
    motion = motion.without_absence()
    extremities = natural_extremities(motion.body, motion.posture, motion.time_s, hands=motion.hands)
    segments = segment_motion(motion.body, motion.posture, motion.time_s, extremities)
    turns = {} if motion.hands is None else finger_turns(motion.hands)
    return replace(segments, fingers=finger_flexions(turns))


def keyed_limbs(character_map: CharacterMap, settings: CharacterSettings) -> Mapping[str, str]:
    """Which controls of each limb are keyed: FK alone where the character has no others."""
    keyed = {}
    for limb, roles in LIMBS.items():
        if any(role in character_map.roles for role in roles):
            wanted = settings.arms if limb.startswith("arm") else settings.legs
            keyed[limb] = wanted if limb in character_map.ik else "fk"
    return keyed


def silenced(job: Job[Result], debug: bool) -> Job[Result]:
    """A job whose steps let no message of Blender through, while its progress is shown."""
    while True:
        with blender_silence(debug):
            try:
                progress = next(job)
            except StopIteration as stop:
                result: Result = stop.value
                return result
        yield progress


Wanted = tuple[CharacterFile, str]


class CharacterChecks:
    """What is wrong with characters, and what is doubtful about them."""

    def __init__(self, shoot: Shoot, debug: bool) -> None:
        self._findings: dict[Wanted, tuple[KeymarkError | None, Sequence[str]]] = {}
        for take in shoot.takes:
            settings = None
            with suppress(KeymarkError):  # its own check says so
                settings = take.describe().settings.character
            if settings is None or (settings.character_file, settings.map) in self._findings:
                continue
            error: KeymarkError | None = None
            doubts: Sequence[str] = ()
            try:
                doubts = _doubts(settings, debug)
            except KeymarkError as wrong:
                error = wrong
            except Exception as unexpected:
                if debug:
                    raise
                what = describe_unexpected(unexpected)
                error = InputError(
                    f"{settings.file}: the check failed unexpectedly ({what}); --debug shows where"
                )
            self._findings[settings.character_file, settings.map] = error, doubts

    def check(self, settings: CharacterSettings) -> Sequence[str]:
        """What is doubtful about a character."""
        error, doubts = self._findings[settings.character_file, settings.map]
        if error is not None:
            raise error
        return doubts


def _doubts(settings: CharacterSettings, debug: bool) -> Sequence[str]:
    file = settings.file
    if importlib.util.find_spec("bpy") is None:
        regular_file_size(file, "a character file")
        map_digests(settings.map, library_folders())
        return (f"{file}: the character is not looked at, which needs Blender",)
    with opened_character(settings.character_file, settings.map, debug) as (_, opened):
        doubts = (*opened.imported.notes, *opened.chosen.doubts)
    return tuple(doubt if str(file) in doubt else f"{file}: {doubt}" for doubt in doubts)
