"""Two-phase commit of a result folder: moves are journaled, so that another process can finish them.

First the files are made in a staging folder; then a journal beside the target folder lists the moves. From
then on the commit counts as made: a process that finds the journal, and its writer dead, rolls it forward;
what has no complete journal it removes.
"""

import itertools
import json
import os
import shutil
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path, PureWindowsPath
from typing import Any

from ..errors import InputError
from .json_file import fsync_path, read_json

STAGING, ROLLBACK, JOURNAL, JOURNAL_DRAFT = "-new", "-old", ".json", ".json.new"
"""Endings of the hidden names. They and the journal's fields never change, so that a run that was interrupted
before an update of Keymark is recovered after it."""
LARGEST_BYTES = 2**24

Moves = list[tuple[Path, Path]]


@dataclass(frozen=True)
class Commit:
    """A set of files, the folder it is made in and the folder it goes to."""

    target: Path
    """The folder that the files go to, which may not exist yet."""
    stem: Path
    """Beginning of the paths of all hidden files and folders of the commit."""
    manifest: str | None = None
    """The file that lists the others: the first to be removed, the last to be written."""
    written: tuple[str, ...] = ()
    removed: tuple[str, ...] = ()
    """Files of earlier sets that this one lacks."""
    backups: Mapping[str, str] = field(default_factory=dict)
    """Files in the target that are kept under another name instead of being replaced or removed."""

    def hidden(self, ending: str) -> Path:
        """The set's folder (`STAGING`), what it replaces (`ROLLBACK`), its moves (`JOURNAL`), their draft.

        While the journal exists, the set is complete but not all in the target.
        """
        return self.stem.with_name(self.stem.name + ending)


def write_journal(commit: Commit) -> None:
    """First phase: flush a complete set to the disk and write the journal.

    Raises:
        OSError: The disk is full, or gone.
    """
    for folder, _, names in os.walk(commit.hidden(STAGING)):
        for name in names:
            fsync_path(Path(folder) / name)
        fsync_path(Path(folder))
    fields = {
        "target": commit.target.name,
        "seal": commit.manifest,
        "made": list(commit.written),
        "gone": list(commit.removed),
        "aside": dict(commit.backups),
    }
    commit.hidden(JOURNAL_DRAFT).write_text(json.dumps(fields), encoding="utf-8")
    fsync_path(commit.hidden(JOURNAL_DRAFT))
    os.replace(commit.hidden(JOURNAL_DRAFT), commit.hidden(JOURNAL))
    fsync_path(commit.hidden(JOURNAL).parent)


def roll_forward(commit: Commit, moves: Moves) -> None:
    """Second phase: move a journaled set into its folder; what another process has moved already stays."""
    staging_folder, target = commit.hidden(STAGING), commit.target
    staged = [name for name in commit.written if (staging_folder / name).is_file()]
    if staged == list(commit.written) and not target.exists():
        _move(staging_folder, target, moves)
        fsync_path(target.parent)
        return
    staged.sort(key=lambda name: name == commit.manifest)
    replaced = sorted([*staged, *commit.removed], key=lambda name: name != commit.manifest)
    for name in replaced:
        _move_away(commit, name, moves)
        if name == commit.manifest:
            fsync_path(target)
    folders = {(target / name).parent for name in (*commit.written, *commit.removed)}
    for name in staged:
        if name == commit.manifest:
            _fsync_all(folders)
        _move(staging_folder / name, target / name, moves)
    _fsync_all(folders)
    for folder in folders - {target}:
        with suppress(OSError):  # it is not empty
            folder.rmdir()


def roll_back(commit: Commit, moves: Moves) -> None:
    """Undo moves, the last first, also one that was interrupted.

    Raises:
        OSError: A move cannot be undone; those before it stay in `moves`.
    """
    while moves:
        source, destination = moves[-1]
        if not os.path.lexists(source) and os.path.lexists(destination):
            source.parent.mkdir(parents=True, exist_ok=True)
            os.replace(destination, source)
        if destination.parent != commit.target:
            with suppress(OSError):  # it holds other files
                destination.parent.rmdir()
        moves.pop()


def clean_up(commit: Commit) -> None:
    """Remove all hidden files of a commit, the journal first: without it the others mean nothing."""
    for file in (commit.hidden(JOURNAL), commit.hidden(JOURNAL_DRAFT)):
        file.unlink(missing_ok=True)
    for folder in (commit.hidden(STAGING), commit.hidden(ROLLBACK)):
        shutil.rmtree(folder, ignore_errors=True)


def recover(commit: Commit) -> None:
    """Finish or remove what a killed process has left of a commit to the same target.

    Raises:
        OSError: A file cannot be moved, or not removed.
    """
    interrupted = _read_journal(commit)
    if interrupted is not None:
        roll_forward(interrupted, [])
    clean_up(commit)
    if commit.stem.parent == commit.target:
        for file in commit.target.glob(f"{commit.stem.name}-*"):  # by Blender, see `convert_take`
            file.unlink(missing_ok=True)
    for folder in (commit.hidden(STAGING), commit.hidden(ROLLBACK)):
        if os.path.lexists(folder):
            shutil.rmtree(folder)  # `clean_up` could not remove it: this time with the reason


def _read_journal(commit: Commit) -> Commit | None:
    """The commit that another process has journaled and not finished.

    None where there is no journal, or it is damaged, of another target, names paths outside the target, or
    files of the set are missing.
    """
    try:
        fields = read_json(commit.hidden(JOURNAL), LARGEST_BYTES)
        written, removed, backups, manifest = (fields[name] for name in ("made", "gone", "aside", "seal"))
        names = [*written, *removed, *backups, *backups.values(), *(() if manifest is None else (manifest,))]
        if fields["target"] != commit.target.name or not all(map(_is_inside, names)):
            return None
    except (InputError, LookupError, TypeError, AttributeError):
        return None
    found = Commit(commit.target, commit.stem, manifest, tuple(written), tuple(removed), dict(backups))
    folders = (found.hidden(STAGING), found.target)
    complete = all(any((folder / name).is_file() for folder in folders) for name in written)
    return found if complete else None


def _is_inside(name: Any) -> bool:
    path = PureWindowsPath(name)  # which reads both kinds of slash
    return not path.anchor and ".." not in path.parts and bool(path.name)


def files_below(folder: Path) -> tuple[str, ...]:
    """All files in a folder and those below, as paths in it with slashes, in order."""
    return tuple(sorted(file.relative_to(folder).as_posix() for file in folder.rglob("*") if file.is_file()))


def backup_name(file: Path) -> Path:
    """An unused name beside a file, under which it is kept where it is not to be replaced."""
    endings = (f" (changed{'' if number == 1 else f' {number}'})" for number in itertools.count(1))
    names = (file.with_stem(file.stem + ending) for ending in endings)
    return next(other for other in names if not os.path.lexists(other))


def _move_away(commit: Commit, name: str, moves: Moves) -> None:
    existing = commit.target / name
    if not existing.is_file() and not existing.is_symlink():
        return
    if name in commit.backups:
        backup = commit.target / commit.backups[name]
        _move(existing, backup_name(existing) if os.path.lexists(backup) else backup, moves)
    else:
        _move(existing, commit.hidden(ROLLBACK) / name, moves)


def _move(source: Path, destination: Path, moves: Moves) -> None:
    destination.parent.mkdir(parents=True, exist_ok=True)
    moves.append((source, destination))  # before: an interruption may come right after the move
    os.replace(source, destination)


def _fsync_all(folders: Iterable[Path]) -> None:
    for folder in folders:
        if folder.is_dir():
            fsync_path(folder)
