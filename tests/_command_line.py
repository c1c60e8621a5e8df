"""Checks after a command: the line on standard error, and the files in a folder."""

from pathlib import Path


def tree(folder: Path) -> dict[str, bytes | None]:
    """Every path below a folder, with the content of files."""
    return {
        str(path.relative_to(folder)): path.read_bytes() if path.is_file() else None
        for path in sorted(folder.rglob("*"))
    }


def one_line(text: str) -> str:
    """The single line on standard error."""
    lines = text.splitlines()
    assert len(lines) == 1, text
    assert lines[0].startswith("keymark: ") or lines[0].startswith("blender --command keymark: ")
    return lines[0]
