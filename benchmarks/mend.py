"""A network's motion mended without footage, with nothing posed and with frames posed as they truly were.

Errors are about the hips, after one turn and one size for the whole take, which the files leave open.
"""

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np
from takes import chosen_takes, load_project, write_results

load_project()

from keymark.core.arrays import Array  # noqa: E402
from keymark.core.body.human import HUMAN  # noqa: E402
from keymark.core.body.skeleton import SIDES  # noqa: E402
from keymark.core.mend.mend_motion import Mended, MendOptions, mend_motion  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.score import read_truth  # noqa: E402
from keymark.core.take.conversion_settings import CharacterFile  # noqa: E402
from keymark.core.take.reference import read_reference  # noqa: E402
from keymark.core.take.take_file import read_take  # noqa: E402

FILES = ("network.bvh", "network_mhr70.csv")
POSED = (0, 3, 5, 10)  # posed frames per 100
HIPS, ANKLES = ([HUMAN.point_names.index(f"{name}.{side}") for side in SIDES] for name in ("hip", "ankle"))
STANDING_M = 0.004  # a true ankle that moves less in a frame stands
TITLES = (
    *("take", "file", "error given", "mended", "armature", "3 posed", "5 posed", "10 posed"),
    *("jitter given", "mended", "skate given", "mended", "ms a frame"),
)


def about_hips(points: Array) -> Array:
    """Points (F, 13, 3) from the hips' middle."""
    return np.asarray(points - points[:, HIPS].mean(axis=1, keepdims=True))


def turned_truth(given: Array, truth: Array) -> tuple[Array, Array]:
    """The truth about the hips (F, 13, 3) in a file's axes and size, and the turn from these to its own."""
    known = np.isfinite(given).all(axis=(1, 2))
    seen, true = (about_hips(points)[known].reshape(-1, 3) for points in (given, truth))
    left, strength, right = np.linalg.svd(true.T @ seen)
    mirror = np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    turn = left @ mirror @ right
    size = float(np.sum(strength * np.diag(mirror)) / np.sum(seen**2))
    return about_hips(truth) @ turn / size, turn


def read_file(file: Path) -> tuple[Array, Array | None]:
    """The points of a file, and those of its armature once mended on it."""
    if file.suffix != ".bvh":
        return read_reference(file).points_m, None
    from keymark.core.retarget.mended_armature import ArmaturePoints
    from keymark.core.retarget.solve.rest_body import RestBody
    from keymark.operators.bridge.blend_files import own_scene, showing_scene
    from keymark.operators.bridge.character.read_character import read_character
    from keymark.operators.bridge.motions.import_motion import import_motion
    from keymark.operators.bridge.motions.mend_action import mend_action
    from keymark.operators.bridge.motions.read_poses import joint_paths

    with own_scene("Motion") as scene, showing_scene(scene):
        imported, chosen = import_motion(CharacterFile(file), scene)
        given, _ = joint_paths(imported.armature)
        found = run(mend_action(imported.armature, chosen.character_map))
        body = RestBody.of(read_character(imported.armature), chosen.character_map)
        return given, ArmaturePoints.of(body).of_poses(found.poses)


def mended(given: Array, true: Array, way: Array, count: int) -> tuple[Mended, float]:
    """The motion mended with so many frames per 100 posed, and the time it took [s].

    The hips (F, 3) of posed frames are where the mended motion has them, which a person would correct.
    """
    known = np.isfinite(given).all(axis=(1, 2))
    number = round(count * len(given) / 100)
    frames = np.array([int((index + 0.5) * len(given) / number) for index in range(number)], dtype=np.intp)
    frames = frames[known[frames]]
    posed = given.copy()
    posed[frames] = true[frames] + way[frames, None]
    started = time.process_time()
    return run(mend_motion(posed, 30.0, MendOptions(tuple(frames.tolist())))), time.process_time() - started


def measured(given: Array, truth: Array, armature: Array | None) -> dict[str, float]:
    """Figures of one file: errors, jitter as a share of the truth's, and skating [mm, mm a frame]."""
    true, turn = turned_truth(given, truth)

    def error(points: Array) -> float:
        return 1e3 * float(np.nanmean(np.linalg.norm(about_hips(points) - true, axis=-1)))

    def jitter(points: Array) -> float:
        bends = [np.linalg.norm(np.diff(each, n=2, axis=0), axis=-1) for each in (points, truth)]
        return float(np.nanmean(bends[0]) / bends[1].mean())

    def skate(points: Array) -> float:
        stands = np.linalg.norm(np.diff(truth[:, ANKLES], axis=0), axis=-1) < STANDING_M
        travel = np.linalg.norm(np.diff((points @ turn.T)[:, ANKLES, :2], axis=0), axis=-1)
        return 1e3 * float(np.nanmean(travel[stands]))

    found = {"error given": error(given), "jitter given": jitter(given), "skate given": skate(given)}
    way = run(mend_motion(given, 30.0, MendOptions(floor=False))).motion.points[:, HIPS].mean(axis=1)
    for count in POSED:
        result, seconds = mended(given, true, way, count)
        points = result.motion.points
        found[f"{count} posed" if count else "error mended"] = error(points)
        if not count:
            found |= {"jitter mended": jitter(points), "skate mended": skate(points)}
            found["ms a frame"] = 1e3 * seconds / len(points)
    found["armature"] = float("nan") if armature is None else error(armature)
    return found


def row(name: str, file: str, found: dict[str, float]) -> str:
    """A line of the table."""
    keys = ("error given", "error mended", "armature", "3 posed", "5 posed", "10 posed")
    keys += ("jitter given", "jitter mended", "skate given", "skate mended", "ms a frame")
    cells = [
        "" if np.isnan(found[key]) else f"{found[key]:.2f}" if "jitter" in key else f"{found[key]:.1f}"
        for key in keys
    ]
    return f"| {name} | {file} | {' | '.join(cells)} |"


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("takes", nargs="*")
    lines = ["| " + " | ".join(TITLES) + " |", "|" + "---|" * len(TITLES)]
    numbers: dict[str, dict[str, float]] = {}
    for name, folder in chosen_takes(parser.parse_args().takes, plain=True).items():
        for file in FILES:
            if not (folder / file).is_file():
                continue
            take = read_take(folder, whole=True)
            truth = read_truth(folder / "truth.json", take.frame_start, take.frame_count)
            given, armature = read_file(folder / file)
            found = measured(given, truth, armature)
            numbers[f"{name}, {file}"] = found
            lines.append(row(name, file, found))
            print(lines[-1], file=sys.stderr, flush=True)
    for file in FILES:
        those = [found for key, found in numbers.items() if key.endswith(file)]
        if those:
            lines.append(
                row("**mean**", file, {key: float(np.mean([one[key] for one in those])) for key in those[0]})
            )
    write_results("mend", "\n".join(lines), json.dumps(numbers, indent=1))


if __name__ == "__main__":
    main()
