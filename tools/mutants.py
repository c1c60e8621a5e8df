"""Change numbers and operators of core one at a time, and see whether the tests of the same room notice.

Usage: mutants.py [--count N] [--seed N] [--timeout S] [ROOM ...], with the Python of the development
environment; by default rooms that mostly calculate. Each mutant is made in a copy of the project, where
`pytest -x -q tests/core/ROOM` runs: a test that fails kills it. What survives is printed with file and line.
"""

import argparse
import ast
import random
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ROOMS = (
    "numerics",
    "body",
    "camera",
    "terms",
    "prior",
    "estimate",
    "poses",
    "feet",
    "keys",
    "mend",
    "retarget",
)
FOLDERS = ("core", "operators", "presets", "tests", "tools", "benchmarks", "docs")
FILES = ("__init__.py", "__main__.py", "blender_manifest.toml", "pyproject.toml", "Makefile")
OPERATORS = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.FloorDiv: ast.Mult,
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.And: ast.Or, ast.Or: ast.And, ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd,
}  # fmt: skip


@dataclass(frozen=True)
class Mutant:
    """One expression of a file, and what it becomes."""

    file: Path
    line: int
    first: int
    """Offset of the expression in the file [bytes]."""
    last: int
    before: str
    after: str

    def __str__(self) -> str:
        """The place, and the change."""
        return f"{self.file}:{self.line}  {self.before}  ->  {self.after}"


def mutants(file: Path, source: str) -> Iterator[Mutant]:
    """Every mutant of a source; types, documentation and messages are left alone."""
    starts = [0]
    for row in source.encode().splitlines(keepends=True):
        starts.append(starts[-1] + len(row))
    for node in _numeric(ast.parse(source)):
        for changed in _changes(node):
            first = starts[node.lineno - 1] + node.col_offset
            last = starts[node.end_lineno - 1] + node.end_col_offset
            before = " ".join(source.encode()[first:last].decode().split())
            yield Mutant(file, node.lineno, first, last, before, f"({ast.unparse(changed)})")


def _numeric(node: ast.AST) -> Iterator[ast.expr]:
    """Expressions below a node that are calculated."""
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "type_params"):
            continue
        for child in value if isinstance(value, list) else [value]:
            skipped = (ast.JoinedStr, ast.Raise, ast.Import, ast.ImportFrom, ast.Assert)
            if isinstance(child, ast.AST) and not isinstance(child, skipped):
                if isinstance(child, ast.expr):
                    yield child
                yield from _numeric(child)


def _changes(node: ast.expr) -> Iterator[ast.expr]:
    """What an expression can become: another operator, another number, or the next row."""
    match node:
        case ast.BinOp(left, operator, right) if type(operator) in OPERATORS:
            yield ast.BinOp(left, OPERATORS[type(operator)](), right)
        case ast.Compare(left, [operator], others) if type(operator) in OPERATORS:
            yield ast.Compare(left, [OPERATORS[type(operator)]()], others)
        case ast.BoolOp(operator, values):
            yield ast.BoolOp(OPERATORS[type(operator)](), values)
        case ast.Constant(bool() as value):
            yield ast.Constant(not value)
        case ast.Constant(int() as value):
            yield ast.Constant(value + 1)  # an index off by one, too
        case ast.Constant(float() as value):
            yield ast.Constant(2.0 * value if value else 1.0)
        case ast.UnaryOp(ast.USub(), operand) if not isinstance(operand, ast.Constant):
            yield operand
        case ast.Call(ast.Attribute(ast.Name("np"), "asarray"), [value]):
            yield ast.UnaryOp(ast.USub(), value)  # how numeric functions return


def drawn(rooms: list[str], count: int, seed: int) -> list[Mutant]:
    """Some mutants of rooms, the same for the same seed; every file with any counts alike."""
    files = [file for room in rooms for file in sorted((ROOT / "core" / room).rglob("*.py"))]
    by_file = [list(mutants(file.relative_to(ROOT), file.read_text(encoding="utf-8"))) for file in files]
    chosen, full = random.Random(seed), [each for each in by_file if each]
    return [chosen.choice(chosen.choice(full)) for _ in range(count)]


def killed_by_tests(folder: Path, mutant: Mutant, patience_s: float) -> bool:
    """Whether the room's tests fail for a mutant in a copy of the project."""
    file = folder / mutant.file
    source = file.read_bytes()
    file.write_bytes(source[: mutant.first] + mutant.after.encode() + source[mutant.last :])
    try:
        return not passes(folder, mutant.file.parts[1], patience_s)
    finally:
        file.write_bytes(source)


def passes(folder: Path, room: str, patience_s: float) -> bool:
    """Whether a room's tests pass in a copy of the project; tests that take too long do not."""
    words = [sys.executable, "-B", "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", f"tests/core/{room}"]
    try:
        return subprocess.run(words, cwd=folder, capture_output=True, timeout=patience_s).returncode == 0
    except subprocess.TimeoutExpired:
        return False


def main(arguments: list[str]) -> int:
    """Draw mutants, test them, and print the share that was killed."""
    parser = argparse.ArgumentParser(description="Change numbers of core and see whether tests notice.")
    parser.add_argument("rooms", nargs="*", metavar="ROOM", default=list(ROOMS))
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--timeout", type=float, default=600.0, metavar="S")
    chosen = parser.parse_args(arguments)
    killed = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / "keymark"
        for name in FOLDERS:
            shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
        for name in FILES:
            shutil.copy(ROOT / name, folder / name)
        made = drawn(chosen.rooms, chosen.count, chosen.seed)
        for room in sorted({mutant.file.parts[1] for mutant in made}):
            if not passes(folder, room, chosen.timeout):
                raise SystemExit(f"tests/core/{room} does not pass as it is, so it can tell nothing")
        for mutant in made:
            found = killed_by_tests(folder, mutant, chosen.timeout)
            killed += found
            print(f"{'killed  ' if found else 'SURVIVED'}  {mutant}", flush=True)
    print(f"{killed} of {chosen.count} killed ({100.0 * killed / max(chosen.count, 1):.0f} %)")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
