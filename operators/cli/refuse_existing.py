"""A check before a command writes a single file: an older one is replaced only where that is asked for."""

from pathlib import Path

from .usage import UsageError


def refuse_existing(output: Path, replace: bool) -> None:
    """Refuse to replace a file unless `--replace` is given.

    Raises:
        UsageError: Something is there.
    """
    if output.exists() and not replace:
        raise UsageError(f"{output} is there already; name another file, or add --replace to replace it")
