"""Installation of libraries in an asset library: each as a .blend of pose assets."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ...core.arrays import Image
from ...core.library.library import Library
from ...core.library.texts import checked_identifier
from ...core.progress import Job, Progress
from ..bridge.library.library_blend import read_library_blend, write_library_blend
from ..bridge.library.pose_assets import draw_pictures
from .conflict_dialog import Conflict
from .conflicts import find_conflicts, resolve_conflicts

FOLDER = "keymark"
"""In the asset library."""


@dataclass(frozen=True, eq=False)
class DrawnLibrary:
    """A library with a picture of each posture."""

    library: Library
    pictures: list[Image]


class Installation:
    """The libraries installed in one asset library, each read once."""

    def __init__(self, root: Path) -> None:
        """Nothing is read yet.

        Args:
            root: Folder of the asset library.
        """
        self._root = root
        self._read: dict[str, Library | None] = {}

    def find(self, identifier: str) -> Library | None:
        """The installed library of an identifier; None where there is none.

        Raises:
            InputError: Its file is unusable.
        """
        if identifier not in self._read:
            path = self._file(identifier)
            self._read[identifier] = read_library_blend(path)[0] if path.exists() else None
        return self._read[identifier]

    def conflicts(self, libraries: Sequence[Library]) -> list[Conflict]:
        """The libraries whose identifier a different installed one has."""
        return find_conflicts(libraries, self.find)

    def draw(self, libraries: Sequence[Library], choice: str) -> Job[list[DrawnLibrary]]:
        """Draw the pictures of the libraries that are to be installed; nothing is written.

        Args:
            libraries: The libraries.
            choice: What to do where an identifier is taken, of `conflict_dialog.CHOICES`.

        Raises:
            InputError: An identifier is taken and the choice is to ask.
        """
        wanted = resolve_conflicts(libraries, self.find, choice)
        count = sum(len(library.postures) for library in wanted)
        drawn: list[DrawnLibrary] = []
        done = 0
        for library in wanted:
            pictures: list[Image] = []
            for picture in draw_pictures(library):
                pictures.append(picture)
                done += 1
                yield Progress("Drawing the postures", done / count)
            drawn.append(DrawnLibrary(library, pictures))
        return drawn

    def write(self, drawn: Iterable[DrawnLibrary]) -> None:
        """Write a .blend for each library.

        Raises:
            InputError: The asset library's file of catalogs is of another kind.
            ConversionError: A file cannot be written.
        """
        for each in drawn:
            path = self._file(each.library.identifier)
            write_library_blend(path, each.library, self._root, each.pictures)

    def _file(self, identifier: str) -> Path:
        return self._root / FOLDER / f"{checked_identifier(identifier, 'the identifier')}.blend"
