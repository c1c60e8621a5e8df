"""Mutants of core: each is another program, and words are left alone."""

import ast
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))

from mutants import drawn, mutants  # noqa: E402

SOURCE = '''"""Twice 2."""
LEAST: tuple[int, 4] = 0.5
"""Least of 3."""
def f(x: "float" = 1, *, on: bool = True):
    if x < 2 * LEAST and on:
        raise ValueError(f"{x + 1} is wrong")
    "é"; return np.asarray(-x[0])
'''


def test_every_mutant_is_one_change_of_what_is_calculated() -> None:
    found = list(mutants(Path("a.py"), SOURCE))
    assert {(one.line, one.before, one.after) for one in found} == {
        (2, "0.5", "(1.0)"),
        (4, "1", "(2)"),
        (4, "True", "(False)"),
        (5, "x < 2 * LEAST and on", "(x < 2 * LEAST or on)"),
        (5, "x < 2 * LEAST", "(x <= 2 * LEAST)"),
        (5, "2 * LEAST", "(2 / LEAST)"),
        (5, "2", "(3)"),
        (7, "np.asarray(-x[0])", "(--x[0])"),
        (7, "-x[0]", "(x[0])"),
        (7, "0", "(1)"),
    }
    raw = SOURCE.encode()
    for one in found:
        changed = raw[: one.first] + one.after.encode() + raw[one.last :]
        assert ast.dump(ast.parse(changed)) != ast.dump(ast.parse(SOURCE))


def test_a_seed_decides_what_is_drawn() -> None:
    assert drawn(["body"], 5, 1) == drawn(["body"], 5, 1) != drawn(["body"], 5, 2)
    assert {one.file.parts[:2] for one in drawn(["body"], 5, 1)} == {("core", "body")}
    assert {one.file.parts[1] for one in drawn(["body", "numerics"], 12, 1)} == {"body", "numerics"}
