"""The end of a process in which Blender is a Python module."""

import os
import shutil
import sys
from contextlib import suppress

GLTF = "io_scene_gltf2.blender."
"""Beginning of the modules that glTF's importer and exporter load when they run."""
FIXED_IN = (5, 0)


def end_process(status: int) -> None:
    """End the process at once where it would wait for ever; else return.

    Blender 4.5 as a Python module may hang at its exit once it has read or written glTF.
    """
    blender = sys.modules.get("bpy")
    if blender is None or blender.app.binary_path or blender.app.version >= FIXED_IN:
        return
    if not any(name.startswith(GLTF) for name in list(sys.modules)):
        return
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError, AttributeError):
            stream.flush()
    shutil.rmtree(blender.app.tempdir, ignore_errors=True)
    os._exit(status)
