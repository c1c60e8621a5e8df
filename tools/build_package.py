"""Build the extension's zips into dist/, one for each platform and Python that Blenders come with.

Usage: build_package.py [--platform linux-x64] ... [--python 3.13] ... [--version 0.1.1] [--tool FILE]. Only
files known to git are packed, less the manifest's exclusions. Blender's own `blender_ext.py` packs and
validates; by default that of the bpy module of the running Python.
"""

import argparse
import importlib.util
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from package.builds import EVERYWHERE, PYTHONS, Build, chosen
from package.staging import manifest_version, stage
from package.wheels import ROOT

DIST = ROOT / "dist"


def tool_of_this_python() -> Path:
    """The `blender_ext.py` of the bpy module, found without importing Blender."""
    module = importlib.util.find_spec("bpy")
    if module is None or module.origin is None:
        raise SystemExit("No bpy module beside this Python: name Blender's blender_ext.py with --tool.")
    tools = sorted(Path(module.origin).parent.rglob("addons_core/bl_pkg/cli/blender_ext.py"))
    if not tools:
        raise SystemExit(f"No blender_ext.py below {Path(module.origin).parent}: name it with --tool.")
    return tools[-1]


def tags_of(tool: Path) -> Path:
    """Blender's own list of tags, beside its tool."""
    return tool.parents[3] / "modules" / "_bpy_internal" / "extensions" / "tags.py"


def pack(build: Build, version: str, tool: Path) -> Path:
    """Build and validate one zip; return its path in dist/, where it appears whole or not at all."""
    blender_ext = [sys.executable, str(tool)]
    target = DIST / build.name(version)
    with tempfile.TemporaryDirectory(dir=DIST) as temporary:
        source, package = Path(temporary, "source"), Path(temporary, target.name)
        source.mkdir()
        stage(source, build, version)
        words = ["build", "--source-dir", str(source), "--output-filepath", str(package)]
        subprocess.run([*blender_ext, *words], check=True, stdout=sys.stderr)
        words = ["validate", "--valid-tags", str(tags_of(tool)), str(package)]
        subprocess.run([*blender_ext, *words], check=True, stdout=sys.stderr)
        os.replace(package, target)
    return target


def main(arguments: list[str]) -> int:
    """Build what is asked for, print the paths, and the sizes on standard error; return the exit status."""
    parser = argparse.ArgumentParser(description="Build the extension's zips into dist/.")
    parser.add_argument("--platform", action="append", choices=EVERYWHERE, help="by default all")
    parser.add_argument("--python", action="append", choices=PYTHONS, help="of Blender; by default all")
    parser.add_argument("--version", default=manifest_version(), help="by default that of the manifest")
    parser.add_argument("--tool", type=Path, help="Blender's blender_ext.py")
    options = parser.parse_args(arguments)
    builds = list(chosen(options.python or (), options.platform or ()))
    if not builds:
        parser.error("there is no zip of that Python for that platform")
    tool = options.tool or tool_of_this_python()
    DIST.mkdir(exist_ok=True)
    for build in builds:
        target = pack(build, options.version, tool)
        print(f"{target.stat().st_size / 1e6:.1f} MB: {target.name}", file=sys.stderr)
        print(target, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
