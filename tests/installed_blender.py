"""A Blender program and a folder that stands for its user's settings and extensions."""

import os
import subprocess
import zlib
from dataclasses import dataclass
from pathlib import Path
from zipfile import ZipFile


@dataclass(frozen=True)
class Blender:
    """A Blender with a user folder of its own."""

    command: tuple[str, ...]
    """The words that start it."""
    user: Path
    """The folder that stands for the user's settings and extensions."""

    def run(self, *arguments: str | Path, patience_s: float = 900.0) -> subprocess.CompletedProcess[str]:
        """Run it to its end with `arguments`, without a terminal; standard output and error are kept."""
        # The drawing library's cache is read by all who share it, and one can pull it away from another.
        own = {"BLENDER_USER_RESOURCES": str(self.user), "XDG_CACHE_HOME": str(self.user / "cache")}
        environment = {**os.environ, **own}
        words = [*self.command, *(str(argument) for argument in arguments)]
        return subprocess.run(
            words,
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=patience_s,
        )

    def install(self, package: Path) -> subprocess.CompletedProcess[str]:
        """Install and enable a zip of the extension."""
        return self.run(
            "--command", "extension", "install-file", "--repo", "user_default", "--enable", package
        )

    def changed_files(self, package: Path) -> set[str]:
        """Files in which the installed extension differs from its zip, but for Python's own cache."""
        folder = self.user / "extensions" / "user_default" / "keymark"
        with ZipFile(package) as zipped:
            packed = {item.filename: item.CRC for item in zipped.infolist() if not item.is_dir()}
        there = {
            file.relative_to(folder).as_posix(): zlib.crc32(file.read_bytes())
            for file in folder.rglob("*")
            if file.is_file() and "__pycache__" not in file.parts
        }
        return {name for name, _ in packed.items() ^ there.items()}
