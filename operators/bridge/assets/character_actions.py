"""Characters' Actions out of results, as they were made."""

from dataclasses import dataclass
from pathlib import Path

import bpy

from ....core.errors import InputError
from ....core.files.paths import real_path
from ....core.take.motion import Motion
from ..actions import action_digest
from ..blend_reader import check_blend
from ..blend_writer import one_line


@dataclass(frozen=True, eq=False)
class CharacterAsset:
    """A character's Action with its details for the asset browser."""

    name: str
    catalog: str
    """Path of its catalog below that of all characters, with slashes."""
    description: str
    tags: tuple[str, ...]
    motion: Motion
    """What it was made of, for the picture."""
    action: bpy.types.Action


def load_character_action(blend: Path, name: str, curves: str) -> bpy.types.Action:
    """Append a character's Action; the character itself stays where it is.

    Args:
        blend: A character.blend.
        name: The Action's name in it.
        curves: Digest of its curves.

    Raises:
        InputError: The file cannot be read, lacks the Action, or holds another one than was made.
    """
    check_blend(blend, "a character")
    try:
        with bpy.data.libraries.load(str(real_path(blend)), link=False) as (inside, wanted):
            wanted.actions = [one for one in inside.actions if one == name]
    except (OSError, RuntimeError, UnicodeDecodeError) as error:
        raise InputError(
            f"{blend}: Blender cannot read it ({one_line(error)}); convert the take again"
        ) from error
    action = next((one for one in wanted.actions if one is not None), None)
    if action is None:
        raise InputError(f"{blend}: lacks its Action; convert the take again")
    if action_digest(action) != curves:
        raise InputError(f"{blend}: is not the file that the conversion wrote; convert the take again")
    return action
