"""Outcomes of takes in a batch: results and failures, written beside each other and read again."""

import hashlib
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated

from ..errors import InputError
from ..files.json_file import read_json, write_json
from ..files.kinds import Text
from ..files.paths import absolute_path
from ..files.records import Record
from ..take.conversion_record import RECORD_FILE, ConversionRecord, find_record, read_record
from ..take.description import clip_name
from .discovery import RESERVED, Shoot, ShootTake, take_name

FOLDER = Path(RESERVED[0]) / "failures"
LARGEST_BYTES = 2**16
INPUT, CONVERSION, CRASH = "input", "conversion", "crash"


Words = Annotated[str, Text(LARGEST_BYTES)]


@dataclass(frozen=True)
class Failure(Record):
    """Why a take did not convert."""

    take: Words
    """Its name in the shoot."""
    error: Words
    """The reason, in a sentence."""
    kind: Words
    """`input`, `conversion`, or `crash` where the process itself died."""


def write_failure(output: Path, failure: Failure) -> None:
    """Write a failure."""
    write_json(_file(output, failure.take), failure.to_json(), indent=1)


def remove_failure(output: Path, take: str) -> None:
    """Remove a take's failure, if there is one."""
    with suppress(OSError):
        _file(output, take).unlink(missing_ok=True)


def read_failures(output: Path) -> list[Failure]:
    """All failures that can be read, in the order of the takes' names."""
    with suppress(OSError):
        found = [_read(file) for file in (output / FOLDER).glob("*.json")]
        return sorted((failure for failure in found if failure is not None), key=lambda one: one.take)
    return []


def read_failure(output: Path, take: str) -> Failure | None:
    """A take's failure; None where it has none, or none that can be read."""
    found = _read(_file(output, take))
    return found if found is not None and found.take == take else None


def remove_failures_of_deleted_takes(output: Path, shoot: Shoot) -> None:
    """Remove failures of takes that no longer exist: else every library merged later would seem incomplete.

    A list or one clip does not tell whether other takes exist.
    """
    known, folder = {take.name for take in shoot.takes}, shoot.path
    for take in (failure.take for failure in read_failures(output) if folder.is_dir()):
        names: set[str] = set()
        try:
            siblings = [file.relative_to(folder) for file in (folder / take).parent.iterdir()]
            names = {take_name(path.with_name(clip_name(folder / path))) for path in siblings}
        except (FileNotFoundError, NotADirectoryError):
            pass
        except (OSError, ValueError):  # it may exist
            continue
        if take not in known and take not in names:
            remove_failure(output, take)


def _read(path: Path) -> Failure | None:
    with suppress(InputError):
        return Failure.from_json(read_json(path, LARGEST_BYTES), str(path))
    return None


def _file(output: Path, take: str) -> Path:
    digest = hashlib.sha256(take.encode("utf-8", "surrogatepass")).hexdigest()
    return output / FOLDER / f"{digest[:16]}.json"


class Status(StrEnum):
    """Status of a take in a batch."""

    CONVERTED = "converted"
    UNCHANGED = "unchanged"
    """Converted before, from the same input."""
    FAILED = "failed"
    WAITING = "waiting"
    """Not converted yet, or interrupted."""


@dataclass(frozen=True, eq=False)
class Outcome:
    """The outcome of one take."""

    take: Words
    folder: Path
    status: Status
    record: ConversionRecord | None = None
    """Of the results in the folder, if there are any: of an earlier input where this run has failed."""
    error: str | None = None
    seconds: float | None = None


def read_outcome(take: ShootTake, output: Path) -> Outcome:
    """The outcome of one take as the folder of the results shows it; its input is not looked at."""
    folder = output / take.name
    record = find_record(folder)
    failure = read_failure(output, take.name)
    if failure is not None:
        return Outcome(take.name, folder, Status.FAILED, record, failure.error)
    return Outcome(take.name, folder, Status.WAITING if record is None else Status.CONVERTED, record)


@dataclass(frozen=True, eq=False)
class Result:
    """The result of one take's conversion."""

    name: str
    """Its path from the folder that was searched, with slashes: the take's name in its shoot."""
    folder: Path
    record: ConversionRecord


def find_results(folder: Path) -> tuple[list[Result], dict[str, str]]:
    """Every result below a folder, and by name of each whose record is unusable, why, in a sentence.

    Both are in the order of their names; hidden folders and links to folders are skipped.
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
    return sorted(sound, key=lambda result: result.name), dict(sorted(damaged.items()))


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
