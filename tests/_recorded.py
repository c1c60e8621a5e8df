"""What rooms calculate of seeded input, as few numbers in golden/rooms.json that change with every value.

A method that changes on purpose records anew and says why: `KEYMARK_RECORD=1 python -m pytest FILE`.
"""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import ArrayLike

FILE = Path(__file__).resolve().parent / "golden" / "rooms.json"
PROJECTIONS = 4


def assert_recorded(name: str, *values: ArrayLike, share: float = 1e-5) -> None:
    """Hold values of any shape against those recorded, within a share of their root mean square."""
    flat = np.concatenate([np.asarray(one, dtype=np.float64).ravel() for one in values])
    known = np.isfinite(flat)
    flat = np.where(known, flat, 0.0)
    size = float(np.sqrt(np.mean(flat**2)))
    turns = np.outer(1.0 + np.arange(PROJECTIONS), np.arange(len(flat))) * np.sqrt(2.0)
    found = [len(flat), int(known.sum()), size, *(np.cos(turns) @ flat / np.sqrt(len(flat)))]
    if os.environ.get("KEYMARK_RECORD"):
        rows = json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}
        rows[name] = [found[0], found[1], *(float(f"{value:.9g}") for value in found[2:])]
        lines = [f"{json.dumps(key)}: {json.dumps(rows[key])}" for key in sorted(rows)]
        FILE.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    recorded = json.loads(FILE.read_text(encoding="utf-8"))[name]
    assert found[:2] == recorded[:2], name
    assert found[2:] == pytest.approx(recorded[2:], rel=0.0, abs=share * size), name
