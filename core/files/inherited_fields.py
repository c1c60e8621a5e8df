"""JSON objects whose fields are inherited from several files, each field with its source.

Overriding is JSON Merge Patch (RFC 7396): objects are merged field by field, everything else is replaced,
and null removes an inherited field. Fields whose names begin with `//` are comments.
"""

import re
from collections.abc import Mapping
from typing import Any

COMMENT_PREFIX = "//"
_FILE = re.compile(r"\.jsonl?(, line \d+)?$", re.ASCII)
PLACED = ("height_m", "tilt_deg", "roll_deg", "distance_m")
"""Fields that together say how a camera stands."""
ALTERNATIVES = (
    (("segments_m",), ("height_m",)),
    (("matrix_world",), ("matrix_world_frames",), PLACED),
)
"""The groups of a row say the same: the nearer one counts, whichever it is."""


class InheritedFields(dict[str, Any]):
    """The fields of an object after inheritance, and the source of each for sentences."""

    def __init__(self) -> None:
        super().__init__()
        self.sources: dict[str, str] = {}
        """Location of the object that gives each field, by name."""

    def overridden_by(self, patch: Mapping[str, Any], location: str) -> "InheritedFields":
        """These fields with a nearer object merged over them.

        Args:
            patch: The nearer object.
            location: Where it stands: a file, and the path to the object in it.
        """
        merged = InheritedFields()
        merged.update(self)
        merged.sources.update(self.sources)
        for groups in ALTERNATIVES:
            for group in groups:
                if all(patch.get(name) is None for name in group):
                    continue
                for other in (name for each in groups if each != group for name in each):
                    if other not in patch:
                        merged._drop(other)
        for name, value in patch.items():
            if name.startswith(COMMENT_PREFIX):
                continue
            if value is None and name in self:
                merged._drop(name)
                continue
            merged.sources[name] = location
            if isinstance(value, Mapping):
                inherited = self.get(name)
                base = inherited if isinstance(inherited, InheritedFields) else InheritedFields()
                merged[name] = base.overridden_by(value, child_location(location, name))
            else:
                merged[name] = value
        return merged

    def _drop(self, name: str) -> None:
        self.pop(name, None)
        self.sources.pop(name, None)


def child_location(location: str, name: str) -> str:
    """The location of an object in a field of another: `take.json: camera`, then `take.json: camera.lens`."""
    return f"{location}: {name}" if _FILE.search(location) else f"{location}.{name}"
