"""What bad filming costs: one motion, filmed well and in one bad way at a time.

Usage: filming.py, with the Python of a virtual environment that has `bpy`. See README.md beside this file.
"""

import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from takes import ROOT, load_project, write_results
from trials import read_trial

load_project()
sys.path.insert(0, str(ROOT / "tools"))

from keymark.core.errors import KeymarkError  # noqa: E402
from keymark.core.estimate.reconstruct import reconstruct  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.score import Score  # noqa: E402
from keymark.core.take.evidence import with_evidence  # noqa: E402
from keymark.core.take.evidence_kinds import CONTOURS, MARKERS  # noqa: E402
from make_takes import make  # noqa: E402
from pictures.filming_scenes import ALIKE, DIM, LIKE_THE_WALL, PLAIN  # noqa: E402
from studio.catalogue.demonstration import DEMONSTRATION  # noqa: E402
from studio.described import Described  # noqa: E402
from studio.viewpoint import look_at  # noqa: E402

FOLDER = ROOT / "out" / "filming"
KEYFRAMES = "keyframes_noisy.json"
"""Posed with a person's errors."""
WORN, BARE = (MARKERS, CONTOURS), (CONTOURS,)
LENS_MM = DEMONSTRATION.camera.lens_mm
WELL = replace(DEMONSTRATION, side=None, moments=1, shutter_frames=0.1, samples=1, detected=False)
"""The demonstration, with a short exposure."""


@dataclass(frozen=True)
class Filmed:
    """One way of filming."""

    take: Described
    evidence: tuple[str, ...] = WORN


def _smaller(factor: float) -> Described:
    return replace(WELL, camera=replace(WELL.camera, lens_mm=LENS_MM / factor))


WAYS: Mapping[str, Filmed] = {
    "well": Filmed(WELL),
    "half as large": Filmed(_smaller(2.0)),
    "a third as large": Filmed(_smaller(3.0)),
    "from above": Filmed(
        replace(WELL, camera=look_at((0.55, -2.9, 3.4), (0.24, 0.05, 0.95), LENS_MM, WELL.camera.resolution))
    ),
    "shutter open all the time": Filmed(replace(WELL, moments=4, shutter_frames=1.0)),
    "one dim lamp behind": Filmed(replace(WELL, room=DIM, noise=9.0)),
    "colors like the room": Filmed(replace(WELL, look=ALIKE)),
    "plain clothes, contours alone": Filmed(replace(WELL, look=PLAIN), BARE),
    "clothes like the wall, contours alone": Filmed(replace(WELL, look=LIKE_THE_WALL), BARE),
}


def scores(way: Filmed, folder: Path) -> tuple[Score, Score] | str:
    """The errors of plain interpolation and of `map`; a sentence where the take is refused."""
    if not (folder / "truth.json").is_file():
        make(way.take, folder, None)
    try:
        trial = read_trial(folder, folder / KEYFRAMES)
        # Read anew: what was read with markers is no reading of a take without.
        motion = run(reconstruct(with_evidence(trial.take, way.evidence), "map")).motion
    except KeymarkError as error:
        return str(error)
    return trial.best_interpolation(), trial.score(motion.points, motion.sigma_m)


def main() -> int:
    """Film, reconstruct, and write the table."""
    found = {}
    for name, way in WAYS.items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        found[name] = scores(way, FOLDER / name.replace(" ", "_").replace(",", ""))
    lines = [
        "| filmed | interpolation | map | hips aligned | in depth | covered |",
        "|---|---:|---:|---:|---:|---:|",
    ]
    for name, result in found.items():
        if isinstance(result, str):
            lines.append(f"| {name} | {result} | | | | |")
            continue
        plain, score = result
        values = f"{plain.mpjpe:.1f} | {score.mpjpe:.1f} | {score.rooted:.1f} | {score.depth:.1f}"
        lines.append(f"| {name} | {values} | {score.coverage95:.2f} |")
    numbers = {
        name: result if isinstance(result, str) else [score.to_dict() for score in result]
        for name, result in found.items()
    }
    write_results("filming", "\n".join(lines), json.dumps(numbers, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
