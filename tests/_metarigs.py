"""Script that lets Blender's own Rigify add all its metarigs, and generate its full human, into a .blend.

Usage: _metarigs.py FILE, in a Python that has Blender as a module; or in Blender after `--`.
"""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

from _own_process import make_and_end  # noqa: E402

METARIGS = ("human", "basic_human", "horse", "wolf", "cat", "bird", "shark", "basic_quadruped")


def make(path: str) -> None:
    """Add, generate and save."""
    import addon_utils  # can be found once bpy is loaded

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    addon_utils.enable("rigify", default_set=True)
    for name in METARIGS:
        getattr(bpy.ops.object, f"armature_{name}_metarig_add")()
        metarig = bpy.context.object
        metarig.name = name
        if name == "human":
            bpy.ops.pose.rigify_generate()
            rig = next(one for one in bpy.data.objects if one.type == "ARMATURE" and one != metarig)
            rig.name = "generated"
    bpy.ops.wm.save_as_mainfile(filepath=path, compress=True)


if __name__ == "__main__":
    make_and_end(make)
