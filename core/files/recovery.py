"""Recovery of an interrupted commit: finished where its journal is complete, else removed."""

import os
import shutil
from pathlib import PureWindowsPath
from typing import Any

from ..errors import InputError
from .commit import Commit, clean_up, roll_forward
from .json_file import read_json

LARGEST_BYTES = 2**24


def recover(commit: Commit) -> None:
    """Finish or remove what a killed process has left of a commit to the same target.

    Args:
        commit: An empty one: its target and its hidden names.

    Raises:
        OSError: A file cannot be moved, or not removed.
    """
    interrupted = read_journal(commit)
    if interrupted is not None:
        roll_forward(interrupted, [])
    clean_up(commit)
    if commit.stem.parent == commit.target:
        for file in commit.target.glob(f"{commit.stem.name}-*"):  # by Blender, see `convert_take`
            file.unlink(missing_ok=True)
    for folder in (commit.staging_folder, commit.rollback_folder):
        if os.path.lexists(folder):
            shutil.rmtree(folder)  # `clean_up` could not remove it: this time with the reason


def read_journal(commit: Commit) -> Commit | None:
    """The commit that another process has journaled and not finished.

    Args:
        commit: An empty one: its target and its hidden names.

    Returns:
        The commit; None where there is no journal, or it is damaged, of another target, names paths outside
        the target, or files of the set are missing.
    """
    try:
        fields = read_json(commit.journal, LARGEST_BYTES)
        written, removed, backups, manifest = (fields[name] for name in ("made", "gone", "aside", "seal"))
        names = [
            *written,
            *removed,
            *backups.keys(),
            *backups.values(),
            *([] if manifest is None else [manifest]),
        ]
        if fields["target"] != commit.target.name or not all(map(_is_inside, names)):
            return None
    except (InputError, LookupError, TypeError, AttributeError):
        return None
    found = Commit(commit.target, commit.stem, manifest, tuple(written), tuple(removed), dict(backups))
    folders = (found.staging_folder, found.target)
    complete = all(any((folder / name).is_file() for folder in folders) for name in written)
    return found if complete else None


def _is_inside(name: Any) -> bool:
    path = PureWindowsPath(name)  # which reads both kinds of slash
    return not path.anchor and ".." not in path.parts and bool(path.name)
