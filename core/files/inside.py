"""Paths that files name, which must stay inside their folder."""

from pathlib import Path, PurePosixPath, PureWindowsPath

from ..errors import InputError
from .fields import Fields
from .json_file import shown

LONGEST = 1000


def inside_path(fields: Fields, name: str, folder: Path, valid: str) -> Path:
    """The path in a field, relative to a folder that it must not leave.

    Args:
        fields: Of the object with the field.
        name: The field's.
        folder: What the path is relative to.
        valid: What it must be, for the sentence.

    Raises:
        InputError: It is no text, absolute, too long, or climbs out of the folder.
    """
    text = fields.text(name, valid)
    outside = PurePosixPath(text).is_absolute() or PureWindowsPath(text).anchor
    climbs = ".." in PureWindowsPath(text).parts  # it reads both kinds of slash
    odd = len(text) > LONGEST or not text.isprintable() or PureWindowsPath(text).name == ""
    if outside or climbs or odd:
        raise InputError(f"{fields.at(name)}: {name} is {shown(text)}; it must be {valid}")
    return folder / text
