"""Script that opens an example, adds Rigify's human to its take by the operator twice, and saves a .blend.

Usage: _add_rigify_human.py FILE, in a Python that has Blender as a module; or in Blender after `--`. In a
process of its own, which ends at once: one that has used Rigify may hang when it ends as usual.
"""

import os
import sys
import traceback
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

from _boot import load_package  # noqa: E402


def main(path: str) -> int:
    """Open, add and save; returns the exit status."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    try:
        load_package().register()
        bpy.ops.keymark.open_example(example="AEROBIC")
        take = bpy.context.scene.keymark.takes[0]
        bpy.ops.keymark.add_character()  # an entry that waits for its armature
        bpy.context.scene.cursor.location = (3.0, 2.0, 1.0)
        bpy.context.view_layer.objects.active = take.armature
        bpy.ops.object.mode_set(mode="POSE")
        for _ in range(2):
            bpy.ops.keymark.add_rigify_human()
        bpy.ops.wm.save_as_mainfile(filepath=path, compress=True)
    except Exception:
        traceback.print_exc()
        return 1
    return 0


if __name__ == "__main__":
    status = main(sys.argv[-1])
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
