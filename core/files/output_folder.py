"""A folder of results that appears whole or not at all, whatever ends the process that makes it."""

import errno
import os
import shutil
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from ..errors import ConversionError, InputError, KeymarkError
from .commit import Commit, clean_up, files_below, read_journal, roll_back, roll_forward, write_journal
from .file_lock import LOCK, file_lock, hidden_prefix
from .fsync import DISK_ERRORS

NOTHING_ASIDE: Mapping[str, str] = {}


@contextmanager
def output_folder(
    path: Path,
    belongings: Collection[str] = (),
    seal: str | None = None,
    aside: Mapping[str, str] = NOTHING_ASIDE,
) -> Iterator[Path]:
    """Give an empty folder beside `path`; when the block ends well, what is in it moves into `path`.

    Until then, and for good where the block raises or makes nothing, `path` stays as it was; a folder that
    was not there is not there afterwards either. Files of other names in `path` are kept. A folder that was
    not there appears at once; in one that was, a reader sees the files of a set arrive one after the other,
    each of them whole, and the seal only while all are there and of one set.

    Where a process was killed, the next that comes to `path` ends what it had completed and removes what it
    had not, before the block begins.

    Args:
        path: The folder; made with its parents where it is missing.
        belongings: Names, relative to `path`, of all files that such a block may make. Those left from an
            earlier run that this one does not make are removed, so that a set is never of two runs.
        seal: Name of the file that vouches for the others.
        aside: Names of files in `path` that would be replaced or removed, and the names that they get
            instead; it is looked at when the block has ended.

    Raises:
        InputError: `path` is no folder, or nothing can be written there.
        BusyError: Another process or thread works on the same folder.
        ConversionError: The files cannot be moved into place.
    """
    try:
        target = _target(path)
        above = [folder for folder in target.parents if not folder.exists()]
        stem = _level(target) / hidden_prefix(target.name)
    except (OSError, ValueError) as error:
        raise _refused(path, error) from error
    busy = f"{path}: another process is writing there; try again when it has finished"
    entered = False
    try:
        with file_lock(stem.with_name(stem.name + LOCK), busy):
            empty = Commit(target, stem, seal)
            _tidy(empty)
            _make(empty.new)
            entered = True
            yield from _filled(empty, belongings, aside)
    except KeymarkError:
        raise
    except OSError as error:
        raise _failed(path, error) if entered else _refused(path, error) from error
    finally:
        _remove_empty(above)


def _filled(empty: Commit, belongings: Collection[str], aside: Mapping[str, str]) -> Iterator[Path]:
    """Let the set be made, then move it in."""
    done: list[tuple[Path, Path]] = []
    try:
        yield empty.new
        made = files_below(empty.new)
        if made:
            gone = tuple(sorted(set(belongings) - set(made)))
            arrival = Commit(empty.target, empty.stem, empty.seal, made, gone, dict(aside))
            write_journal(arrival)
            roll_forward(arrival, done)
    except BaseException:
        roll_back(empty, done)  # where this fails, the next to come ends what was begun
        clean_up(empty)
        raise
    try:
        clean_up(empty)
    except KeyboardInterrupt:
        clean_up(empty)
        raise


def _make(folder: Path) -> None:
    """Make a folder, or leave none where that is interrupted."""
    try:
        folder.mkdir()
    except KeyboardInterrupt:
        with suppress(OSError):
            folder.rmdir()
        raise


def _tidy(empty: Commit) -> None:
    """End or remove what a killed process has left."""
    found = read_journal(empty)
    if found is not None:
        roll_forward(found, [])
    clean_up(empty)
    if empty.stem.parent == empty.target:
        for rest in empty.target.glob(f"{empty.stem.name}-*"):  # Blender's files, see `blend_place`
            rest.unlink(missing_ok=True)
    for rest in (empty.new, empty.old):
        if os.path.lexists(rest):
            shutil.rmtree(rest)  # which could not be removed: this time say why


def real_path(path: Path) -> Path:
    """A path from the root, links resolved, with one slash before it: two mean something to Blender."""
    real = os.path.realpath(path)
    return Path("/" + real.lstrip("/") if real.startswith("//") else real)


def _target(path: Path) -> Path:
    target = real_path(path)
    try:
        os.lstat(target)  # a name that cannot be is an error here, and from Python 3.14 on nowhere else
    except FileNotFoundError:
        return target
    if not target.is_dir():
        raise FileExistsError(errno.EEXIST, "is a file; the output must be a folder, new or old")
    return target


def _level(target: Path) -> Path:
    """The folder from which files can be moved into `target`: that it lies in, or else itself.

    The first is not possible where `target` is a mounted volume or its parent is not ours to write.
    """
    if not target.is_dir():
        return target.parent
    if not os.access(target, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, "no permission")
    beside = os.access(target.parent, os.W_OK | os.X_OK)
    return target.parent if beside and target.stat().st_dev == target.parent.stat().st_dev else target


def _refused(path: Path, error: Exception) -> KeymarkError:
    """The sentence on a place where nothing can be begun."""
    if isinstance(error, OSError) and error.errno in DISK_ERRORS:
        return _failed(path, error)
    if isinstance(error, FileExistsError) and error.filename is None:
        return InputError(f"{path}: {error.strerror}")
    reason = (error.strerror if isinstance(error, OSError) else None) or error
    return InputError(f"{path}: cannot be written ({reason}); name a folder that can")


def _failed(path: Path, error: OSError) -> ConversionError:
    return ConversionError(f"{path}: cannot be written ({error.strerror or error})")


def _remove_empty(folders: Sequence[Path]) -> None:
    """Remove folders that this run has made, nearest first, while they are empty."""
    for folder in folders:
        try:
            folder.rmdir()
        except OSError:
            return
