"""Failures of a shoot's takes, kept beside the results until the take converts.

Each is a file of its own, so that several machines may write theirs at a time.
"""

import hashlib
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from ...errors import InputError
from ...files.fields import Fields
from ...files.json_file import read_json, write_json
from ...take.description import clip_name
from ..discovery.take_names import RESERVED, name_of_way
from ..shoot import Shoot

FOLDER = Path(RESERVED[0]) / "failures"
"""Below the folder of the results."""
LARGEST_BYTES = 2**16
DIGITS = 16
INPUT, CONVERSION, CRASH = "input", "conversion", "crash"


@dataclass(frozen=True)
class Failure:
    """Why a take did not convert."""

    take: str
    """Its name in the shoot."""
    error: str
    """The reason, in a sentence."""
    kind: str
    """`input`, `conversion`, or `crash` where the process itself came to an end."""


def write_failure(output: Path, failure: Failure) -> None:
    """Keep a failure.

    Args:
        output: The folder of all results.
        failure: Of one of its takes.

    Raises:
        ConversionError: The file cannot be written.
    """
    write_json(_file(output, failure.take), asdict(failure), indent=1)


def clear_failure(output: Path, take: str) -> None:
    """Forget a take's failure, if there was one."""
    with suppress(OSError):
        _file(output, take).unlink(missing_ok=True)


def read_failures(output: Path) -> list[Failure]:
    """The failures of all takes that can be read, in the order of their names."""
    with suppress(OSError):
        found = [_read(file) for file in (output / FOLDER).glob("*.json")]
        return sorted((failure for failure in found if failure is not None), key=lambda one: one.take)
    return []


def read_failure(output: Path, take: str) -> Failure | None:
    """A take's failure; None where it has none, or none that can be read."""
    found = _read(_file(output, take))
    return found if found is not None and found.take == take else None


def forget_gone_takes(output: Path, shoot: Shoot) -> None:
    """Forget failures of takes that were deleted: else every library merged from then on would lack some.

    A list or one clip says nothing of takes that it lacks.

    Args:
        output: The folder of all results.
        shoot: All takes.
    """
    known = {take.name for take in shoot.takes}
    for failure in read_failures(output):
        if failure.take not in known and _is_gone(shoot.path, failure.take):
            clear_failure(output, failure.take)


def _is_gone(folder: Path, take: str) -> bool:
    """Whether a folder of takes has lost one: there is neither its folder nor its clip."""
    if not folder.is_dir():
        return False
    try:
        inside = [file.relative_to(folder) for file in (folder / take).parent.iterdir()]
    except (FileNotFoundError, NotADirectoryError):
        return True
    except (OSError, ValueError):  # it may be there
        return False
    return take not in {name_of_way(way.with_name(clip_name(folder / way))) for way in inside}


def _read(path: Path) -> Failure | None:
    with suppress(InputError):
        fields = Fields(read_json(path, LARGEST_BYTES), str(path))
        return Failure(*(fields.text(name, "a text") for name in ("take", "error", "kind")))
    return None


def _file(output: Path, take: str) -> Path:
    digest = hashlib.sha256(take.encode("utf-8", "surrogatepass")).hexdigest()
    return output / FOLDER / f"{digest[:DIGITS]}.json"
