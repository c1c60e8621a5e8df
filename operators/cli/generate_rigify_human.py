"""Script that lets Blender's own Rigify generate its basic human, with a simple body on it, into a .blend.

Usage: generate_rigify_human.py FILE, in a Python that has Blender as a module; or in Blender after `--`.
Run it in a process of its own: one that has used Rigify may hang when it ends as usual (seen with Blender 4.5
as a module), so this one ends at once.
"""

import os
import sys
import traceback
from importlib import import_module
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parents[1] / "bridge" / "character"))

rigify_human = import_module("rigify_human")
"""What the button in Blender uses too; Keymark itself is not loaded here."""


def main(path: str) -> int:
    """Generate and save; returns the exit status."""
    try:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        rigify_human.enable_rigify()
        rigify_human.add_rigify_human()
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
