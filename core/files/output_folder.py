"""Result folders, written completely or not at all, even where the process is killed."""

import errno
import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from ..errors import ConversionError, InputError, KeymarkError
from .commit import (
    STAGING,
    Commit,
    Moves,
    clean_up,
    files_below,
    recover,
    roll_back,
    roll_forward,
    write_journal,
)
from .file_lock import LOCK, file_lock, hidden_prefix
from .json_file import DISK_ERRORS
from .paths import real_path

NO_BACKUPS: Mapping[str, str] = {}


@contextmanager
def output_folder(
    path: Path,
    own_files: Collection[str] = (),
    manifest: str | None = None,
    backups: Mapping[str, str] = NO_BACKUPS,
) -> Iterator[Path]:
    """Give an empty staging folder; when the block ends well, its files are committed to `path`.

    Until then, and for good where the block raises or makes no file, `path` stays as it was; a folder that
    did not exist does not exist afterwards either. Files of other names in `path` are kept. A new folder
    appears at once; in an older one a reader sees the files of a set arrive one after the other, each of them
    whole, and the manifest only while all files of one set are there.

    Where a process was killed, the next one that uses `path` finishes or removes its commit before the block
    begins.

    Args:
        path: The folder; made with its parents where it is missing.
        own_files: Names, relative to `path`, of all files that such a block may make. Those of an earlier run
            that this one does not make are removed, so that a set is never of two runs.
        manifest: Name of the file that lists the others.
        backups: Names of files in `path` that would be replaced or removed, and the names that they get
            instead; read after the block.

    Raises:
        InputError: `path` is no folder, or nothing can be written there.
        BusyError: Another process or thread works on the same folder.
        ConversionError: The files cannot be moved into `path`.
    """
    try:
        target = _target_folder(path)
        new_parents = [folder for folder in target.parents if not folder.exists()]
        stem = _staging_parent(target) / hidden_prefix(target.name)
    except (OSError, ValueError) as error:
        raise _refusal(path, error) from error
    busy_message = f"{path}: another process is writing there; try again when it has finished"
    entered = False
    try:
        with file_lock(stem.with_name(stem.name + LOCK), busy_message):
            empty = Commit(target, stem, manifest)
            recover(empty)
            _make_folder(empty.hidden(STAGING))
            entered = True
            yield from _stage_and_commit(empty, own_files, backups)
    except KeymarkError:
        raise
    except OSError as error:
        raise _write_error(path, error) if entered else _refusal(path, error) from error
    finally:
        _remove_empty(new_parents)


def _stage_and_commit(
    empty: Commit, own_files: Collection[str], backups: Mapping[str, str]
) -> Iterator[Path]:
    moves: Moves = []
    try:
        yield empty.hidden(STAGING)
        written = files_below(empty.hidden(STAGING))
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


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir()
    except KeyboardInterrupt:
        with suppress(OSError):
            folder.rmdir()
        raise


def _target_folder(path: Path) -> Path:
    target = real_path(path)
    try:
        os.lstat(target)  # an impossible name is an error here, and from Python 3.14 on nowhere else
    except FileNotFoundError:
        return target
    if not target.is_dir():
        raise FileExistsError(errno.EEXIST, "is a file; the output must be a folder, new or old")
    return target


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


def _refusal(path: Path, error: Exception) -> KeymarkError:
    """The error for a folder in which no staging folder can be made."""
    if isinstance(error, OSError) and error.errno in DISK_ERRORS:
        return _write_error(path, error)
    if isinstance(error, FileExistsError) and error.filename is None:
        return InputError(f"{path}: {error.strerror}")
    reason = (error.strerror if isinstance(error, OSError) else None) or error
    return InputError(f"{path}: cannot be written ({reason}); name a folder that can")


def _write_error(path: Path, error: OSError) -> ConversionError:
    return ConversionError(f"{path}: cannot be written ({error.strerror or error})")


def _remove_empty(folders: Sequence[Path]) -> None:
    """Remove parent folders that this run has made, nearest first, while they are empty."""
    for folder in folders:
        try:
            folder.rmdir()
        except OSError:
            return
