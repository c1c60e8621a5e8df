"""Discovery of conversion results below a folder: folders with a `conversion.json`."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ...errors import InputError
from ...files.paths import absolute_path
from ...take.conversion_record import RECORD_FILE, ConversionRecord, read_record
from ..discovery.take_names import take_name


@dataclass(frozen=True, eq=False)
class Result:
    """The result of one take's conversion."""

    name: str
    """Its path from the folder that was searched, with slashes: the take's name in its shoot."""
    folder: Path
    record: ConversionRecord


@dataclass(frozen=True, eq=False)
class Results:
    """Results below a folder, in the order of their names."""

    sound: tuple[Result, ...]
    damaged: dict[str, str]
    """By name of each result whose record is unusable, the reason in a sentence."""


def find_results(folder: Path) -> Results:
    """Find every result below a folder; hidden folders and links to folders are skipped.

    Raises:
        InputError: There is no such folder, it cannot be read, or it holds no result.
    """
    if not folder.is_dir():
        raise InputError(f"{folder}: no such folder; it must be a folder of results, as batch writes it")
    sound: list[Result] = []
    damaged: dict[str, str] = {}
    for path, error in _result_folders(folder):
        relative = path.relative_to(folder) if path != folder else Path(absolute_path(path).name)
        name = take_name(relative)
        if error is not None:
            sentence = f"{path}: cannot be read ({error.strerror or error})"
            if path == folder:
                raise InputError(sentence) from error
            damaged[name] = sentence
            continue
        try:
            sound.append(Result(name, path, read_record(path)))
        except InputError as unusable:
            damaged[name] = str(unusable)
    if not sound and not damaged:
        raise InputError(
            f"{folder}: holds no result; a result is a folder with {RECORD_FILE}, "
            "as convert and batch write it"
        )
    return Results(tuple(sorted(sound, key=lambda result: result.name)), dict(sorted(damaged.items())))


def _result_folders(folder: Path) -> Iterator[tuple[Path, OSError | None]]:
    """Folders with a record, and those that cannot be read."""
    try:
        inside = sorted(folder.iterdir())
    except OSError as error:
        yield folder, error
        return
    if any(file.name == RECORD_FILE for file in inside):
        yield folder, None
        return
    for path in inside:
        if path.is_dir() and not path.is_symlink() and not path.name.startswith("."):
            yield from _result_folders(path)
