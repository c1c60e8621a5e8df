"""Names of takes, and what they must be so that each take's results have a folder of their own."""

import os
import unicodedata
from collections.abc import Sequence
from pathlib import Path, PurePath, PurePosixPath

from ...errors import InputError
from ...files.json_file import shown
from ..shoot import Shoot, ShootTake

RESERVED = (".keymark", "summary.html", "summary.jsonl")
"""What a batch itself writes into its folder."""


def name_of_way(way: PurePath) -> str:
    """The name of a take whose way from the shoot's folder is given: with slashes, and always valid text."""
    return way.as_posix().encode("utf-8", "backslashreplace").decode("utf-8")


def check_names(shoot: Path, takes: Sequence[ShootTake]) -> None:
    """Refuse takes whose results would lie in one folder, on any file system, or one below another.

    Raises:
        InputError: The sentence names the two takes, or the one.
    """
    known: dict[str, ShootTake] = {}
    for take in takes:
        if PurePosixPath(take.name).parts[:1] and _folded(PurePosixPath(take.name).parts[0]) in RESERVED:
            raise InputError(
                f"{take.place}: its results would lie where a batch keeps its own {take.name.split('/')[0]}; "
                "rename it"
            )
        twin = known.setdefault(_folded(take.name), take)
        if twin is not take:
            raise InputError(
                f"{shoot}: the takes {shown(str(twin.place))} and {shown(str(take.place))} have one name, "
                f"{shown(take.name)}, and their results would lie in one folder; rename one of them"
            )
    for take in takes:
        for parent in PurePosixPath(_folded(take.name)).parents:
            above = known.get(str(parent))
            if above is not None and above is not take:
                raise InputError(
                    f"{shoot}: the results of {shown(str(take.place))} would lie among those of "
                    f"{shown(str(above.place))}; rename one of them"
                )


def check_output(shoot: Shoot, output: Path) -> None:
    """Refuse a folder for results where these would lie among what they are made from.

    Raises:
        InputError: The folder is the shoot's own, or results would lie in a folder that holds takes.
    """
    target = Path(os.path.realpath(output))
    if target.exists() and not target.is_dir():
        raise InputError(f"{output}: is a file; the output must be a folder, new or old")
    if target == Path(os.path.realpath(shoot.folder)):
        raise InputError(f"{output}: is the shoot's own folder; name another one, which may lie in it")
    places = [Path(os.path.realpath(take.place)) for take in shoot.takes]
    taken = {folder for place in places for folder in (place, *place.parents)}
    for take in shoot.takes:
        if target / take.name in taken:
            raise InputError(
                f"{output}: the results of {shown(take.name)} would lie in {target / take.name}, which holds "
                "takes; name another folder"
            )


def _folded(name: str) -> str:
    """What a name is to the file system that tells fewest apart: Windows drops dots and spaces at ends."""
    parts = [part.rstrip(". ") or part for part in name.split("/")]
    return unicodedata.normalize("NFC", "/".join(parts)).casefold()
