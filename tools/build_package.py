"""Build the extension's zips into dist/, one a platform, with the wheels that Blender lacks.

Usage: build_package.py [--platform linux-x64] ... [--tool blender_ext.py]. Only files known to git are
packed, less the manifest's exclusions. Wheels are downloaded into wheels/ once. Blender's own
`blender_ext.py` packs and validates; by default that of the bpy module of the running Python.
"""

import argparse
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WHEELS = ROOT / "wheels"
DIST = ROOT / "dist"

# Distributions that Blender lacks; it ships numpy, and a second numpy would clash.
COMPILED = "scipy"  # a wheel for each Python
STABLE = "opencv-python-headless"  # one wheel for every Python (abi3)
PURE = "threadpoolctl"  # one wheel for everything
PYTHONS = {"linux-x64": ("311", "313", "314"), "windows-x64": ("311", "313"), "macos-arm64": ("311", "313")}
# 314: Debian's own Blender, which refuses packages with wheels of other Pythons only.
TAGS = {
    "linux-x64": ("manylinux_2_28_x86_64", "manylinux_2_27_x86_64", "manylinux2014_x86_64"),
    "windows-x64": ("win_amd64",),
    "macos-arm64": ("macosx_13_0_arm64", "macosx_12_0_arm64"),
}


def pins() -> dict[str, str]:
    """The pinned requirements of pyproject.toml by distribution: {"scipy": "scipy==..."}."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return {line.split("==")[0]: line for line in project["dependencies"] if "==" in line}


def wheels_for(platform: str) -> list[Path]:
    """The wheels of one platform, downloaded into wheels/ if missing."""
    requirement = pins()
    found = [download(requirement[STABLE], platform, PYTHONS[platform][0], "abi3")]
    found.append(download(requirement[PURE], platform, PYTHONS[platform][0], "none"))
    for python in PYTHONS[platform]:
        found.append(download(requirement[COMPILED], platform, python, f"cp{python}"))
    return found


def download(requirement: str, platform: str, python: str, abi: str) -> Path:
    """The wheel of one requirement for one platform, Python and binary interface."""
    record = WHEELS / f"{requirement}-{platform}-{abi}.json"  # records the file's name, which only pip knows
    if record.is_file() and (WHEELS / json.loads(record.read_text())).is_file():
        return WHEELS / json.loads(record.read_text())
    WHEELS.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=WHEELS) as folder:
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check"]
        command += ["--only-binary=:all:", "--no-deps", "--dest", folder, "--implementation", "cp"]
        command += ["--python-version", python, "--abi", f"cp{python}", "--abi", "abi3", "--abi", "none"]
        for tag in TAGS[platform]:
            command += ["--platform", tag]
        subprocess.run([*command, requirement], check=True)
        (wheel,) = Path(folder).glob("*.whl")
        if f"-{abi}-" not in wheel.name:
            raise SystemExit(f"{requirement} for {platform}: got {wheel.name}, wanted one for {abi}")
        target = WHEELS / wheel.name
        os.replace(wheel, target)
    record.write_text(json.dumps(target.name))
    return target


def tracked_files() -> list[str]:
    """Files of the tree tracked by git or untracked and not ignored by .gitignore."""
    command = [
        "git",
        "-c",
        "safe.directory=*",
        "ls-files",
        "-z",
        "--cached",
        "--others",
        "--exclude-standard",
    ]
    listing = subprocess.run(command, cwd=ROOT, check=True, capture_output=True).stdout.decode()
    return sorted({name for name in listing.split("\0") if name and (ROOT / name).is_file()})


def stage(folder: Path, platforms: list[str]) -> None:
    """Copy the tree into `folder`, with the wheels and a manifest that lists them for `platforms`."""
    for name in tracked_files():
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, target)
    wheels = sorted({wheel for platform in platforms for wheel in wheels_for(platform)})
    (folder / "wheels").mkdir()
    for wheel in wheels:
        (folder / "wheels" / wheel.name).symlink_to(wheel)
    manifest = folder / "blender_manifest.toml"
    lines = manifest.read_text(encoding="utf-8").splitlines()
    at = next(number for number, line in enumerate(lines) if line.startswith("platforms"))
    lines[at] = f"platforms = {json.dumps(platforms)}"
    lines.insert(at + 1, f"wheels = {json.dumps([f'./wheels/{wheel.name}' for wheel in wheels])}")
    manifest.write_text("\n".join(lines) + "\n", encoding="utf-8")


def tool_of_this_python() -> Path:
    """The `blender_ext.py` of the bpy module, found without importing Blender."""
    module = importlib.util.find_spec("bpy")
    if module is None or module.origin is None:
        raise SystemExit("No bpy module beside this Python: name Blender's blender_ext.py with --tool.")
    tools = sorted(Path(module.origin).parent.rglob("addons_core/bl_pkg/cli/blender_ext.py"))
    if not tools:
        raise SystemExit(f"No blender_ext.py below {Path(module.origin).parent}: name it with --tool.")
    return tools[-1]


def main(arguments: list[str]) -> int:
    """Build and validate; print the paths of the zips; return the exit status."""
    parser = argparse.ArgumentParser(description="Build the extension's zips into dist/.")
    parser.add_argument(
        "--platform", action="append", choices=sorted(PYTHONS), help="default: every platform"
    )
    parser.add_argument("--tool", type=Path, help="Blender's blender_ext.py")
    options = parser.parse_args(arguments)
    platforms = options.platform or list(PYTHONS)
    blender_ext = [sys.executable, str(options.tool or tool_of_this_python())]
    DIST.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=DIST) as temporary:
        source, output = Path(temporary, "source"), Path(temporary, "output")
        source.mkdir()
        output.mkdir()
        stage(source, platforms)
        build = ["build", "--split-platforms", "--source-dir", str(source), "--output-dir", str(output)]
        subprocess.run([*blender_ext, *build], check=True, stdout=sys.stderr)
        for package in sorted(output.glob("*.zip")):
            subprocess.run([*blender_ext, "validate", str(package)], check=True, stdout=sys.stderr)
            os.replace(package, DIST / package.name)
            print(DIST / package.name)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
