"""A shoot: the takes below a folder, or those of a list."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..take.conversion_settings import NOTHING_CHOSEN, ConversionSettings
from ..take.description import Description, chosen_settings, describe


@dataclass(frozen=True, eq=False)
class ShootTake:
    """One take of a shoot, as it was found; nothing of it has been read yet."""

    name: str
    """Its way from the shoot's folder, with slashes, without a clip's ending; results lie under the same."""
    place: Path
    """The take's folder, or the clip."""
    nearest: Mapping[str, Any] | None = None
    """What a list says of it, which counts before all else."""
    said_in: str = ""
    """Where it says so, for sentences."""

    def describe(self) -> Description:
        """Gather what is said of it.

        Raises:
            InputError: A file is unusable.
        """
        return describe(self.place, self.nearest, self.said_in)

    def settings(
        self, description: Description, farther: ConversionSettings = NOTHING_CHOSEN
    ) -> ConversionSettings:
        """How it is converted; `farther` counts where nothing nearer says anything."""
        return chosen_settings(description, farther)


@dataclass(frozen=True, eq=False)
class Shoot:
    """Takes that are converted together."""

    path: Path
    """The folder, or the list."""
    takes: tuple[ShootTake, ...]
    """In the order of their names, each name once."""

    @property
    def folder(self) -> Path:
        """What the takes' names are relative to."""
        return self.path if self.path.is_dir() else self.path.parent


def part_of(takes: Collection[ShootTake], part: int, parts: int) -> list[ShootTake]:
    """The share of one of several machines: every `parts`-th take, beginning with the `part`-th, from 1."""
    return [take for index, take in enumerate(takes) if index % parts == part - 1]
