"""The zips there are: one for each Python that a Blender comes with, and each platform.

A compiled wheel fits one Python, and a Blender has one. So a zip for all of them would be twice as large.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Series:
    """The Blenders that share a Python."""

    name: str
    """As it stands in a zip's name, from which people choose."""
    python: str
    first: str
    """The earliest Blender, `blender_version_min`."""
    end: str
    """The Blender before which it ends, `blender_version_max`, which is excluded."""
    platforms: tuple[str, ...]
    """As Blender names them."""


@dataclass(frozen=True)
class Build:
    """One zip."""

    series: Series
    platform: str

    def name(self, version: str) -> str:
        """The zip's name, `keymark-0.1.0-blender_4.5_to_5.0-linux_x64.zip`."""
        return f"keymark-{version}-{self.series.name}-{self.platform.replace('-', '_')}.zip"


EVERYWHERE = ("linux-x64", "windows-x64", "macos-arm64")
# Blender changed its Python with 5.1. It breaks its interface with a first number only, so 6.0 is the end;
# should a Blender before that have another Python, it refuses the zip because of its wheels.
SERIES = (
    Series("blender_4.5_to_5.0", "3.11", "4.5.0", "5.1.0", EVERYWHERE),
    Series("blender_5.1_or_newer", "3.13", "5.1.0", "6.0.0", EVERYWHERE),
    # Blenders that distributions build use the system's own Python: Debian, Fedora and Arch.
    Series("distribution_blender_python_3.14", "3.14", "5.1.0", "6.0.0", ("linux-x64",)),
)
PYTHONS = tuple(series.python for series in SERIES)


def chosen(pythons: Sequence[str], platforms: Sequence[str]) -> Iterator[Build]:
    """The zips for these Pythons and platforms; none named means all."""
    for series in SERIES:
        for platform in series.platforms:
            if (not pythons or series.python in pythons) and (not platforms or platform in platforms):
                yield Build(series, platform)
