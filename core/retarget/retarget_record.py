"""`retarget.json`: the record of a motion on a character: what was recognized, and how good it came out."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..files.fields import Fields, listed
from ..files.json_file import read_json, shown
from ..files.json_layout import write_readable_json
from ..take.character_settings import CharacterOptions, read_character_options
from ..take.record_fields import checked_sha256, record_files, record_line, record_notes
from .maps.character_map import RoleBones
from .maps.character_map_fields import read_roles
from .maps.character_map_file import roles_to_json
from .roles import LIMBS

RECORD_FILE = "retarget.json"
SCHEMA_VERSION = 1
LARGEST_BYTES = 2**22
MOST_FRAMES, FARTHEST_FRAME = 10**6, 10**7
MOST_FIGURES, LONGEST_FIGURE, LARGEST_FIGURE = 200, 100, 1e12
"""Of the quality: figures, characters of a name, and the value of one."""
LARGEST_SIZE = 1e6
GIVEN, SAVED, RECOGNIZED = "given", "saved", "recognized"
ORIGINS = (GIVEN, SAVED, RECOGNIZED)
"""Where a map comes from: the person named it, it was found by the bones, or it was made of them."""
KEYED = ("fk", "ik", "both")


@dataclass(frozen=True)
class RetargetRecord:
    """The record of a motion on a character; nothing in it depends on time, folder or speed of the run."""

    keymark: str
    """Keymark's version."""
    take: str
    """Name of the take, or of the motion's folder."""
    character_file: str
    """The character's file, without its folder."""
    character_object: str
    """Name of its armature."""
    character_sha256: str
    """Of the file's content."""
    map_title: str
    map_origin: str
    """One of `ORIGINS`."""
    preset: str | None
    """The convention that was recognized; None where there is none."""
    action: str
    """Name of the Action in character.blend."""
    frames: int
    frame_start: int
    fps: float
    size: float
    """The character's size: its legs' length over the performer's."""
    options: CharacterOptions
    roles: Mapping[str, RoleBones]
    """By role, what was recognized and how surely."""
    limbs: Mapping[str, str]
    """By limb, which of its controls are keyed: one of `KEYED`."""
    quality: Mapping[str, float | None] = field(default_factory=dict)
    """Figures by name, units at the names' ends; None where one does not apply."""
    doubts: tuple[str, ...] = ()
    """What was recognized without being sure, one sentence each."""
    notes: tuple[str, ...] = ()
    """What a person should know, one sentence each."""
    files: Mapping[str, str] = field(default_factory=dict)
    """SHA-256 of files of the result; for character.blend that of its Action's curves. Exports are left out:
    Blender writes the time into them."""


def write_retarget_record(folder: Path, record: RetargetRecord) -> None:
    """Write a record into a folder of results, atomically.

    Raises:
        ConversionError: The file cannot be written.
    """
    write_readable_json(folder / RECORD_FILE, record_to_json(record))


def record_to_json(record: RetargetRecord) -> dict[str, Any]:
    """A record as a JSON object."""
    return {
        "schema_version": SCHEMA_VERSION,
        "keymark": record.keymark,
        "take": record.take,
        "character": {
            "file": record.character_file,
            "object": record.character_object,
            "sha256": record.character_sha256,
        },
        "map": {"title": record.map_title, "origin": record.map_origin, "preset": record.preset},
        "action": record.action,
        "frames": record.frames,
        "frame_start": record.frame_start,
        "fps": record.fps,
        "size": round(record.size, 6),
        "options": record.options.to_json(),
        "roles": roles_to_json(record.roles),
        "limbs": dict(record.limbs),
        "quality": {name: _significant(value) for name, value in record.quality.items()},
        "doubts": list(record.doubts),
        "notes": list(record.notes),
        "files": dict(record.files),
    }


def read_retarget_record(folder: Path) -> RetargetRecord:
    """Read a folder's record.

    Raises:
        InputError: There is none, or a field is unusable.
    """
    path = folder / RECORD_FILE
    fields = Fields(read_json(path, LARGEST_BYTES), str(path))
    fields.check_version(SCHEMA_VERSION)
    character = fields.child("character", "an object with file, object and sha256")
    character_map = fields.child("map", "an object with title and origin")
    return RetargetRecord(
        keymark=record_line(fields, "keymark"),
        take=record_line(fields, "take"),
        character_file=record_line(character, "file"),
        character_object=record_line(character, "object"),
        character_sha256=checked_sha256(character.values.get("sha256"), f"{character.where}: sha256"),
        map_title=record_line(character_map, "title"),
        map_origin=_one_of(character_map, "origin", ORIGINS),
        preset=record_line(character_map, "preset") if character_map.has("preset") else None,
        action=record_line(fields, "action"),
        frames=fields.integer("frames", 1, MOST_FRAMES),
        frame_start=fields.integer("frame_start", -FARTHEST_FRAME, FARTHEST_FRAME),
        fps=fields.number("fps", 1e-3, 1e4),
        size=fields.number("size", 0.0, LARGEST_SIZE),
        options=read_character_options(fields.child("options", "an object")),
        roles=read_roles(fields),
        limbs=_limbs(fields),
        quality=_quality(fields),
        doubts=record_notes(fields, "doubts"),
        notes=record_notes(fields),
        files=record_files(fields),
    )


def _one_of(fields: Fields, name: str, choices: tuple[str, ...]) -> str:
    value = fields.text(name, f"one of {listed(choices)}")
    if value not in choices:
        raise InputError(f"{fields.where}: {name} is {shown(value)}; it must be one of {listed(choices)}")
    return value


def _limbs(fields: Fields) -> Mapping[str, str]:
    child = fields.child("limbs", "an object of controls by limb")
    child.refuse_others(tuple(LIMBS))
    return {limb: _one_of(child, limb, KEYED) for limb in LIMBS if limb in child.values}


def _quality(fields: Fields) -> Mapping[str, float | None]:
    child = fields.child("quality", "an object of figures by name")
    if len(child.values) > MOST_FIGURES or any(len(name) > LONGEST_FIGURE for name in child.values):
        raise InputError(
            f"{child.where} has {len(child.values)} figures; at most {MOST_FIGURES} with names of "
            f"{LONGEST_FIGURE} characters are read"
        )
    for name in filter(child.has, child.values):
        child.number(name, -LARGEST_FIGURE, LARGEST_FIGURE)
    return dict(child.values)


def _significant(value: float | None) -> float | None:
    """A figure with five digits; a number of things stays whole."""
    return value if value is None or isinstance(value, int) else float(f"{value:.5g}") + 0.0
