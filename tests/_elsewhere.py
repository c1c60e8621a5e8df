"""Motions as a network of somebody else's gives them: jittering, biased for a while, badly placed."""

import csv
from pathlib import Path

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.human import HUMAN

RATE = 30.0
HIPS = [HUMAN.point_names.index(f"hip.{side}") for side in "LR"]
ANKLES = [HUMAN.point_names.index(f"ankle.{side}") for side in "LR"]
MHR = {"head": ("left_ear", "right_ear")}


def about_hips(points: Array) -> Array:
    """Points (F, 13, 3) relative to the hips' middle."""
    return np.asarray(points - points[:, HIPS].mean(axis=1, keepdims=True))


def seen_by_network(points: Array, seed: int = 0, bias_m: float = 0.03, place_m: float = 0.04) -> Array:
    """Points whose error wanders (AR(1), 0.4 s) and is partly new in each frame, and whose place jumps."""
    rng = np.random.default_rng(seed)
    keep = np.exp(-1.0 / (RATE * 0.4))
    bias = np.zeros(points.shape)
    bias[0] = bias_m * rng.normal(size=points.shape[1:])
    for frame in range(1, len(points)):
        fresh = bias_m * np.sqrt(1.0 - keep**2) * rng.normal(size=points.shape[1:])
        bias[frame] = keep * bias[frame - 1] + fresh
    grain = 0.004 * rng.normal(size=points.shape)
    place = place_m * rng.normal(size=(len(points), 1, 3)) * [0.2, 1.0, 0.2]
    return np.asarray(points + bias + grain + place)


def jitter_mm(points: Array) -> float:
    """Mean length of second differences."""
    return 1e3 * float(np.linalg.norm(np.diff(points, n=2, axis=0), axis=-1).mean())


def error_mm(points: Array, truth: Array) -> float:
    """Mean distance of points from true ones, about the hips."""
    return 1e3 * float(np.linalg.norm(about_hips(points) - about_hips(truth), axis=-1).mean())


def write_mhr70(path: Path, points: Array) -> None:
    """A csv like MHR-70's, in a camera's axes."""
    columns: dict[str, Array] = {}
    for index, name in enumerate(HUMAN.point_names):
        stem, dot, side = name.partition(".")
        names = (f"{'left' if side == 'L' else 'right'}_{stem}",) if dot else MHR[name]
        columns |= dict.fromkeys(names, points[:, index])
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow([f"{name}_3D{axis}" for name in columns for axis in "XYZ"])
        for frame in range(len(points)):
            places = [columns[name][frame] for name in columns]
            rows.writerow([f"{value:.6f}" for x, y, z in places for value in (x, -z, y)])
