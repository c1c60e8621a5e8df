"""Reading the fields of a JSON object: each mistake becomes one sentence with file, field and value."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import islice
from math import isfinite
from typing import Any

from ..errors import InputError
from .inherited_fields import Inherited, child_place
from .json_file import shown


def listed(names: Iterable[str], most: int = 40) -> str:
    """Names for a sentence, separated by commas; the rest of a long list is counted."""
    names = list(names)
    rest = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + rest


@dataclass(frozen=True)
class Fields:
    """The fields of one JSON object, and where it stands.

    Every method raises `InputError` where its field is missing or not what it must be.
    """

    values: Mapping[str, Any]
    where: str
    """File, and the way to the object in it: `TAKE/take.json: camera`. Inherited fields have their own, see
    `at`."""

    @classmethod
    def of(cls, value: Any, where: str) -> "Fields":
        """Take a value that must be an object."""
        if not isinstance(value, Mapping):
            raise InputError(f"{where} is {shown(value)}; it must be an object, {{...}}")
        return cls(value, where)

    def at(self, name: str) -> str:
        """The place of the object that says a field."""
        places = self.values.places if isinstance(self.values, Inherited) else {}
        return places.get(name, self.where)

    def has(self, name: str) -> bool:
        """Whether a field is there and not null."""
        return self.values.get(name) is not None

    def required(self, name: str, valid: str) -> Any:
        """The value of a field that must be there; `valid` says what it must be."""
        if self.has(name):
            return self.values[name]
        if name in self.values:
            raise InputError(f"{self.at(name)}: {name} is null; it must be {valid}")
        close = get_close_matches(name, self._first_names(), n=1, cutoff=0.6)
        hint = f" (is {shown(close[0])} meant to be it?)" if close else ""
        raise InputError(f"{self.where}: {name} is missing{hint}; it must be {valid}")

    def refuse_others(self, known: Collection[str]) -> None:
        """Refuse fields that are not known: what they mean would be lost."""
        unknown = [name for name in self.values if name not in known]
        if unknown:
            close = get_close_matches(str(unknown[0])[:100], known, n=1, cutoff=0.6)
            hint = f" (is {shown(close[0])} meant?)" if close else ""
            raise InputError(
                f"{self.where} has the unknown field {shown(unknown[0])}{hint}; known are {listed(known)}"
            )

    def _first_names(self) -> list[str]:
        """Enough of the names to find a mistyped one among; comparing thousands takes long."""
        return [name for name in islice(self.values, 100) if isinstance(name, str)]

    def child(self, name: str, valid: str) -> "Fields":
        """The object in a field."""
        value = self.required(name, valid)
        if not isinstance(value, Mapping):
            raise InputError(f"{self.at(name)}: {name} is {shown(value)}; it must be {valid}")
        return Fields(value, child_place(self.at(name), name))

    def number(self, name: str, low: float, high: float, unit: str = "") -> float:
        """A number from `low` to `high`."""
        valid = f"a number from {low:g} to {high:g}{unit and ' ' + unit}"
        value = self.required(name, valid)
        if not _is_number(value) or not low <= value <= high:
            raise InputError(f"{self.at(name)}: {name} is {shown(value)}; it must be {valid}")
        return float(value)

    def whole(self, name: str, low: int, high: int) -> int:
        """A whole number from `low` to `high`; 3.0 is one too."""
        valid = f"a whole number from {low} to {high}"
        value = self.required(name, valid)
        if not _is_number(value) or value != int(value) or not low <= value <= high:
            raise InputError(f"{self.at(name)}: {name} is {shown(value)}; it must be {valid}")
        return int(value)

    def check_version(self, newest: int) -> None:
        """Refuse what a newer Keymark has written, by its `schema_version`; `newest` is still read."""
        version = self.whole("schema_version", 1, 10**6)
        if version > newest:
            place = self.at("schema_version")
            raise InputError(
                f"{place}: schema_version is {version}, made by a newer Keymark; "
                f"this one reads up to {newest}"
            )

    def text(self, name: str, valid: str) -> str:
        """A text that is not empty."""
        value = self.required(name, valid)
        if not isinstance(value, str) or not value.strip():
            raise InputError(f"{self.at(name)}: {name} is {shown(value)}; it must be {valid}")
        return value

    def numbers(self, name: str, count: int, low: float, high: float, valid: str) -> tuple[float, ...]:
        """`count` numbers from `low` to `high`."""
        value = self.required(name, valid)
        usable = isinstance(value, list) and len(value) == count
        if not usable or not all(_is_number(item) and low <= item <= high for item in value):
            raise InputError(f"{self.at(name)}: {name} is {shown(value)}; it must be {valid}")
        return tuple(float(item) for item in value)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)
