"""Script that lets Blender's own Rigify add all its metarigs, and generate its full human, into a .blend.

Usage: _metarigs.py FILE, in a Python that has Blender as a module; or in Blender after `--`. In a process of
its own, which ends at once: one that has used Rigify may hang when it ends as usual.
"""

import os
import sys
import traceback

import bpy

METARIGS = ("human", "basic_human", "horse", "wolf", "cat", "bird", "shark", "basic_quadruped")


def main(path: str) -> int:
    """Add, generate and save; returns the exit status."""
    import addon_utils  # can be found once bpy is loaded

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    addon_utils.enable("rigify", default_set=True)
    try:
        for name in METARIGS:
            getattr(bpy.ops.object, f"armature_{name}_metarig_add")()
            metarig = bpy.context.object
            metarig.name = name
            if name == "human":
                bpy.ops.pose.rigify_generate()
                rig = next(one for one in bpy.data.objects if one.type == "ARMATURE" and one != metarig)
                rig.name = "generated"
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
