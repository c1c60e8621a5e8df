"""Check the output of `make demo` against its promises. Usage: check_demo.py OUTPUT TAKE.

OUTPUT must hold a complete motion, the files that Blender and other programs open, pictures that are not
blank, a motion near the take's truth, and a character whose feet stand still on the floor; and once more,
from contours and keypoints instead of markers, such a motion, files and pictures. Both motions must come
nearer to the truth than straight lines between the keyframes. A bare clip that was animated must be a take
whose camera and poses were found, near its own truth once both are laid over each other, on a character. The
exit status is 1 on errors, with one line for each.
"""

import json
import sys
from pathlib import Path

import cv2
import numpy as np

LARGEST_MEAN_ERROR_M = 0.035
LARGEST_SHARE = {".": 0.6, "without_markers": 0.75}
"""Of the error of straight lines between the keyframes, by the folder of the motion in OUTPUT."""
PICTURES_AT_LEAST = 2
LARGEST_MM = {"skate_mm": 0.3, "penetration_mm": 2.2}
"""Of the figures of the character's motion; of the skin of ankle, heel and toes the one that slides most.
Feet deeper than 2 mm are lifted, on a larger character deeper in proportion."""
LARGEST_ANIMATED_M = 0.12
"""Of the motion from a bare clip: what nothing posed is usually off, and half as much again."""
ANIMATED_FILES = ("take.json", "keypoints.json", "keyframes.json", "motion.json", "conversion.json")
BLEND_STARTS = (b"BLENDER", b"\x28\xb5\x2f\xfd", b"\x1f\x8b")
"""A plain .blend, and one compressed by Zstandard or gzip."""


def straight_error_m(posed: dict, truth: dict) -> float:
    """Mean distance from the truth of straight lines between the points of the keyframes [m]."""
    at = [keyframe["frame"] for keyframe in posed["keyframes"]]
    errors = []
    for name, true_points in truth["points"].items():
        points = np.array([keyframe["points"][name] for keyframe in posed["keyframes"]], dtype=float)
        lines = np.stack([np.interp(truth["frames"], at, points[:, axis]) for axis in range(3)], axis=-1)
        errors.append(np.linalg.norm(lines - np.array(true_points), axis=-1))
    return float(np.mean(errors))


def check_motion(motion: dict, take: dict, truth: dict, largest_m: float) -> list[str]:
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
    if errors and np.mean(errors) > largest_m:
        wrong.append(f"the mean error is {np.mean(errors):.4f} m, over {largest_m:.4f}")
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


def check_evidence(folder: Path) -> list[str]:
    """Errors of the conversion without markers: other evidence than it is to have."""
    file = folder / "conversion.json"
    evidence = json.loads(file.read_text(encoding="utf-8"))["evidence"]
    wrong = [f"{file}: it was held against markers"] if evidence["markers"] else []
    return wrong + ([] if evidence["keypoints"] else [f"{file}: it was held against no keypoints"])


def check_animated(folder: Path, truth_file: Path) -> list[str]:
    """Errors of what was made from a bare clip and a height."""
    missing = [name for name in ANIMATED_FILES if not (folder / name).is_file()]
    if missing:
        return [f"{folder} holds no {missing[0]}"]
    found = json.loads((folder / "take.json").read_text(encoding="utf-8"))["//found"]
    wrong = (
        [] if found[0].startswith("Keypoints: ") else [f"{folder / 'take.json'} says nothing of keypoints"]
    )
    motion = json.loads((folder / "motion.json").read_text(encoding="utf-8"))
    truth = json.loads(truth_file.read_text(encoding="utf-8"))
    names = sorted(truth["points"])
    points = np.array([motion["points"][name] for name in names], dtype=float)
    true = np.array([truth["points"][name] for name in names], dtype=float)
    if points.shape != true.shape or not np.isfinite(points).all():
        return [*wrong, f"{folder / 'motion.json'} has no finite place in each frame"]
    error_m = laid_over_m(points.reshape(-1, 3), true.reshape(-1, 3))
    if error_m > LARGEST_ANIMATED_M:
        wrong.append(
            f"{folder / 'motion.json'}: the mean error is {error_m:.4f} m, over {LARGEST_ANIMATED_M}"
        )
    return wrong + check_files(folder, points.shape[1]) + check_pictures(folder / "report")


def laid_over_m(points: np.ndarray, true: np.ndarray) -> float:
    """Mean distance of points (N, 3) from true ones after one similarity transform (Umeyama 1991) [m]."""
    middle, true_middle = points.mean(axis=0), true.mean(axis=0)
    left, values, right = np.linalg.svd((true - true_middle).T @ (points - middle))
    sign = np.array([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    scale = (values * sign).sum() / ((points - middle) ** 2).sum()
    there = scale * (points - middle) @ (left @ np.diag(sign) @ right).T + true_middle
    return float(np.linalg.norm(there - true, axis=-1).mean())


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
    posed = json.loads((take_folder / "keyframes_noisy.json").read_text(encoding="utf-8"))
    straight_m = straight_error_m(posed, truth)
    wrong = []
    for name, share in LARGEST_SHARE.items():
        folder = output / name
        motion = folder / "motion.json"
        if not motion.is_file():
            wrong.append(f"{folder} holds no motion.json")
            continue
        largest_m = min(LARGEST_MEAN_ERROR_M, share * straight_m)
        found = check_motion(json.loads(motion.read_text(encoding="utf-8")), take, truth, largest_m)
        wrong += [f"{motion}: {sentence}" for sentence in found]
        wrong += check_files(folder, take["frame_count"])
        wrong += check_pictures(folder / "report")
    if not wrong:
        wrong = check_character(output) + check_evidence(output / "without_markers")
        animated = output / "animated"
        wrong += check_animated(animated, take_folder.with_name("greeting") / "truth.json")
        wrong += check_character(animated)
    for sentence in wrong:
        print(sentence, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
