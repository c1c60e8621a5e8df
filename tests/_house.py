"""The package's modules and imports, read from its source: what the rules of the house are held against."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path


def modules(root: Path, *folders: str) -> dict[str, Path]:
    """Every module below `folders`: its dotted name from the root, and its file."""
    files = [file for folder in folders for file in sorted((root / folder).rglob("*.py"))]
    return {name_of(file.relative_to(root)): file for file in files}


def name_of(path: Path) -> str:
    """`core/body/__init__.py` is `core.body`."""
    parts = path.with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


@cache
def nodes(source: str) -> tuple[ast.AST, ...]:
    """Every node of a module's source; each source is parsed once."""
    return tuple(ast.walk(ast.parse(source)))


def imports(name: str, is_package: bool, source: str, known: set[str]) -> Iterator[tuple[int, str]]:
    """Yield (line, dotted name) for each import in `source`, the relative ones resolved from the root.

    `from ..body import rotations` yields `core.body.rotations` where that is a module, else `core.body`.
    """
    package = name.split(".") if is_package else name.split(".")[:-1]
    for node in nodes(source):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield node.lineno, alias.name
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else []
            if node.level > len(package) + 1:
                yield node.lineno, f"(beyond the root){node.module or ''}"
                continue
            base = ".".join(above + ([node.module] if node.module else []))
            for alias in node.names:
                deeper = f"{base}.{alias.name}" if base else alias.name
                yield node.lineno, deeper if deeper in known else base
