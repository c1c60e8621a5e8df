"""`--keyframes` and `--library` together: which keyframes a person posed, and how the others are found."""

from pathlib import Path

from ...core.library.several_libraries import EVERY_LIBRARY
from .usage import UsageError


def wanted_keyframes(keyframes: str | None, library: str | None) -> tuple[Path | None, str | None]:
    """The keyframe file, and the library to find keyframes with, as settings have them.

    Args:
        keyframes: A file's path; `EVERY_LIBRARY` to find keyframes with all libraries, as `library` may also
            say; None or an empty text where nothing is said.
        library: Name or file of a library, or `EVERY_LIBRARY`.

    Raises:
        UsageError: The options contradict each other.
    """
    if keyframes != EVERY_LIBRARY:
        return Path(keyframes) if keyframes else None, library
    if library not in (None, EVERY_LIBRARY):
        raise UsageError(
            f"--keyframes {keyframes} finds keyframes with all libraries, --library {library} with one; give "
            "one of them"
        )
    return None, EVERY_LIBRARY
