"""Files of one format in some folders, found by name; those that cannot be read, with the reason."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Generic, TypeVar

from ..errors import InputError, shown
from .fields import listed
from .json_file import json_files, read_json
from .records import Record

R = TypeVar("R", bound=Record)
E = TypeVar("E", bound="Registered[Any]")


@dataclass(frozen=True)
class Registered(Generic[R]):
    """A file in a registered folder."""

    path: Path
    content: R | None  # what it holds; None if the file is invalid
    problem: str = ""  # the sentence of the error that makes it invalid

    @property
    def title(self) -> str:
        """The title of what it holds; an invalid file's name."""
        return self.path.name if self.content is None else str(getattr(self.content, "title"))  # noqa: B009

    @property
    def valid(self) -> R:
        """What the file holds; raises its `InputError` where it is invalid."""
        if self.content is None:
            raise InputError(self.problem)
        return self.content


def registered_files(
    folders: Sequence[Path],
    record: type[R],
    largest_bytes: int,
    key: Callable[[R], str],
    version: Callable[[R], int] = lambda _content: 0,
) -> tuple[Registered[R], ...]:
    """All files of a format in some folders, in order of title; missing folders count as empty.

    Of several with one key only the one in the earliest folder is registered, and within a folder the one of
    the highest version, else the first by file name; the others are available by path only.
    """
    found: dict[str, Registered[R]] = {}
    broken: list[Registered[R]] = []
    for folder in folders:
        here: dict[str, Registered[R]] = {}
        for path in json_files(folder):
            try:
                value = read_json(path, largest_bytes)
                schema = value.get("schema")
                if isinstance(schema, str) and schema.startswith("keymark-") and schema != record.SCHEMA:
                    continue  # another of Keymark's formats, which may lie in the same folder
                entry = Registered(path, record.from_json(value, str(path)))
            except InputError as error:
                broken.append(Registered(path, None, str(error)))
                continue
            name = key(entry.valid)
            if name not in here or version(entry.valid) > version(here[name].valid):
                here[name] = entry
        found = here | found
    return tuple(sorted([*found.values(), *broken], key=lambda entry: (entry.title.casefold(), entry.path)))


def find_registered(
    text: str,
    entries: Sequence[E],
    names: Callable[[E], Sequence[str]],
    fold: Callable[[str], str],
    what: str,
) -> E:
    """The file that has a name, as far as people can tell names apart, which `fold` makes equal.

    Valid ones come first, then those with an earlier of their names: a damaged file may have any name, and a
    stranger's file any title. Where there is none, the error says which there are.
    """
    wanted = fold(text)
    ranks = [(entry, [fold(name) for name in names(entry)]) for entry in entries]
    named = [(entry.content is None, known.index(wanted), entry) for entry, known in ranks if wanted in known]
    if named:
        return min(named, key=lambda each: each[:2])[2]
    known = [names(entry)[0] for entry in entries if entry.content is not None]
    close = get_close_matches(text[:100], known, n=1, cutoff=0.6)
    hint = f" (is {shown(close[0])} meant?)" if close else ""
    raise InputError(
        f"there is no {what} {shown(text)}{hint}; known are {listed(known) or 'none'}, "
        "and the path of a file ends in .json"
    )
