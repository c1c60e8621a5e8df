"""Files of an earlier result that a person has changed since; they are kept under another name."""

from collections.abc import Collection, Iterable, Mapping
from pathlib import Path

from ....core.errors import InputError
from ....core.files.commit import backup_name
from ....core.files.digest import content_digest
from ....core.files.json_file import read_json, write_json
from ....core.retarget.retarget_record import RECORD_FILE as RETARGET
from ....core.take.conversion_record import RECORD_FILE

AS_MADE = ".as_made.json"
"""File with the SHA-256 of files as they were made, beside the results. It has those whose bytes differ from
run to run though their content does not, so that the record itself is always the same."""
LARGEST_BYTES = 2**16
RECORDS = (RECORD_FILE, RETARGET)
"""Files that nobody edits."""


def changed_files(
    output: Path,
    staging_folder: Path,
    names: Iterable[str],
    editable: Collection[str],
    recorded: Mapping[str, str],
) -> dict[str, str]:
    """Files of a result that are no longer as they were made, though new ones are about to replace them.

    Args:
        output: Folder of the result.
        staging_folder: Folder of the new files.
        names: Files that the new result replaces or removes, as paths in the folder. Of those in `editable`
            only the ones that are made anew are replaced.
        editable: Files that belong to a person where no record says that a conversion has made them.
        recorded: Digests of the files that the folder's record lists; empty where there is none.

    Returns:
        The names under which these files are to be kept, by their present names.

    Raises:
        InputError: A file cannot be read.
    """
    try:
        made = {**recorded, **read_json(output / AS_MADE, LARGEST_BYTES)} if recorded else {}
    except InputError:
        made = {}
    kept = {}
    for name in names:
        old, new = output / name, staging_folder / name
        replaced = new.is_file() or (name in made and name not in editable)
        if name in RECORDS or not replaced or not old.is_file() or not (name in made or name in editable):
            continue
        digest = content_digest(old)
        if digest != made.get(name) and not (new.is_file() and content_digest(new) == digest):
            kept[name] = backup_name(old).relative_to(output).as_posix()
    return kept


def write_made_digests(staging_folder: Path, names: Iterable[str]) -> None:
    """Record the digests of files as they were made, by which a later conversion notices changes.

    Raises:
        ConversionError: The record cannot be written.
    """
    write_json(staging_folder / AS_MADE, {name: content_digest(staging_folder / name) for name in names})


def kept_note(name: str, other: str) -> str:
    """The note on a file that is kept under another name."""
    return f"{name} was changed after Keymark had made it and is kept as {other}"
