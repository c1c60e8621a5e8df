"""`keymark character`: recognize a character's bones and controls, or check its map."""

import argparse

from ....core.retarget.character import FINGER_ROLES, ROLES
from ....core.retarget.maps.character_map import CharacterMap, write_character_map
from ....core.retarget.retarget_record import GIVEN, SAVED
from ....core.take.conversion_settings import CharacterFile
from ..console import Console, argument, command, refuse_existing, require_blender, terminal_columns, wrapped
from ..conversion.character_result import opened_character
from ..options import CHARACTER_HELP, MAP, REPLACE_HELP, output

UNSURE = 0.75
"""Confidence below which a role is marked."""
SOURCE_WORDS = {"preset": "convention", "names": "names", "shape": "shape", "you": "a person"}


@command(
    argument("character FILE[:OBJECT]", CHARACTER_HELP),
    MAP,
    *output("FILE", "write its character map there", required=False, replace=REPLACE_HELP),
)
def character_command(arguments: argparse.Namespace, console: Console) -> None:
    """Opens a character, recognizes which bones play which role, and says how surely and what it doubts.

    With --map it checks that the map is for this character; with --output it writes the map, to be
    corrected, kept and shared. Nothing else is written. Needs Blender.
    """
    require_blender("opening a character needs")
    file = CharacterFile.parse(arguments.character)
    if arguments.output is not None:
        refuse_existing(arguments.output, arguments.replace)
    console.stage("Opening the character")
    with opened_character(file, arguments.map, arguments.debug) as (_, opened):
        name, chosen = opened.character.name, opened.chosen
        console.stage("Finding how the controls act")
        character_map, found = opened.completed(arguments.debug)
        notes = (*opened.imported.notes, *found)
    result = {
        "file": str(file.path),
        "object": name,
        "origin": chosen.origin,
        "map_file": None if chosen.path is None else str(chosen.path),
        "map": character_map.to_json(),
        "doubts": list(chosen.doubts),
        "notes": list(notes),
        "files": [],
    }
    title, preset = chosen.character_map.title, chosen.character_map.preset
    heading = {
        GIVEN: f" has all bones of the map {title}",
        SAVED: f", by the saved map {title} ({chosen.path})",
    }.get(chosen.origin, f", recognized{f' as {preset}' if preset else ''}")
    lines = [f"{file.path}: '{name}'{heading}:", *map_lines(character_map)]
    columns = terminal_columns()
    for title, sentences in (("Doubtful:", chosen.doubts), ("Notes:", notes)):
        if sentences:
            lines.append(title)
            lines += [line for each in sentences for line in wrapped(f"{each.rstrip('.')}.", 2, columns)]
    if arguments.output is not None:
        write_character_map(arguments.output, character_map)
        result["files"] = [str(arguments.output)]
        lines.append(f"Written: {arguments.output}")
    console.finish(result, "\n".join(lines))


def map_lines(character_map: CharacterMap) -> list[str]:
    """A map's roles and controls as lines for people; roles that are not sure have a mark."""
    roles = [role for role in ROLES if role in character_map.roles]
    lines = []
    for role in roles:
        bones = character_map.roles[role]
        mark = "?" if bones.confidence < UNSURE else " "
        keyed = [bone for bone in character_map.keyed_bones(role) if bone is not None]
        by = f" (keyed: {', '.join(keyed)})" if keyed != list(bones.bones) else ""
        source = SOURCE_WORDS[bones.source]
        lines.append(f"{mark} {role:<12} {bones.confidence:4.0%}  {source:<10}  {', '.join(bones.bones)}{by}")
    for limb, controls in character_map.ik.items():
        parts = [controls.goal]
        parts += [f"pole {controls.pole}"] if controls.pole else []
        parts += [f"toes {controls.toe}"] if controls.toe else []
        if (switch := controls.switch) is not None:
            parts.append(f"switch {switch.property} of {switch.bone}")
        lines.append(f"  IK of {limb:<6} {', '.join(parts)}")
    missing = [role for role in ROLES if role not in (*character_map.roles, *FINGER_ROLES)]
    if missing:
        lines.append(f"  without: {', '.join(missing)}")
    if character_map.root is not None:
        lines.append(f"  root bone: {character_map.root}")
    if character_map.left_alone:
        lines.append(f"  left alone: {', '.join(character_map.left_alone)}")
    return lines
