"""A shoot: the takes below a folder, or those of a list."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..take.conversion_settings import NO_SETTINGS, ConversionSettings
from ..take.description import Description, describe, effective_settings

MOST_TAKES = 100_000


@dataclass(frozen=True, eq=False)
class ShootTake:
    """One take of a shoot; none of its files has been read yet."""

    name: str
    """Its path from the shoot's folder, with slashes, without a clip's ending; also that of its results."""
    path: Path
    """The take's folder, or a bare clip."""
    overrides: Mapping[str, Any] | None = None
    """Fields in a line of a list, which override all files."""
    overrides_location: str = ""
    """Location of these fields, for sentences."""

    def describe(self) -> Description:
        """Merge all files that describe the take.

        Raises:
            InputError: A file is unusable.
        """
        return describe(self.path, self.overrides, self.overrides_location)

    def settings(
        self, description: Description, defaults: ConversionSettings = NO_SETTINGS
    ) -> ConversionSettings:
        """The settings of its conversion; `defaults` for what the description leaves out."""
        return effective_settings(description, defaults)


@dataclass(frozen=True, eq=False)
class Shoot:
    """Takes that are converted together."""

    path: Path
    """The folder, the list, or the one clip."""
    takes: tuple[ShootTake, ...]
    """In the order of their names, each name once."""

    @property
    def folder(self) -> Path:
        """The folder that the takes' names are relative to."""
        return self.path if self.path.is_dir() else self.path.parent


def part_of(takes: Collection[ShootTake], part: int, parts: int) -> list[ShootTake]:
    """The share of one of several machines: every `parts`-th take, beginning with the `part`-th, from 1."""
    return [take for index, take in enumerate(takes) if index % parts == part - 1]
