"""Publication of libraries: into the user's folder, from where footage is matched with them."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .conflict_dialog import Conflict
from .registry import refresh

if TYPE_CHECKING:
    from ...core.library.library import Library


def registry_conflicts(libraries: "Sequence[Library]") -> list[Conflict]:
    """The libraries whose identifier a different registered one has."""
    from .conflicts import find_conflicts
    from .registry_files import find_registered

    return find_conflicts(libraries, find_registered)


def publish(libraries: "Sequence[Library]", choice: str) -> "list[Library]":
    """Write libraries into the user's folder.

    Args:
        libraries: The libraries.
        choice: What to do where an identifier is taken, of `conflict_dialog.CHOICES`.

    Returns:
        Those that were written, under the identifiers they have now.

    Raises:
        InputError: An identifier is taken and the choice is to ask, or a file holds something else.
        ConversionError: A file cannot be written.
    """
    from .conflicts import resolve_conflicts
    from .registry_files import find_registered, write_to_registry

    resolved = resolve_conflicts(libraries, find_registered, choice)
    write_to_registry(resolved)
    refresh(resolved[-1].identifier if resolved else "")
    return resolved
