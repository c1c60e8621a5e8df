"""What bad filming costs: the demonstration, filmed or changed in one bad way at a time.

Usage: filming.py, with the Python of a virtual environment that has `bpy`. See README.md beside this file.
"""

import json
import shutil
import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from takes import ROOT, load_project, write_results
from trials import read_trial

load_project()
sys.path.insert(0, str(ROOT / "tools"))

from keymark.core.api import reconstruct  # noqa: E402
from keymark.core.arrays import Image  # noqa: E402
from keymark.core.errors import KeymarkError  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.score import Score  # noqa: E402
from keymark.core.take.evidence import CONTOURS, MARKERS  # noqa: E402
from keymark.core.take.examples import AEROBIC, POSED_BY_HAND, example_folder  # noqa: E402
from keymark.core.take.take import with_evidence  # noqa: E402
from keymark.core.video.clip import Clip  # noqa: E402
from make_takes import make  # noqa: E402
from studio.catalogue.demonstration import DEMONSTRATION  # noqa: E402
from studio.described import Described  # noqa: E402
from studio.look import Look  # noqa: E402
from studio.viewpoint import look_at  # noqa: E402

DEMO = example_folder(AEROBIC)
FOLDER = ROOT / "out" / "filming"
SEED = 5
ALIKE = Look(
    colors={
        "trunk": (150, 120, 92),
        "forearm.L": (206, 170, 140),
        "forearm.R": (198, 160, 134),
        "shin.L": (128, 100, 84),
        "shin.R": (118, 96, 84),
    },
    cloth_m={"trunk": 0.036, "forearm": 0.024, "shin": 0.034},
    folds=0.2,
)
"""Clothes in the colors of skin, floor and each other."""
SHARP = replace(DEMONSTRATION, side=None, detected=False, moments=1, shutter_frames=0.1, samples=1)
ABOVE = look_at((0.55, -2.9, 3.4), (0.24, 0.05, 0.95), 47.0, DEMONSTRATION.camera.resolution)
DIM, NOISE = 0.3, 9.0
"""Share of the light that is left, and the sensor's noise in eight-bit steps."""
FLICKER = 0.25
"""Change of brightness from one frame to the next, as lamps of the mains make it."""
HAND_PX = 2.0
"""Standard deviation of a hand's wandering along either axis of a picture 320 pixels wide."""
HAND_FRAMES = 6.0

Change = Callable[[list[Image], np.random.Generator], list[Image]]


def smaller(factor: int) -> Change:
    """The performer smaller in the picture by a factor."""
    return lambda images, _: [
        cv2.resize(i, None, fx=1 / factor, fy=1 / factor, interpolation=cv2.INTER_AREA) for i in images
    ]


def dim(images: list[Image], random: np.random.Generator) -> list[Image]:
    """Too little light."""
    return [_rounded(DIM * image + NOISE * random.standard_normal(image.shape)) for image in images]


def flickering(images: list[Image], random: np.random.Generator) -> list[Image]:
    """Every second frame darker."""
    return [_rounded((1.0 - FLICKER * (number % 2)) * image) for number, image in enumerate(images)]


def held_by_hand(images: list[Image], random: np.random.Generator) -> list[Image]:
    """The whole picture wanders."""
    place, moved = np.zeros(2), []
    for image in images:
        kept = np.exp(-1.0 / HAND_FRAMES)
        place = kept * place + HAND_PX * np.sqrt(1.0 - kept**2) * random.standard_normal(2)
        shift = np.array([[1.0, 0.0, place[0]], [0.0, 1.0, place[1]]])
        moved.append(cv2.warpAffine(image, shift, image.shape[1::-1], borderMode=cv2.BORDER_REPLICATE))
    return moved


CHANGED: Mapping[str, Change] = {
    "as it is": lambda images, _: images,
    "half as large": smaller(2),
    "a third as large": smaller(3),
    "a quarter as large": smaller(4),
    "dim, with noise": dim,
    "flickering": flickering,
    "held by hand": held_by_hand,
}
"""Ways in which the demonstration's clip is changed."""
FILMED: Mapping[str, Described] = {
    "from above": replace(SHARP, camera=ABOVE),
    "colors like the room": replace(SHARP, look=ALIKE),
    "shutter open all the time": replace(SHARP, moments=3, shutter_frames=1.0),
}
"""Ways in which it is filmed anew."""


def change(folder: Path, how: Change) -> None:
    """Write the demonstration with a changed clip."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in (POSED_BY_HAND, "truth.json", "keyframes.json"):
        shutil.copyfile(DEMO / name, folder / name)
    fields = json.loads((DEMO / "take.json").read_text(encoding="utf-8"))
    clip = Clip.open(DEMO / "clip.mp4", fps=fields["fps"])
    images = [image for _, image in clip.source.at(range(fields["frame_count"]))]
    images = how(images, np.random.default_rng(SEED))
    frames = folder / "frames"
    shutil.rmtree(frames, ignore_errors=True)
    frames.mkdir()
    for number, image in enumerate(images, fields["frame_start"]):
        cv2.imwrite(str(frames / f"{number:04d}.png"), image)
    fields["camera"]["resolution"] = list(images[0].shape[1::-1])
    (folder / "take.json").write_text(json.dumps({**fields, "clip": frames.name}), encoding="utf-8")


def scores(folder: Path) -> tuple[Score, Score] | str:
    """The errors of plain interpolation and of `map`; a sentence where the take is refused."""
    try:
        trial = read_trial(folder, folder / POSED_BY_HAND)
        motion = run(reconstruct(with_evidence(trial.take, (MARKERS, CONTOURS)), "map", trial.reading)).motion
    except KeymarkError as error:
        return str(error)
    return trial.best_interpolation(), trial.score(motion.points, motion.sigma_m)


def _rounded(values: np.ndarray) -> Image:
    return np.asarray(np.clip(np.rint(values), 0.0, 255.0), dtype=np.uint8)


def main() -> int:
    """Change and film, reconstruct, and write the table."""
    found = {}
    for name in (*CHANGED, *FILMED):
        print(f"{name} ...", file=sys.stderr, flush=True)
        folder = FOLDER / name.replace(" ", "_").replace(",", "")
        if name in CHANGED:
            change(folder, CHANGED[name])
        elif not (folder / "truth.json").is_file():  # filming takes minutes
            make(FILMED[name], folder, None)
        found[name] = scores(folder)
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
