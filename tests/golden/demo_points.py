"""Golden points of the demonstration's motion; `python tests/golden/demo_points.py` writes them anew.

To be run after a change that is meant to move them, whose message says by how much.
"""

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

HERE = Path(__file__).resolve().parent
FILE = HERE / "demo_points.npz"
UNIT_M = 1e-6


def demo_points() -> NDArray[np.float64]:
    """(118, 13, 3) points of the demonstration, converted now [m]."""
    from keymark.core.api import reconstruct
    from keymark.core.progress import run
    from keymark.core.take.take_file import read_take

    take = read_take(HERE.parent.parent / "presets" / "demo" / "aerobic")
    return np.asarray(run(reconstruct(take, "map")).motion.points, dtype=np.float64)


def golden_points() -> NDArray[np.float64]:
    """(118, 13, 3) points stored in the file [m]."""
    with np.load(FILE, allow_pickle=False) as file:
        return np.asarray(file["points"] * UNIT_M, dtype=np.float64)


if __name__ == "__main__":
    sys.path.insert(0, str(HERE.parent))
    from _boot import load_package

    load_package()
    np.savez_compressed(FILE, points=np.round(demo_points() / UNIT_M).astype(np.int32))
