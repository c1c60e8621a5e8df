"""JSON objects whose fields are inherited from several files, each field with its source.

Overriding is JSON Merge Patch (RFC 7396): objects are merged field by field, everything else is replaced,
and null removes an inherited field. Fields whose names begin with `//` are comments.
"""

import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import islice
from math import isfinite
from typing import Any

from ..errors import InputError, shown

COMMENT_PREFIX = "//"
_FILE = re.compile(r"\.jsonl?(, line \d+)?$", re.ASCII)
PLACED = ("height_m", "tilt_deg", "roll_deg", "distance_m")
"""Fields that together say how a camera stands."""
ALTERNATIVES = ((("segments_m",), ("height_m",)), (("matrix_world",), ("matrix_world_frames",), PLACED))
"""The groups of a row say the same: the nearer one counts, whichever it is."""


class InheritedFields(dict[str, Any]):
    """The fields of an object after inheritance, and the source of each for sentences."""

    def __init__(self) -> None:
        super().__init__()
        self.sources: dict[str, str] = {}
        """Location of the object that gives each field, by name."""

    def overridden_by(self, patch: Mapping[str, Any], location: str) -> "InheritedFields":
        """These fields with a nearer object merged over them."""
        merged = InheritedFields()
        merged.update(self)
        merged.sources.update(self.sources)
        dropped: list[str] = []
        for groups in ALTERNATIVES:
            for group in groups:
                if any(patch.get(name) is not None for name in group):
                    others = (name for each in groups if each != group for name in each)
                    dropped += [name for name in others if name not in patch]
        dropped += [name for name, value in patch.items() if value is None and name in self]
        for name in dropped:
            merged.pop(name, None)
            merged.sources.pop(name, None)
        for name, value in patch.items():
            if name.startswith(COMMENT_PREFIX) or (value is None and name in self):
                continue
            merged.sources[name] = location
            if isinstance(value, Mapping):
                inherited = self.get(name)
                base = inherited if isinstance(inherited, InheritedFields) else InheritedFields()
                merged[name] = base.overridden_by(value, child_location(location, name))
            else:
                merged[name] = value
        return merged


def child_location(location: str, name: str) -> str:
    """The location of an object in a field of another: `take.json: camera`, then `take.json: camera.lens`."""
    return f"{location}: {name}" if _FILE.search(location) else f"{location}.{name}"


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
        # Among the first hundred names: comparing thousands takes long.
        names = [each for each in islice(self.values, 100) if isinstance(each, str)]
        close = get_close_matches(name, names, n=1, cutoff=0.6)
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


def is_number(value: Any) -> bool:
    """Whether a value of JSON is a finite number; whole ones may be larger than a float can be."""
    if isinstance(value, bool):
        return False
    return isinstance(value, int) or (isinstance(value, float) and isfinite(value))
