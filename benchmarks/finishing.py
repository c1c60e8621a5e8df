"""Finishing: accuracy with planted feet, and the number of keys that keep a motion within a tolerance.

Usage: finishing.py [TAKE ...] with names or folders of takes with truth; by default all found. See README.md.
"""

import argparse
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
from clock import processor_time
from keyframing import exact_postures, hand_posed, keyed
from takes import GROUPS, chosen_takes, group_of, load_project, write_results
from trials import Trial, read_trial

load_project()

from _rig import quaternion_rig, rig_values  # noqa: E402
from keymark.core.arrays import Array, IndexArray  # noqa: E402
from keymark.core.body.posture import Posture  # noqa: E402
from keymark.core.feet.planted_feet import plant_feet  # noqa: E402
from keymark.core.keys.hermite import fit_keys  # noqa: E402
from keymark.core.keys.key_reduction import ReducedKeys, reduce_keys  # noqa: E402
from keymark.core.keys.rig import Rig  # noqa: E402
from keymark.core.keys.tolerances import point_tolerances  # noqa: E402
from keymark.core.progress import run  # noqa: E402

TOLERANCES_MM = (5, 10, 20)
BAKED_MM = TOLERANCES_MM[0]  # default tolerance of a bake
COLUMNS = {
    "frames": 0,
    "keyframes": 0,
    **{
        f"{kind} {tolerance}": 1 for tolerance in TOLERANCES_MM for kind in ("reduced", "whole poses", "even")
    },
    "CPU": 0,
}
FEET = {"rests": 0, "mpjpe": 1, "planted": 1, "baked": 1, "skate": 2, "skate planted": 2, "skate baked": 2}
"""Columns of the two tables, and their digits."""

Row = dict[str, float]


def measure(folder: Path) -> Row:
    """Measure one take's motion by `map` from hand-posed keyframes, finished in several ways."""
    trial = read_trial(folder)
    postures = hand_posed(trial, exact_postures(trial))
    trial = keyed(trial, postures, trial.take.keyframe_indices)
    return finished(trial, trial.estimated("map").posture)


def finished(trial: Trial, posture: Posture) -> Row:
    """Keys a bone by tolerance, and errors before and after planting and baking."""
    body, frames = trial.take.body, len(trial.truth)
    rig, times = quaternion_rig(body), np.arange(frames, dtype=np.float64)
    posed = np.array(trial.take.keyframe_indices, dtype=np.intp)
    values = rig_values(rig, posture, body)
    row: Row = {"frames": frames, "keyframes": len(posed)}
    seconds = []
    for tolerance in TOLERANCES_MM:
        found: list[ReducedKeys] = []

        def reduce(limit_m: float = tolerance * 1e-3, found: list[ReducedKeys] = found) -> None:
            found.append(run(reduce_keys(rig, times, values, limit_m, posed)))

        seconds.append(processor_time(reduce))
        poses = run(reduce_keys(rig, times, values, tolerance * 1e-3, posed, whole_pose=True))
        row[f"reduced {tolerance}"] = keys_a_bone(found[0])
        row[f"whole poses {tolerance}"] = keys_a_bone(poses)
        row[f"even {tolerance}"] = even_keys(rig, times, values, posed, tolerance * 1e-3)
    row["CPU"] = 1e3 * float(np.mean(seconds)) / frames
    return {**row, **with_planted_feet(trial, posture, rig)}


