"""Script that opens an example, adds Rigify's human to its take by the operator twice, and saves a .blend.

Usage: _add_rigify_human.py FILE, in a Python that has Blender as a module; or in Blender after `--`.
"""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

from _boot import load_package  # noqa: E402
from _own_process import make_and_end  # noqa: E402


def make(path: str) -> None:
    """Open, add and save."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
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


if __name__ == "__main__":
    make_and_end(make)
