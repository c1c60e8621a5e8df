# ruff: noqa: D102
"""Kinds of values of JSON: each checks a value, converts it, and says in one sentence what it must be."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any, NoReturn

import numpy as np

from ..arrays import Array
from ..errors import InputError, shown
from .fields import Fields, child_location, is_number, listed
from .paths import is_control_character

_PLAIN = re.compile(r"[\w.-]{1,60}", re.ASCII)
"""A name that stands in sentences without quotation marks."""
LONGEST_PATH, LONGEST_NAME_BYTES = 1000, 255
"""Characters of a path, and bytes of each name in it, as file systems have it."""
INSIDE = r"^(?![\\/])(?![A-Za-z]:)(?!(.*[\\/])?\.\.([\\/]|$)).*\S"
"""What schemas can say of a path that stays inside its folder."""


def refuse(where: str, name: str, value: Any, valid: str) -> NoReturn:
    """Say in one sentence that a value is not what it must be."""
    raise InputError(f"{where}: {name} is {'null' if value is None else shown(value)}; it must be {valid}")


class Kind:
    """What a value of JSON may be."""

    valid: str
    """Follows "it must be" in sentences."""

    def read(self, value: Any, where: str, name: str) -> Any:
        """Check a value and convert it; `where` is the object's location and `name` the field's name."""
        raise NotImplementedError

    def write(self, value: Any) -> Any:
        """The value as JSON; the inverse of `read`."""
        return value


@dataclass(frozen=True)
class Number(Kind):
    """A number from `low` to `high`, both included."""

    low: float
    high: float
    unit: str = ""
    decimals: int | None = None
    """Decimals that are written; None for all."""

    @property
    def valid(self) -> str:  # type: ignore[override]
        return f"a number from {self.low:g} to {self.high:g}{self.unit and ' ' + self.unit}"

    def read(self, value: Any, where: str, name: str) -> float:
        if not is_number(value) or not self.low <= value <= self.high:
            refuse(where, name, value, self.valid)
        return float(value)

    def write(self, value: float) -> float:
        return value if self.decimals is None else round(float(value), self.decimals) + 0.0


@dataclass(frozen=True)
class Whole(Kind):
    """A whole number from `low` to `high`; 3.0 is one too."""

    low: int
    high: int

    @property
    def valid(self) -> str:  # type: ignore[override]
        return f"a whole number from {self.low} to {self.high}"

    def read(self, value: Any, where: str, name: str) -> int:
        if not is_number(value) or value != int(value) or not self.low <= value <= self.high:
            refuse(where, name, value, self.valid)
        return int(value)


@dataclass(frozen=True)
class Flag(Kind):
    """True or false."""

    valid: str = "true or false"

    def read(self, value: Any, where: str, name: str) -> bool:
        if not isinstance(value, bool):
            refuse(where, name, value, self.valid)
        return value


@dataclass(frozen=True)
class Text(Kind):
    """A text that is not blank."""

    longest: int
    valid: str = ""
    pattern: str = r"\S"
    """A regular expression, of Python and JavaScript, that is found in it."""
    one_line: bool = False
    """Whether control characters are refused."""
    fault: Callable[[str], str] = lambda text: ""
    """What else is wrong with it, to follow "it"; empty for nothing."""
    empty: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "valid", self.valid or f"a text of at most {self.longest} characters")

    def read(self, value: Any, where: str, name: str) -> str:
        if self.empty and value == "":
            return ""
        if not isinstance(value, str) or len(value) > self.longest:
            refuse(where, name, value, self.valid)
        fault = self.fault(value)
        if fault:
            raise InputError(f"{where}: {name} is {shown(value)}; it {fault}")
        odd = self.one_line and any(map(is_control_character, value))
        if odd or not value.strip() or not re.search(self.pattern, value):
            refuse(where, name, value, self.valid)
        return value


@dataclass(frozen=True)
class PathInside(Text):
    """A relative path that stays inside a folder."""

    def read(self, value: Any, where: str, name: str) -> Any:
        return Path(super().read(value, where, name))

    def write(self, value: Path) -> str:
        return value.as_posix()


@dataclass(frozen=True)
class Anything(Kind):
    """Any value, which is checked later."""

    valid: str

    def read(self, value: Any, where: str, name: str) -> Any:
        return value


@dataclass(frozen=True)
class Choice(Kind):
    """One of some texts."""

    names: tuple[str, ...]
    makes: Callable[[str], str] = str
    """What is made of a text: a member of the enumeration that declares the choice."""

    @property
    def valid(self) -> str:  # type: ignore[override]
        return f"one of {listed(self.names)}"

    def read(self, value: Any, where: str, name: str) -> str:
        if not isinstance(value, str) or value not in self.names:
            refuse(where, name, value, self.valid)
        return self.makes(value)

    def write(self, value: Any) -> str:
        return str(value)


@dataclass(frozen=True)
class Nullable(Kind):
    """Something, or null."""

    item: Kind

    @property
    def valid(self) -> str:  # type: ignore[override]
        return f"{self.item.valid}, or null"

    def read(self, value: Any, where: str, name: str) -> Any:
        return None if value is None else self.item.read(value, where, name)

    def write(self, value: Any) -> Any:
        return None if value is None else self.item.write(value)


@dataclass(frozen=True)
class Never(Kind):
    """A field of other records of the kind, which must be left out."""

    valid: str

    def read(self, value: Any, where: str, name: str) -> NoReturn:
        raise InputError(f"{where}: {self.valid}")


@dataclass(frozen=True)
class Items(Kind):
    """A list of `least` to `most` items, a tuple once it is read."""

    of_what: str
    """The items, in the plural."""
    least: int
    most: int
    whole: str = ""
    """What the whole list must be; else a sentence names the item that is wrong."""
    unique: str = ""
    """What an item is, in the singular, where each may stand only once."""
    item: Kind = field(default_factory=Kind)
    """By default that of the annotated type."""

    @property
    def valid(self) -> str:  # type: ignore[override]
        number = f"{self.least} to {self.most}" if self.least else f"at most {self.most}"
        return self.whole or f"a list of {number} {self.of_what}"

    def read(self, value: Any, where: str, name: str) -> tuple[Any, ...]:
        if not isinstance(value, list):
            refuse(where, name, value, self.valid)
        if not self.least <= len(value) <= self.most:
            if self.whole:
                refuse(where, name, value, self.valid)
            raise InputError(f"{where}: {name} has {len(value)} of them; it must be {self.valid}")
        try:
            items = [self.item.read(item, where, f"{name}[{index}]") for index, item in enumerate(value)]
        except InputError:
            if self.whole:
                refuse(where, name, value, self.valid)
            raise
        if self.unique:
            twice = first_twice(items, name, self.unique)
            if twice:
                raise InputError(f"{where}: {twice}")
        return tuple(items)

    def write(self, value: Sequence[Any]) -> list[Any]:
        return [self.item.write(item) for item in value]


@dataclass(frozen=True)
class ByName(Kind):
    """An object of items of one kind, by name."""

    of_what: str
    most: int = 0
    """Most items; of no meaning where the names are known."""
    names: tuple[str, ...] = ()
    """All valid names, in their order; () for any."""
    empty: str = ""
    """What an empty object lacks; "" where it may be empty."""
    needs: tuple[str, ...] = ()
    strict: bool = True
    """Whether other than the known names are refused."""
    key: Kind | None = None
    item: Kind = field(default_factory=Kind)
    exceptions: Mapping[str, Kind] = field(default_factory=dict, hash=False)
    """Kinds of the names that differ."""

    @property
    def valid(self) -> str:  # type: ignore[override]
        return f"an object of {self.of_what}"

    def read(self, value: Any, where: str, name: str) -> dict[str, Any]:
        if not isinstance(value, Mapping):
            refuse(where, name, value, self.valid)
        child = Fields(value, child_location(where, name))
        if self.names and self.strict:
            child.refuse_others(self.names)
        if not self.names and len(value) > self.most:
            raise InputError(f"{child.where} has {len(value)} {self.of_what}; at most {self.most} are read")
        if self.empty and not value:
            raise InputError(f"{child.where} is empty; {self.empty}")
        for key in self.needs:
            child.required(key, self.item.valid)
        if self.key is not None:
            for key in value:
                self.key.read(key, child.where, "a name")
        return {
            key: self.exceptions.get(key, self.item).read(
                value[key], child.source_of(key), key if _PLAIN.fullmatch(key) else shown(key)
            )
            for key in self.names or value
            if key in value
        }

    def write(self, value: Mapping[str, Any]) -> dict[str, Any]:
        return {key: self.item.write(value[key]) for key in self.names or value if key in value}


def read_field(fields: Fields, name: str, kind: Kind, otherwise: Any) -> Any:
    """The value of one field; `otherwise` where it is missing."""
    if not fields.has(name):
        return otherwise
    return kind.read(fields.values[name], fields.source_of(name), name)


def first_twice(items: Sequence[Any], name: str, what: str) -> str:
    """What of a list stands twice in it, as a clause that begins with the list's name; empty for nothing."""
    seen: set[Any] = set()
    for item in items:
        if item in seen:
            return f"{name} names the {what} {shown(item)} twice; each must stand once"
        seen.add(item)
    return ""


