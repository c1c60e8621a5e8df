"""The wheels that Blender lacks, pinned, downloaded into wheels/ once, and packed as they come.

Blender's manual asks for wheels as the package index has them: nothing is taken out of them.
"""

import json
import os
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

from packaging.requirements import Requirement

from .builds import Build

ROOT = Path(__file__).resolve().parents[2]
WHEELS = ROOT / "wheels"

# Blender ships numpy, and a second numpy would clash.
BINARY_INTERFACES = {
    "scipy": "cp{python}",  # a wheel for each Python
    "opencv-python-headless": "abi3",  # one wheel for every Python
    "onnxruntime": "cp{python}",
    "threadpoolctl": "none",  # pure Python
    "c3d": "none",
}
"""Distributions that Blender lacks, and which of their wheels is taken."""
TAGS = {
    "linux-x64": ("manylinux_2_28_x86_64", "manylinux_2_27_x86_64", "manylinux2014_x86_64"),
    "windows-x64": ("win_amd64",),
    "macos-arm64": ("macosx_13_0_arm64", "macosx_12_0_arm64"),
}


def wheels_of(build: Build) -> list[Path]:
    """The wheels of one zip, downloaded if missing."""
    python = build.series.python.replace(".", "")
    requirements = pins(build.series.python)
    return [
        download(requirements[name], build.platform, python, interface.format(python=python))
        for name, interface in BINARY_INTERFACES.items()
    ]


def pins(python: str) -> dict[str, str]:
    """Pinned requirements for a Python (`3.11`) by distribution: {"scipy": "scipy==..."}."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    lines = project["dependencies"] + project["optional-dependencies"]["dev"]
    wanted = [Requirement(line) for line in lines if "==" in line.partition(";")[0]]
    here = {"python_version": python}
    return {
        one.name: f"{one.name}{one.specifier}"
        for one in wanted
        if one.marker is None or one.marker.evaluate(here)
    }


def download(requirement: str, platform: str, python: str, interface: str) -> Path:
    """The wheel of one requirement for one platform, Python (`311`) and binary interface."""
    record = WHEELS / f"{requirement}-{platform}-{interface}.json"  # the file's name, which pip knows
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
        if f"-{interface}-" not in wheel.name:
            raise SystemExit(f"{requirement} for {platform}: got {wheel.name}, wanted one for {interface}")
        target = WHEELS / wheel.name
        os.replace(wheel, target)
    record.write_text(json.dumps(target.name))
    return target
