"""Check the output of `make demo` against its promises. Usage: check_demo.py OUTPUT TAKE.

OUTPUT must hold a complete motion, the files that Blender and other programs open, pictures that are not
blank, a motion near the take's truth, and a character whose feet stand still on the floor. The exit status is
1 on errors, with one line for each.
"""

import json
import sys
from pathlib import Path

import cv2
import numpy as np

LARGEST_MEAN_ERROR_M = 0.035
PICTURES_AT_LEAST = 5
LARGEST_MM = {"skate_mm": 0.05, "penetration_mm": 2.0, "ik_fk_mm": 1.0}
"""Of the figures of the character's motion."""
BLEND_STARTS = (b"BLENDER", b"\x28\xb5\x2f\xfd", b"\x1f\x8b")
"""A plain .blend, and one compressed by Zstandard or gzip."""


def check_motion(motion: dict, take: dict, truth: dict) -> list[str]:
    """Errors of a motion.json: missing or non-finite frames, or too large a distance from the truth."""
    wrong = []
    errors = []
    if set(motion["points"]) != set(truth["points"]):
        return [f"the motion's points are {sorted(motion['points'])}"]
    for name, true_points in truth["points"].items():
        points = np.array(motion["points"][name], dtype=float)
        sigma = np.array(motion["sigma_m"][name], dtype=float)
        if points.shape != (take["frame_count"], 3) or not np.isfinite(points).all():
            wrong.append(f"{name} has no finite place in each of the {take['frame_count']} frames")
            continue
        if sigma.shape != (take["frame_count"],) or not (sigma > 0.0).all():
            wrong.append(f"{name} has no positive sigma in each of the {take['frame_count']} frames")
        rows = np.array(truth["frames"]) - take["frame_start"]
        errors.append(np.linalg.norm(points[rows] - np.array(true_points), axis=-1))
    if errors and np.mean(errors) > LARGEST_MEAN_ERROR_M:
        wrong.append(f"the mean error is {np.mean(errors):.4f} m, over {LARGEST_MEAN_ERROR_M}")
    return wrong


def check_files(folder: Path, frame_count: int) -> list[str]:
    """Errors of the .blend and the .bvh beside a motion.json."""
    wrong = []
    blend = folder / "motion.blend"
    if not blend.is_file() or not blend.read_bytes().startswith(BLEND_STARTS):
        wrong.append(f"{blend} is no Blender file")
    bvh = folder / "motion.bvh"
    if not bvh.is_file() or f"Frames: {frame_count}" not in " ".join(bvh.read_text().split()):
        wrong.append(f"{bvh} does not have {frame_count} frames")
    return wrong


def check_character(folder: Path) -> list[str]:
    """Errors of the character beside a motion.json: no file, or a motion that slides or sinks."""
    blend = folder / "character.blend"
    if not blend.is_file() or not blend.read_bytes().startswith(BLEND_STARTS):
        return [f"{blend} is no Blender file"]
    quality = json.loads((folder / "retarget.json").read_text(encoding="utf-8"))["quality"]
    return [
        f"{folder / 'retarget.json'}: {name} is {quality.get(name)}, not within {largest}"
        for name, largest in LARGEST_MM.items()
        if not quality.get(name, np.inf) <= largest
    ]


def check_pictures(folder: Path) -> list[str]:
    """Errors of the pictures: blank ones, or too few."""
    files = sorted(folder.rglob("*.png"))
    wrong = [] if len(files) >= PICTURES_AT_LEAST else [f"{folder} holds only {len(files)} pictures"]
    for file in files:
        image = cv2.imread(str(file))
        if image is None or image.std() < 1.0:
            wrong.append(f"{file} shows nothing")
    return wrong


def main(arguments: list[str]) -> int:
    """Check, print the errors, return the exit status."""
    output, take_folder = map(Path, arguments)
    take = json.loads((take_folder / "take.json").read_text(encoding="utf-8"))
    truth = json.loads((take_folder / "truth.json").read_text(encoding="utf-8"))
    motions = sorted(output.rglob("motion.json"))
    wrong = [] if motions else [f"{output} holds no motion.json"]
    for motion in motions:
        found = check_motion(json.loads(motion.read_text(encoding="utf-8")), take, truth)
        wrong += [f"{motion}: {sentence}" for sentence in found]
        wrong += check_files(motion.parent, take["frame_count"])
        wrong += check_character(motion.parent)
    wrong += check_pictures(output)
    for sentence in wrong:
        print(sentence, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
