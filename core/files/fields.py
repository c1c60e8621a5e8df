"""Checked fields of a JSON object: each mistake is one sentence with file, field and value."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import islice
from math import isfinite
from typing import Any

from ..errors import InputError
from .inherited_fields import InheritedFields, child_location
from .json_file import shown


def listed(names: Iterable[str], most: int = 40) -> str:
    """Names separated by commas, for a sentence; a long list ends with the number of the rest."""
    names = list(names)
    rest = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + rest


@dataclass(frozen=True)
class Fields:
    """The fields of one JSON object, and its location for sentences.

    Every method that reads a field raises `InputError` where it is missing or not what it must be.
    """

    values: Mapping[str, Any]
    where: str
    """Location of the object, file and path in it: `TAKE/take.json: camera`. Inherited fields have their own,
    see `source_of`."""

    @classmethod
    def of(cls, value: Any, where: str) -> "Fields":
        """Take a value that must be an object."""
        if not isinstance(value, Mapping):
            raise InputError(f"{where} is {shown(value)}; it must be an object, {{...}}")
        return cls(value, where)

    def source_of(self, name: str) -> str:
        """Location of the object that gives a field: another than `where` for an inherited field."""
        sources = self.values.sources if isinstance(self.values, InheritedFields) else {}
        return sources.get(name, self.where)

    def has(self, name: str) -> bool:
        """Whether a field is present and not null."""
        return self.values.get(name) is not None

    def required(self, name: str, valid: str) -> Any:
        """The value of a field that must be present; `valid` says what it must be, for the sentence."""
        if self.has(name):
            return self.values[name]
        if name in self.values:
            raise InputError(f"{self.source_of(name)}: {name} is null; it must be {valid}")
        close = get_close_matches(name, self._first_names(), n=1, cutoff=0.6)
        hint = f" (is {shown(close[0])} meant to be it?)" if close else ""
        raise InputError(f"{self.where}: {name} is missing{hint}; it must be {valid}")

    def refuse_others(self, known: Collection[str]) -> None:
        """Refuse unknown fields: what they mean would be lost."""
        unknown = [name for name in self.values if name not in known]
        if unknown:
            close = get_close_matches(str(unknown[0])[:100], known, n=1, cutoff=0.6)
            hint = f" (is {shown(close[0])} meant?)" if close else ""
            raise InputError(
                f"{self.where} has the unknown field {shown(unknown[0])}{hint}; known are {listed(known)}"
            )

    def _first_names(self) -> list[str]:
        """The first hundred names, to find a mistyped one among; comparing thousands takes long."""
        return [name for name in islice(self.values, 100) if isinstance(name, str)]

    def child(self, name: str, valid: str) -> "Fields":
        """The object in a field."""
        value = self.required(name, valid)
        if not isinstance(value, Mapping):
            raise InputError(f"{self.source_of(name)}: {name} is {shown(value)}; it must be {valid}")
        return Fields(value, child_location(self.source_of(name), name))

    def number(self, name: str, low: float, high: float, unit: str = "") -> float:
        """A number from `low` to `high`."""
        valid = f"a number from {low:g} to {high:g}{unit and ' ' + unit}"
        value = self.required(name, valid)
        if not is_number(value) or not low <= value <= high:
            raise InputError(f"{self.source_of(name)}: {name} is {shown(value)}; it must be {valid}")
        return float(value)

    def integer(self, name: str, low: int, high: int) -> int:
        """A whole number from `low` to `high`; 3.0 is one too."""
        valid = f"a whole number from {low} to {high}"
        value = self.required(name, valid)
        if not is_number(value) or value != int(value) or not low <= value <= high:
            raise InputError(f"{self.source_of(name)}: {name} is {shown(value)}; it must be {valid}")
        return int(value)

    def check_version(self, newest: int) -> None:
        """Refuse the `schema_version` of a newer Keymark; `newest` is the highest that is read."""
        version = self.integer("schema_version", 1, 10**6)
        if version > newest:
            source = self.source_of("schema_version")
            raise InputError(
                f"{source}: schema_version is {version}, made by a newer Keymark; "
                f"this one reads up to {newest}"
            )

    def text(self, name: str, valid: str) -> str:
        """A text that is not empty."""
        value = self.required(name, valid)
        if not isinstance(value, str) or not value.strip():
            raise InputError(f"{self.source_of(name)}: {name} is {shown(value)}; it must be {valid}")
        return value

    def numbers(self, name: str, count: int, low: float, high: float, valid: str) -> tuple[float, ...]:
        """`count` numbers from `low` to `high`."""
        value = self.required(name, valid)
        usable = isinstance(value, list) and len(value) == count
        if not usable or not all(is_number(item) and low <= item <= high for item in value):
            raise InputError(f"{self.source_of(name)}: {name} is {shown(value)}; it must be {valid}")
        return tuple(float(item) for item in value)


def is_number(value: Any) -> bool:
    """Whether a value of JSON is a finite number; whole ones may be larger than a float can be."""
    if isinstance(value, bool):
        return False
    return isinstance(value, int) or (isinstance(value, float) and isfinite(value))
