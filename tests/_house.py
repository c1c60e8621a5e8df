"""The package's modules, imports and sentences, read from its source."""

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


# --- Sentences that people meet, read from the source: every literal, with braces where values go


def sentences(source: str) -> Iterator[str]:
    """The literals of a module; a value that is filled in is `{}`."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.JoinedStr):
            parts = (part.value if isinstance(part, ast.Constant) else "{}" for part in node.values)
            yield "".join(map(str, parts))
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield without_names(node.value)


def without_names(template: str) -> str:
    """A template without the names of its values."""
    result, depth = "", 0
    for letter in template:
        depth += (letter == "{") - (letter == "}")
        result += letter if letter == "{" or not depth else ""
    return result


def all_sentences(repository: Path) -> set[str]:
    """Those of the whole program."""
    files = modules(repository, "core", "operators").values()
    return {said for file in files for said in sentences(file.read_text(encoding="utf-8"))}
