"""Conversions in processes of their own, killed a hundred times at random points, and run again."""

import json
import os
import random
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import bpy
import pytest
from _results import blend_is_of, hidden_files, is_whole, same_in_every_run
from _synthetic_take import write_synthetic_take

pytestmark = [
    pytest.mark.faults,
    pytest.mark.skipif(os.name == "nt", reason="Windows has no timer that counts a processor's time"),
    pytest.mark.skipif(bool(bpy.app.binary_path), reason="a Blender program's own Python has no bpy"),
]
SEEDS = (20, 21)
KILLS = 50
TO_ITS_END = 5
"""Number of kills after which a run goes to its end."""
RUNS = {
    "older": ("--method", "interpolation", "--no-report"),
    "newer": ("--method", "interpolation"),
    "map": ("--method", "map", "--no-report"),
}


@dataclass(frozen=True)
class Undisturbed:
    """The result of an undisturbed run, and its effort."""

    results: dict[str, bytes | None]
    operations: int
    cpu_s: float


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_synthetic_take(tmp_path_factory.mktemp("takes") / "tiny", 8, 4)


def run(take: Path, out: Path, kind: str, when: str) -> "subprocess.CompletedProcess[str]":
    script = Path(__file__).resolve().parents[2] / "_dying.py"
    words = ["convert", str(take), "--output", str(out), "--quiet", *RUNS[kind]]
    return subprocess.run(
        [sys.executable, str(script), when, str(out.parent), *words], capture_output=True, text=True
    )


def to_the_end(take: Path, out: Path, kind: str) -> Undisturbed:
    done = run(take, out, kind, "never")
    assert done.returncode == 0, done.stderr
    took = json.loads(done.stdout.splitlines()[-1])
    assert is_whole(out)
    return Undisturbed(same_in_every_run(out.parent), took["operations"], took["cpu_s"])


@pytest.fixture(scope="module")
def undisturbed(take: Path) -> dict[str, Undisturbed]:
    found = {}
    for kind in RUNS:
        out = take.parent / "results" / "out"  # of equal depth everywhere: a .blend holds the way to its clip
        found[kind] = to_the_end(take, out, kind)
        shutil.rmtree(out.parent)
    return found


def test_two_runs_leave_the_same(take: Path, undisturbed: dict[str, Undisturbed]) -> None:
    out = take.parent / "results" / "out"
    assert to_the_end(take, out, "newer").results == undisturbed["newer"].results
    assert blend_is_of(out)
    shutil.rmtree(out.parent)


@pytest.mark.parametrize("seed", SEEDS)
def test_fifty_deaths_leave_no_trace(take: Path, undisturbed: dict[str, Undisturbed], seed: int) -> None:
    chance = random.Random(seed)
    out = take.parent / "results" / "out"
    survived = ended = 0
    for death in range(1, KILLS + 1):
        kind = chance.choice(["newer", "older", "newer", "older", "map"])
        if death % 3:
            when = str(chance.randint(1, undisturbed[kind].operations))
        else:
            when = f"{chance.uniform(0.001, undisturbed[kind].cpu_s):.4f}s"
        done = run(take, out, kind, when)
        assert done.returncode <= 0, done.stderr
        survived += done.returncode == 0
        if out.exists():
            is_whole(out)
        if death % TO_ITS_END == 0:
            kind = chance.choice(list(RUNS))
            assert to_the_end(take, out, kind).results == undisturbed[kind].results
            assert not hidden_files(out.parent) and blend_is_of(out)
            ended += 1
            if chance.random() < 0.3:
                shutil.rmtree(out)
    shutil.rmtree(out.parent)
    assert survived <= KILLS // 10 and ended == KILLS // TO_ITS_END
