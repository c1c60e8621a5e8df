"""Names of the Actions in a motion's file, read without importing it, so that a menu can offer them."""

import json
import re
import struct
from contextlib import suppress
from mmap import ACCESS_READ, mmap
from pathlib import Path

import bpy

from ....core.files.paths import real_path

LARGEST_BYTES = 2**26
"""Of the text of a glTF."""


def action_names(path: Path) -> list[str]:
    """Those of a .blend, glTF or VRM, and an FBX's takes; none of other files, or of a damaged one."""
    suffix = path.suffix.lower()
    with suppress(OSError, ValueError, KeyError, TypeError, AttributeError, struct.error):
        if suffix == ".blend":
            with bpy.data.libraries.load(str(real_path(path)), link=True) as (inside, _wanted):
                return list(inside.actions)
        if suffix == ".fbx":  # a name, then what it is of
            with path.open("rb") as file, mmap(file.fileno(), 0, access=ACCESS_READ) as whole:
                takes = re.findall(rb"([^\x00-\x1f]{1,200})\x00\x01AnimStack", whole)
            return list(dict.fromkeys(take.decode() for take in takes))
        if suffix in (".glb", ".gltf", ".vrm"):
            with path.open("rb") as file:
                size = LARGEST_BYTES
                if suffix != ".gltf":  # 12 bytes of header, then the length and the kind of the text
                    file.seek(12)
                    size, _ = struct.unpack("<I4s", file.read(8))
                text = json.loads(file.read(min(size, LARGEST_BYTES)))
            return [one["name"] for one in text.get("animations", []) if isinstance(one.get("name"), str)]
    return []
