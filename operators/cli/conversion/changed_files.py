"""Files of an earlier result that somebody has changed since; they are kept, not replaced."""

from collections.abc import Collection, Iterable
from pathlib import Path

from ....core.errors import InputError
from ....core.files.commit import backup_name
from ....core.files.digest import content_digest
from ....core.files.json_file import read_json, write_json
from ....core.take.conversion_record import RECORD_FILE, read_record

AS_MADE = ".as_made.json"
"""SHA-256 of files as they were made, beside the results; for those that differ from run to run, though
what they hold does not, so that the record itself is always the same."""
MOST_BYTES = 2**16


def changed_files(
    output: Path, place: Path, names: Iterable[str], worked_in: Collection[str]
) -> dict[str, str]:
    """Which files of a folder of results are no longer as they were made, though new ones replace them.

    Args:
        output: The folder; its record says what was made.
        place: Where the new results lie.
        names: Files that new results replace or remove, as paths in the folder. Of those in `worked_in`
            only ones that are made anew.
        worked_in: Files that are somebody's where no record says that a conversion has made them.

    Returns:
        By their names the names under which they are to be kept.

    Raises:
        InputError: A file cannot be read.
    """
    try:
        made = {**read_record(output).files, **read_json(output / AS_MADE, MOST_BYTES)}
    except InputError:
        made = {}
    kept = {}
    for name in names:
        there, new = output / name, place / name
        replaced = new.is_file() or (name in made and name not in worked_in)
        if (
            name == RECORD_FILE
            or not replaced
            or not there.is_file()
            or not (name in made or name in worked_in)
        ):
            continue
        digest = content_digest(there)
        if digest != made.get(name) and not (new.is_file() and content_digest(new) == digest):
            kept[name] = backup_name(there).relative_to(output).as_posix()
    return kept


def note_as_made(place: Path, name: str) -> None:
    """Write down what a file is like as long as nobody has worked in it.

    Raises:
        ConversionError: It cannot be written.
    """
    write_json(place / AS_MADE, {name: content_digest(place / name)})


def kept_note(name: str, other: str) -> str:
    """The sentence for the person whose work it may be."""
    return f"{name} was changed after Keymark had made it and is kept as {other}"