def with_planted_feet(trial: Trial, posture: Posture, rig: Rig) -> Row:
    """Errors [mm] of the motion, of the motion with planted feet, and of the latter in few keys."""
    body, times = trial.take.body, np.arange(len(trial.truth), dtype=np.float64)
    planted = run(plant_feet(body, posture, trial.tracks.time_s))
    allowed = point_tolerances(rig, len(times), BAKED_MM * 1e-3, planted.contacts)
    values = rig_values(rig, planted.posture, body)
    posed = np.array(trial.take.keyframe_indices, dtype=np.intp)
    keys = run(reduce_keys(rig, times, values, allowed, posed))
    places = point_places(rig, trial)
    baked = rig.pose([spline.evaluate(times, 0, len(times) - 1) for spline in keys.splines]).points
    row: Row = {"rests": len(planted.contacts)}
    for name, points in {
        "": body.points(body.pose(posture)),
        " planted": body.points(body.pose(planted.posture)),
        " baked": baked[:, places],
    }.items():
        score = trial.score(points)
        row[name.strip() or "mpjpe"] = score.mpjpe
        row["skate" + name] = float("nan") if score.skate is None else score.skate
    return row


def point_places(rig: Rig, trial: Trial) -> IndexArray:
    """(13,) index of each principal point among the rig's joints and ends."""
    body = trial.take.body
    rest = Posture.stack([keyframe.posture for keyframe in trial.take.keyframes])
    shown = rig.pose(rig_values(rig, rest, body)).points
    apart = np.linalg.norm(shown[:, :, None] - body.points(body.pose(rest))[:, None], axis=-1).max(axis=0)
    return np.asarray(apart.argmin(axis=0))


def keys_a_bone(keys: ReducedKeys) -> float:
    """Mean number of keys of a bone."""
    return float(np.mean([len(spline.keys) for spline in keys.splines]))


def even_keys(rig: Rig, times: Array, values: list[Array], posed: IndexArray, tolerance_m: float) -> float:
    """The fewest evenly spaced keys, besides the posed frames, that keep every point within a tolerance.

    Found by bisection, which assumes that more keys never increase the error.
    """
    goal, last = rig.pose(values).points, len(times) - 1

    def keys_of(count: int) -> IndexArray:
        even = np.round(np.linspace(0, last, count)).astype(np.intp)
        return np.asarray(np.union1d(even, posed))

    def holds(count: int) -> bool:
        fits = [fit_keys(times, data, keys_of(count), posed).evaluate(times, 0, last) for data in values]
        return bool(np.linalg.norm(rig.pose(fits).points - goal, axis=-1).max() <= tolerance_m)

    low, high = 1, len(times)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if holds(middle) else (middle, high)
    return float(len(keys_of(high)))


def table(takes: dict[str, Row], groups: dict[str, list[str]], columns: dict[str, int]) -> list[str]:
    """Rows by take, then the means of groups, as lines of Markdown."""
    rows = dict(takes)
    for group, names in groups.items():
        known = {column: [takes[name][column] for name in names] for column in columns}
        rows[f"**{group}**"] = {
            column: float(np.mean([value for value in values if np.isfinite(value)] or [np.nan]))
            for column, values in known.items()
        }
    lines = ["| take | " + " | ".join(columns) + " |", "|---" + "|---:" * len(columns) + "|"]
    for name, row in rows.items():
        cells = [
            f"{row[column]:.{digits}f}" if np.isfinite(row[column]) else ""
            for column, digits in columns.items()
        ]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return lines


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    takes: dict[str, Row] = {}
    members: dict[str, list[str]] = {group: [] for group in GROUPS}
    for name, folder in chosen_takes(parser.parse_args(arguments).takes).items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        takes[name] = measure(folder)
        members[group_of(folder)].append(name)
    groups = {group: names for group, names in members.items() if names}
    lines = [
        "Keys a bone by tolerance [mm]: each bone its own, whole poses, evenly spaced; processor time of the "
        "first [ms a frame].",
        "",
        *table(takes, groups, COLUMNS),
        "",
        f"Mean error and travel of standing ankles [mm]: as reconstructed, with planted feet, and that baked "
        f"within {BAKED_MM} mm.",
        "",
        *table(takes, groups, FEET),
    ]
    as_numbers: dict[str, Any] = {
        name: {key: value if np.isfinite(value) else None for key, value in row.items()}
        for name, row in takes.items()
    }
    write_results("finishing", "\n".join(lines), json.dumps(as_numbers, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
