"""Failures of a shoot's takes, kept beside the results until the take converts.

Each failure is a file of its own, so that several machines can write at a time.
"""

import hashlib
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from ...errors import InputError
from ...files.json_file import read_json, write_json
from ...files.kinds import Text
from ...files.records import Record
from ...take.description import clip_name
from ..discovery.take_names import RESERVED, take_name
from ..shoot import Shoot

FOLDER = Path(RESERVED[0]) / "failures"
"""Below the folder of the results."""
LARGEST_BYTES = 2**16
DIGITS = 16
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
    """Write a failure.

    Args:
        output: The folder of all results.
        failure: The failure of one take.

    Raises:
        ConversionError: The file cannot be written.
    """
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

    Args:
        output: The folder of all results.
        shoot: All takes.
    """
    known = {take.name for take in shoot.takes}
    for failure in read_failures(output):
        if failure.take not in known and _is_deleted(shoot.path, failure.take):
            remove_failure(output, failure.take)


def _is_deleted(folder: Path, take: str) -> bool:
    """Whether neither the folder nor the clip of a take exists any more."""
    if not folder.is_dir():
        return False
    try:
        siblings = [file.relative_to(folder) for file in (folder / take).parent.iterdir()]
    except (FileNotFoundError, NotADirectoryError):
        return True
    except (OSError, ValueError):  # it may exist
        return False
    return take not in {take_name(path.with_name(clip_name(folder / path))) for path in siblings}


def _read(path: Path) -> Failure | None:
    with suppress(InputError):
        return Failure.from_json(read_json(path, LARGEST_BYTES), str(path))
    return None


def _file(output: Path, take: str) -> Path:
    digest = hashlib.sha256(take.encode("utf-8", "surrogatepass")).hexdigest()
    return output / FOLDER / f"{digest[:DIGITS]}.json"
