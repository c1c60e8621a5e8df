"""Names of takes, checked so that the results of each take get a folder of their own."""

import os
import unicodedata
from collections.abc import Sequence
from pathlib import Path, PurePath, PurePosixPath

from ...errors import InputError
from ...files.json_file import shown
from ..shoot import Shoot, ShootTake

RESERVED = (".keymark", "summary.html", "summary.jsonl")
"""Files and folders that a batch itself writes into the folder of the results."""


def take_name(path: PurePath) -> str:
    """The name of a take from its path relative to the shoot: with slashes, and always valid text."""
    return path.as_posix().encode("utf-8", "backslashreplace").decode("utf-8")


def check_names(shoot: Path, takes: Sequence[ShootTake]) -> None:
    """Refuse takes whose results would lie in one folder on some file system, or one below another.

    Raises:
        InputError: Two takes collide, or one has a reserved name.
    """
    known: dict[str, ShootTake] = {}
    for take in takes:
        if PurePosixPath(take.name).parts[:1] and _folded(PurePosixPath(take.name).parts[0]) in RESERVED:
            raise InputError(
                f"{take.path}: its results would lie where a batch keeps its own {take.name.split('/')[0]}; "
                "rename it"
            )
        twin = known.setdefault(_folded(take.name), take)
        if twin is not take:
            raise InputError(
                f"{shoot}: the takes {shown(str(twin.path))} and {shown(str(take.path))} have one name, "
                f"{shown(take.name)}, and their results would lie in one folder; rename one of them"
            )
    for take in takes:
        for parent in PurePosixPath(_folded(take.name)).parents:
            above = known.get(str(parent))
            if above is not None and above is not take:
                raise InputError(
                    f"{shoot}: the results of {shown(str(take.path))} would lie among those of "
                    f"{shown(str(above.path))}; rename one of them"
                )


def check_output(shoot: Shoot, output: Path) -> None:
    """Refuse an output folder in which results would lie among the takes.

    Raises:
        InputError: The folder is the shoot's own, or results would lie in a folder that holds takes.
    """
    target = Path(os.path.realpath(output))
    if target.exists() and not target.is_dir():
        raise InputError(f"{output}: is a file; the output must be a folder, new or old")
    if target == Path(os.path.realpath(shoot.folder)):
        raise InputError(f"{output}: is the shoot's own folder; name another one, which may lie in it")
    paths = [Path(os.path.realpath(take.path)) for take in shoot.takes]
    taken = {folder for path in paths for folder in (path, *path.parents)}
    for take in shoot.takes:
        if target / take.name in taken:
            raise InputError(
                f"{output}: the results of {shown(take.name)} would lie in {target / take.name}, which holds "
                "takes; name another folder"
            )


def _folded(name: str) -> str:
    """A name as the least discerning file system compares it: Windows drops dots and spaces at ends."""
    parts = [part.rstrip(". ") or part for part in name.split("/")]
    return unicodedata.normalize("NFC", "/".join(parts)).casefold()
