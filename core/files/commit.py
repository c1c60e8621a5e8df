"""A complete set of files on its way into its folder; begun by one process, it can be ended by another.

What has to be done is written down first, beside the folder. From then on the set counts as made: a process
that finds such a paper, and its writer dead, does the rest.
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
from .fsync import fsync_path
from .json_file import read_json

NEW, OLD, PAPER, DRAFT = "-new", "-old", ".json", ".json.new"
LARGEST_BYTES = 2**24

Moves = list[tuple[Path, Path]]


@dataclass(frozen=True)
class Commit:
    """Where a set of files comes from and goes to."""

    target: Path
    """The folder that it goes to, which may not be there yet."""
    stem: Path
    """What the paths of everything hidden that belongs to it begin with."""
    seal: str | None = None
    """The file that vouches for the others: the first to go, the last to arrive."""
    made: tuple[str, ...] = ()
    """The files of the set, as paths in the target."""
    gone: tuple[str, ...] = ()
    """Files of earlier sets that this one lacks; they are removed."""
    aside: Mapping[str, str] = field(default_factory=dict)
    """Files in the target that are kept, by the other name that they get."""

    @property
    def new(self) -> Path:
        """The folder in which the set is made."""
        return self.stem.with_name(self.stem.name + NEW)

    @property
    def old(self) -> Path:
        """The folder for what the set replaces, as long as it may have to go back."""
        return self.stem.with_name(self.stem.name + OLD)

    @property
    def paper(self) -> Path:
        """What has to be done; while it is there, the set is complete but not all in place."""
        return self.stem.with_name(self.stem.name + PAPER)

    @property
    def draft(self) -> Path:
        """The paper while it is written."""
        return self.stem.with_name(self.stem.name + DRAFT)


def read_journal(empty: Commit) -> Commit | None:
    """The arrival that another process has begun and not ended; None where there is none, or not all."""
    try:
        said = read_json(empty.paper, LARGEST_BYTES)
        made, gone, aside, seal = (said[name] for name in ("made", "gone", "aside", "seal"))
        names = [*made, *gone, *aside.keys(), *aside.values(), *([] if seal is None else [seal])]
        if said["target"] != empty.target.name or not all(map(_is_inside, names)):
            return None
    except (InputError, LookupError, TypeError, AttributeError):
        return None
    found = Commit(empty.target, empty.stem, seal, tuple(made), tuple(gone), dict(aside))
    return (
        found
        if all(any((at / name).is_file() for at in (found.new, found.target)) for name in made)
        else None
    )


def write_journal(arrival: Commit) -> None:
    """Bring a complete set to the disk and write down what has to be done with it.

    Raises:
        OSError: The disk is full, or gone.
    """
    for folder, _, names in os.walk(arrival.new):
        for name in names:
            fsync_path(Path(folder) / name)
        fsync_path(Path(folder))
    said = {
        "target": arrival.target.name,
        "seal": arrival.seal,
        "made": list(arrival.made),
        "gone": list(arrival.gone),
        "aside": dict(arrival.aside),
    }
    arrival.draft.write_text(json.dumps(said), encoding="utf-8")
    fsync_path(arrival.draft)
    os.replace(arrival.draft, arrival.paper)
    fsync_path(arrival.paper.parent)


def roll_forward(arrival: Commit, done: Moves) -> None:
    """Move an announced set into its folder; files moved already by another process are left where they are.

    Args:
        arrival: The set.
        done: Takes note of every move (from, to), so that it can be undone.

    Raises:
        OSError: A file cannot be moved.
    """
    new, target = arrival.new, arrival.target
    waiting = [name for name in arrival.made if (new / name).is_file()]
    if waiting == list(arrival.made) and not target.exists():
        _move(new, target, done)
        fsync_path(target.parent)
        return
    waiting.sort(key=lambda name: name == arrival.seal)
    replaced = sorted([*waiting, *arrival.gone], key=lambda name: name != arrival.seal)
    for name in replaced:
        _move_away(arrival, name, done)
        if name == arrival.seal:
            fsync_path(target)
    folders = {(target / name).parent for name in (*arrival.made, *arrival.gone)}
    for name in waiting:
        if name == arrival.seal:
            _all_to_disk(folders)
        _move(new / name, target / name, done)
    _all_to_disk(folders)
    for folder in folders - {target}:
        with suppress(OSError):  # there is something in it
            folder.rmdir()


def files_below(folder: Path) -> tuple[str, ...]:
    """All files in a folder and those below, as paths in it with slashes, in order."""
    return tuple(sorted(file.relative_to(folder).as_posix() for file in folder.rglob("*") if file.is_file()))


def backup_name(file: Path) -> Path:
    """The name beside a file under which it is kept where it is not to be replaced."""
    for number in itertools.count(1):
        other = file.with_stem(f"{file.stem} (changed{'' if number == 1 else f' {number}'})")
        if not os.path.lexists(other):
            return other
    raise AssertionError("numbers have no end")


def roll_back(arrival: Commit, done: Moves) -> None:
    """Take moves back, the last first, also one that was interrupted.

    Raises:
        OSError: One cannot be taken back; those before it stay in `done`.
    """
    while done:
        source, destination = done[-1]
        if not os.path.lexists(source) and os.path.lexists(destination):
            source.parent.mkdir(parents=True, exist_ok=True)
            os.replace(destination, source)
        if destination.parent != arrival.target:
            with suppress(OSError):  # there is something else in it
                destination.parent.rmdir()
        done.pop()


def clean_up(arrival: Commit) -> None:
    """Remove all that is hidden of a set, the paper first: what is left then is nothing but rubbish."""
    for file in (arrival.paper, arrival.draft):
        file.unlink(missing_ok=True)
    for folder in (arrival.new, arrival.old):
        shutil.rmtree(folder, ignore_errors=True)


def _move_away(arrival: Commit, name: str, done: Moves) -> None:
    """Make room for a file of the set, or remove one that it lacks."""
    there = arrival.target / name
    if not there.is_file() and not there.is_symlink():
        return
    if name in arrival.aside:
        kept = arrival.target / arrival.aside[name]
        _move(there, backup_name(there) if os.path.lexists(kept) else kept, done)
    else:
        _move(there, arrival.old / name, done)


def _move(source: Path, destination: Path, done: Moves) -> None:
    destination.parent.mkdir(parents=True, exist_ok=True)
    done.append((source, destination))  # before: an interruption may come right after the move
    os.replace(source, destination)


def _is_inside(name: Any) -> bool:
    way = PureWindowsPath(name)  # which reads both kinds of slash
    return not way.anchor and ".." not in way.parts and bool(way.name)


def _all_to_disk(folders: Iterable[Path]) -> None:
    for folder in folders:
        if folder.is_dir():
            fsync_path(folder)
