"""The results of conversions that lie below a folder, each where its `conversion.json` is."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ...errors import InputError
from ...take.conversion_record import NAME, ConversionRecord, read_record
from ...take.shoot_file import whole_way
from ..discovery.take_names import name_of_way


@dataclass(frozen=True, eq=False)
class Result:
    """The result of one take's conversion."""

    name: str
    """Its way from the folder that was searched, with slashes: the take's name in its shoot."""
    folder: Path
    record: ConversionRecord


@dataclass(frozen=True, eq=False)
class Results:
    """What was found, in the order of the names."""

    sound: tuple[Result, ...]
    damaged: dict[str, str]
    """For each result whose record cannot be used its name, and why, in a sentence."""


def find_results(folder: Path) -> Results:
    """Find every result below a folder; hidden folders and links to folders are passed over.

    Raises:
        InputError: There is no such folder, it cannot be read, or it holds no result.
    """
    if not folder.is_dir():
        raise InputError(f"{folder}: no such folder; it must be a folder of results, as batch writes it")
    sound: list[Result] = []
    damaged: dict[str, str] = {}
    for place, error in _places(folder):
        way = place.relative_to(folder) if place != folder else Path(whole_way(place).name)
        name = name_of_way(way)
        if error is not None:
            sentence = f"{place}: cannot be read ({error.strerror or error})"
            if place == folder:
                raise InputError(sentence) from error
            damaged[name] = sentence
            continue
        try:
            sound.append(Result(name, place, read_record(place)))
        except InputError as unusable:
            damaged[name] = str(unusable)
    if not sound and not damaged:
        raise InputError(
            f"{folder}: holds no result; a result is a folder with {NAME}, as convert and batch write it"
        )
    return Results(tuple(sorted(sound, key=lambda result: result.name)), dict(sorted(damaged.items())))


def _places(folder: Path) -> Iterator[tuple[Path, OSError | None]]:
    """Folders with a record, and those that cannot be looked into."""
    try:
        inside = sorted(folder.iterdir())
    except OSError as error:
        yield folder, error
        return
    if any(file.name == NAME for file in inside):
        yield folder, None
        return
    for path in inside:
        if path.is_dir() and not path.is_symlink() and not path.name.startswith("."):
            yield from _places(path)
