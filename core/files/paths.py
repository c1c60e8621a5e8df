"""Absolute paths, with and without their symbolic links."""

import os
from pathlib import Path


def absolute_path(path: Path) -> Path:
    """An absolute path without `..`: that of `/day1/../day2` has no parent `day1`."""
    return Path(os.path.realpath(path)) if ".." in path.parts else path.absolute()


def real_path(path: Path) -> Path:
    """An absolute path, links resolved, that begins with one slash: two have a meaning in Blender."""
    real = os.path.realpath(path)
    return Path("/" + real.lstrip("/") if real.startswith("//") else real)
