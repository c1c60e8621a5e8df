"""Script that lets Blender's own Rigify generate its basic human, with the shipped skin on it, into a .blend.

Usage: generate_rigify_human.py FILE, in a Python that has Blender as a module; or in Blender after `--`.
Run it in a process of its own: one that has used Rigify may hang when it ends as usual (seen with Blender 4.5
as a module), so this one ends at once.
"""

import os
import sys
import traceback
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

import bpy

ROOT = Path(__file__).resolve().parents[2]


def load() -> Any:
    """The module that the button in Blender uses too; Keymark is loaded, not enabled."""
    spec = spec_from_file_location("keymark", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)])
    assert spec is not None and spec.loader is not None
    sys.modules["keymark"] = module_from_spec(spec)
    spec.loader.exec_module(sys.modules["keymark"])
    return import_module("keymark.operators.bridge.character.rigify_human")


def main(path: str) -> int:
    """Generate and save; returns the exit status."""
    try:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        rigify_human = load()
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
