"""A folder of results that appears whole or not at all."""

import errno
import os
import secrets
import shutil
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from ..errors import ConversionError, InputError


@contextmanager
def output_folder(path: Path, belongings: Collection[str] = ()) -> Iterator[Path]:
    """Give an empty folder beside `path`; when the block ends well, what is in it moves into `path`.

    Until then, and for good where the block raises, `path` stays as it was; a folder that was not there is
    not there afterwards either. Files of other names in `path` are kept. A reader may see the files of a set
    arrive one after the other, but each of them whole.

    Args:
        path: The folder; made with its parents where it is missing.
        belongings: Names, relative to `path`, of all files that such a block may make. Those left from an
            earlier run that this one does not make are removed, so that a set is never of two runs.

    Raises:
        InputError: `path` is no folder, or nothing can be written there.
        ConversionError: The files cannot be moved into place.
    """
    target = Path(os.path.realpath(path))
    if target.exists() and not target.is_dir():
        raise InputError(f"{path}: is a file; the output must be a folder, new or old")
    above = [folder for folder in target.parents if not folder.exists()]
    try:
        new = _work_folder(target)
    except OSError as error:
        _remove_empty(above)
        raise InputError(f"{path}: cannot be written ({error.strerror}); name a folder that can") from error
    old = new.with_name(f"{new.name}-old")
    try:
        yield new
        _move_into(target, new, old, belongings)
    except OSError as error:
        raise ConversionError(f"{path}: cannot be written ({error.strerror or error})") from error
    finally:
        shutil.rmtree(new, ignore_errors=True)
        shutil.rmtree(old, ignore_errors=True)
        _remove_empty(above)


def _work_folder(target: Path) -> Path:
    """Make a folder from which files can be moved into `target`: beside it, or else inside it.

    Beside is not possible where `target` is a mounted volume or its parent is not ours to write.
    """
    if target.is_dir() and not os.access(target, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, "no permission")
    token = secrets.token_hex(4)
    folder = target.parent / f".{target.name}-{token}"
    if not target.is_dir():
        folder.mkdir(parents=True)
        return folder
    if os.access(target.parent, os.W_OK | os.X_OK) and target.stat().st_dev == target.parent.stat().st_dev:
        folder.mkdir()
        return folder
    inside = target / f".keymark-{token}"
    inside.mkdir()
    return inside


def _remove_empty(folders: Sequence[Path]) -> None:
    """Remove folders that this run has made, nearest first, while they are empty."""
    for folder in folders:
        try:
            folder.rmdir()
        except OSError:
            return


def _move_into(target: Path, new: Path, old: Path, belongings: Collection[str]) -> None:
    """Move all files below `new` into `target`; put everything back where one cannot be moved."""
    made = {file.relative_to(new) for file in new.rglob("*") if file.is_file()}
    replaced = sorted(made | {Path(name) for name in belongings})
    undo: list[tuple[Path, Path]] = []
    was_there = target.exists()
    try:
        for name in replaced:
            if (target / name).is_file():
                _move(target / name, old / name, undo)
        for name in sorted(made):
            _move(new / name, target / name, undo)
    except BaseException:
        for source, destination in reversed(undo):
            os.replace(destination, source)
        if not was_there:
            shutil.rmtree(target, ignore_errors=True)
        raise
    for folder in {(target / name).parent for name in replaced} - {target}:
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()


def _move(source: Path, destination: Path, undo: list[tuple[Path, Path]]) -> None:
    destination.parent.mkdir(parents=True, exist_ok=True)
    os.replace(source, destination)
    undo.append((source, destination))
