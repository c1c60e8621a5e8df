"""Result folders, written completely or not at all, even where the process is killed.

The files are made in a staging folder; then a journal beside the target folder lists the moves. From then on
the commit counts as made: a process that finds the journal, and its writer dead, rolls it forward; what has
no complete journal it removes.
"""

import errno
import itertools
import json
import os
import shutil
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path, PureWindowsPath
from types import MappingProxyType
from typing import Any

from ..errors import ConversionError, InputError, KeymarkError
from .file_lock import LOCK, file_lock, hidden_prefix
from .json_file import DISK_ERRORS, fsync_path, read_json
from .paths import real_path

STAGING, ROLLBACK, JOURNAL, JOURNAL_DRAFT = "-new", "-old", ".json", ".json.new"
"""Endings of the hidden names. They and the journal's fields never change, so that a run that was interrupted
before an update of Keymark is recovered after it."""

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
    """First phase: flush a complete set to the disk and write the journal."""
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
        existing = target / name
        if existing.is_file() or existing.is_symlink():
            away = target / commit.backups[name] if name in commit.backups else commit.hidden(ROLLBACK) / name
            taken = name in commit.backups and os.path.lexists(away)
            _move(existing, backup_name(existing) if taken else away, moves)
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
    """Undo moves, the last first, also one that was interrupted; what cannot be undone stays in `moves`."""
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
    """Finish or remove what a killed process has left of a commit to the same target."""
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
        fields = read_json(commit.hidden(JOURNAL), 2**24)
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


def backup_name(file: Path) -> Path:
    """An unused name beside a file, under which it is kept where it is not to be replaced."""
    endings = (f" (changed{'' if number == 1 else f' {number}'})" for number in itertools.count(1))
    names = (file.with_stem(file.stem + ending) for ending in endings)
    return next(other for other in names if not os.path.lexists(other))


def _move(source: Path, destination: Path, moves: Moves) -> None:
    destination.parent.mkdir(parents=True, exist_ok=True)
    moves.append((source, destination))  # before: an interruption may come right after the move
    os.replace(source, destination)


def _fsync_all(folders: Iterable[Path]) -> None:
    for folder in folders:
        if folder.is_dir():
            fsync_path(folder)


@contextmanager
def output_folder(
    path: Path,
    own_files: Collection[str] = (),
    manifest: str | None = None,
    backups: Mapping[str, str] = MappingProxyType({}),
) -> Iterator[Path]:
    """Give an empty staging folder; when the block ends well, its files are committed to `path`.

    Until then, and for good where the block raises or makes no file, `path` stays as it was; a folder that
    did not exist does not exist afterwards either. Files of other names in `path` are kept. A new folder
    appears at once; in an older one a reader sees the files of a set arrive one after the other, each of them
    whole, and the manifest only while all files of one set are there.

    Where a process was killed, the next one that uses `path` finishes or removes its commit before the block
    begins. Who finds another at work on the same folder is refused with `BusyError`.

    Args:
        path: The folder; made with its parents where it is missing.
        own_files: Names in it of all files that such a block may make. Those of an earlier run that this one
            does not make are removed, so that a set is never of two runs.
        manifest: Name of the file that lists the others.
        backups: Names of files in it that would be replaced or removed, and what they are called instead;
            read after the block.
    """
    try:
        target = real_path(path)
        with suppress(FileNotFoundError):
            os.lstat(target)  # an impossible name is an error here, and from Python 3.14 on nowhere else
            if not target.is_dir():
                raise FileExistsError(errno.EEXIST, "is a file; the output must be a folder, new or old")
        new_parents = [folder for folder in target.parents if not folder.exists()]
        stem = _staging_parent(target) / hidden_prefix(target.name)
    except (OSError, ValueError) as error:
        raise _failure(path, error) from error
    busy_message = f"{path}: another process is writing there; try again when it has finished"
    entered = False
    try:
        with file_lock(stem.with_name(stem.name + LOCK), busy_message):
            empty = Commit(target, stem, manifest)
            recover(empty)
            try:
                empty.hidden(STAGING).mkdir()
            except KeyboardInterrupt:
                with suppress(OSError):
                    empty.hidden(STAGING).rmdir()
                raise
            entered = True
            yield from _stage_and_commit(empty, own_files, backups)
    except KeymarkError:
        raise
    except OSError as error:
        raise _failure(path, error, entered) from error
    finally:
        with suppress(OSError):  # parents that this run has made, nearest first, while they are empty
            for folder in new_parents:
                folder.rmdir()


def _stage_and_commit(
    empty: Commit, own_files: Collection[str], backups: Mapping[str, str]
) -> Iterator[Path]:
    moves: Moves = []
    try:
        yield empty.hidden(STAGING)
        staging = empty.hidden(STAGING)
        files = (file.relative_to(staging).as_posix() for file in staging.rglob("*") if file.is_file())
        written = tuple(sorted(files))
        if written:
            removed = tuple(sorted(set(own_files) - set(written)))
            commit = Commit(empty.target, empty.stem, empty.manifest, written, removed, dict(backups))
            write_journal(commit)
            roll_forward(commit, moves)
    except BaseException:
        roll_back(empty, moves)  # where this fails, the next run recovers
        clean_up(empty)
        raise
    try:
        clean_up(empty)
    except KeyboardInterrupt:
        clean_up(empty)
        raise


def _staging_parent(target: Path) -> Path:
    """The folder for the staging folder, from which files can be moved: the target's parent, or the target.

    The parent cannot be used where the target is a mounted volume or the parent is not ours to write.
    """
    if not target.is_dir():
        return target.parent
    if not os.access(target, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, "no permission")
    beside = os.access(target.parent, os.W_OK | os.X_OK)
    return target.parent if beside and target.stat().st_dev == target.parent.stat().st_dev else target


def _failure(path: Path, error: Exception, entered: bool = False) -> KeymarkError:
    """The error for a folder in which no staging folder can be made, or nothing written once it is there."""
    reason = (error.strerror if isinstance(error, OSError) else None) or error
    if isinstance(error, OSError) and (entered or error.errno in DISK_ERRORS):
        return ConversionError(f"{path}: cannot be written ({reason})")
    if isinstance(error, FileExistsError) and error.filename is None:
        return InputError(f"{path}: {error.strerror}")
    return InputError(f"{path}: cannot be written ({reason}); name a folder that can")
