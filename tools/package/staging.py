"""What one zip is packed from: the tree's own files, its wheels, and a manifest that says whom it is for."""

import json
import shutil
import subprocess
import tomllib
from pathlib import Path

from .builds import Build
from .wheels import ROOT, wheels_of

MANIFEST = "blender_manifest.toml"
MODELS = [f"presets/models/{part}_landmark.onnx" for part in ("pose", "face", "hand")]
"""The networks, which git does not know."""


def manifest_version() -> str:
    """The version of the tree."""
    version: str = tomllib.loads((ROOT / MANIFEST).read_text(encoding="utf-8"))["version"]
    return version


def stage(folder: Path, build: Build, version: str) -> None:
    """Copy the tree into `folder`, with the networks, the wheels of one zip, and a manifest for it."""
    for name in tracked_files():
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, target)
    for model in MODELS:
        if not (ROOT / model).is_file():
            raise SystemExit(f"{model} is missing: run tools/fetch_model.py.")
        shutil.copyfile(ROOT / model, folder / model)
    wheels = sorted(wheels_of(build))
    (folder / "wheels").mkdir()
    for wheel in wheels:
        (folder / "wheels" / wheel.name).symlink_to(wheel)
    manifest = folder / MANIFEST
    fields = {
        "version": version,
        "blender_version_min": build.series.first,
        "blender_version_max": build.series.end,
        "platforms": [build.platform],
        "wheels": [f"./wheels/{wheel.name}" for wheel in wheels],
    }
    manifest.write_text(with_fields(manifest.read_text(encoding="utf-8"), fields), encoding="utf-8")


def with_fields(manifest: str, fields: dict[str, str | list[str]]) -> str:
    """A manifest with these fields in place of its own, before its tables."""
    lines = manifest.splitlines()
    end = next((number for number, line in enumerate(lines) if line.startswith("[")), len(lines))
    kept = [line for line in lines[:end] if line.split("=")[0].strip() not in fields]
    while kept and not kept[-1]:
        kept.pop()
    given = [f"{name} = {json.dumps(value)}" for name, value in fields.items()]
    return "\n".join([*kept, *given, "", *lines[end:]]) + "\n"


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