def safe_path(fields: Fields, name: str, folder: Path, valid: str) -> Path:
    """The path in a field, relative to a folder that it must not leave."""
    return folder / relative_path(valid).read(fields.required(name, valid), fields.source_of(name), name)


def relative_path(valid: str) -> PathInside:
    """The kind of a field that holds a path inside a folder; `valid` is what it must be, for the sentence."""

    def fault(text: str) -> str:
        path = PureWindowsPath(text)  # it reads both kinds of slash
        outside = PurePosixPath(text).is_absolute() or path.anchor or ".." in path.parts or path.name == ""
        longest = max((len(part.encode("utf-8", "surrogatepass")) for part in path.parts), default=0)
        return f"must be {valid}" if outside or longest > LONGEST_NAME_BYTES else ""

    return PathInside(LONGEST_PATH, valid, pattern=INSIDE, one_line=True, fault=fault)


def number_array(value: Any, *, nulls: bool = False) -> Array | None:
    """Nested lists of numbers as an array; None where they are none, or one is not finite.

    `nulls`: null may stand for a number, and becomes NaN.
    """
    try:
        items = np.asarray(value, dtype=object)  # as float64, numpy would convert text and truth values
    except ValueError:  # lists of several lengths
        return None
    kinds = set(map(type, items.ravel())) - ({type(None)} if nulls else set())
    if not all(issubclass(kind, int | float) and kind is not bool for kind in kinds):
        return None
    array = items.astype(np.float64)
    return array if nulls or np.isfinite(array).all() else None


@dataclass(frozen=True)
class NumberArray(Kind):
    """Nested lists of numbers, an array once they are read."""

    shape: tuple[int, ...]
    """Lengths of its axes; -1 for any."""
    limit: float
    null_rows: bool = False
    """Whether null may stand in place of a whole entry of the list; its numbers are NaN."""

    @property
    def valid(self) -> str:  # type: ignore[override]
        words = " x ".join("any number" if length < 0 else str(length) for length in self.shape)
        gaps = ", or null for an entry" if self.null_rows else ""
        return f"a list of numbers of shape {words}, each within {self.limit:g}{gaps}"

    def read(self, value: Any, where: str, name: str) -> Array:
        absent: list[int] = []
        if self.null_rows and isinstance(value, list):
            absent = [index for index, row in enumerate(value) if row is None]
            row = np.zeros(self.shape[1:]).tolist()
            value = [row if one is None else one for one in value] if absent else value
        array = number_array(value)
        if array is None or array.ndim != len(self.shape) or not np.all(np.abs(array) <= self.limit):
            refuse(where, name, value, self.valid)
        if any(length not in (-1, found) for length, found in zip(self.shape, array.shape, strict=True)):
            refuse(where, name, value, self.valid)
        array[absent] = np.nan
        return array
