"""What pyproject.toml cannot say: the version is the manifest's, and the repository root is the package."""

import tomllib
from pathlib import Path

from setuptools import find_packages, setup

ROOT = Path(__file__).parent
ROOMS = ["core", "core.*", "operators", "operators.*"]

manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
setup(
    version=manifest["version"],
    package_dir={"keymark": "."},
    packages=["keymark", *(f"keymark.{name}" for name in find_packages(str(ROOT), include=ROOMS))],
    package_data={
        "keymark": ["blender_manifest.toml", "presets/**/*"],
        "keymark.core.report": ["*.css"],
    },
    include_package_data=False,
)
