"""JSON objects that inherit fields from others, each field knowing which file says it.

Merging is that of JSON Merge Patch (RFC 7396): objects are merged field by field, everything else is
replaced, and null takes an inherited field away. Fields whose names begin with `//` are comments.
"""

import re
from collections.abc import Mapping
from typing import Any

COMMENT = "//"
_FILE = re.compile(r"\.jsonl?(, line \d+)?$", re.ASCII)
ALTERNATIVES = (("segments_m", "height_m"), ("matrix_world", "matrix_world_frames"))
"""Of each pair one says what the other would: the nearer one counts, whichever it is."""


class Inherited(dict[str, Any]):
    """An object's fields, and for each the place of the object that says it, as sentences name it."""

    def __init__(self) -> None:
        super().__init__()
        self.places: dict[str, str] = {}

    def patched(self, patch: Mapping[str, Any], where: str) -> "Inherited":
        """These fields with a nearer object's over them.

        Args:
            patch: The nearer object.
            where: Its place: a file, and the way to the object in it.
        """
        merged = Inherited()
        merged.update(self)
        merged.places.update(self.places)
        for first, second in ALTERNATIVES:
            for name, other in ((first, second), (second, first)):
                if patch.get(name) is not None and other not in patch:
                    merged._drop(other)
        for name, value in patch.items():
            if name.startswith(COMMENT):
                continue
            if value is None and name in self:
                merged._drop(name)
                continue
            merged.places[name] = where
            if isinstance(value, Mapping):
                known = self.get(name)
                base = known if isinstance(known, Inherited) else Inherited()
                merged[name] = base.patched(value, child_place(where, name))
            else:
                merged[name] = value
        return merged

    def _drop(self, name: str) -> None:
        self.pop(name, None)
        self.places.pop(name, None)


def child_place(where: str, name: str) -> str:
    """The place of an object in a field of another: `take.json: camera`, then `take.json: camera.lens`."""
    return f"{where}: {name}" if _FILE.search(where) else f"{where}.{name}"
