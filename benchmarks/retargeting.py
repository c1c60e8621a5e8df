"""Retargeting: how well a motion ends on characters, beside what copying rotations makes of it.

Usage: retargeting.py [TAKE ...] with names or folders of takes with truth; by default all. See README.md.
"""

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from keyframing import exact_postures, hand_posed, keyed
from takes import chosen_takes, load_project, write_results
from trials import read_trial

load_project()

from _armatures import (  # noqa: E402
    add_rig,
    build_character,  # noqa: E402
    rigify_file,
)
from _characters import plain_character, shared_characters  # noqa: E402
from _varied import varied  # noqa: E402
from keymark.core.body.kinematics import SegmentMotion, segment_motion  # noqa: E402
from keymark.core.errors import InputError  # noqa: E402
from keymark.core.feet.natural_extremities import natural_extremities  # noqa: E402
from keymark.core.progress import Progress, run  # noqa: E402
from keymark.core.retarget.quality import Quality  # noqa: E402
from keymark.core.retarget.recognition.recognize import recognize  # noqa: E402
from keymark.core.take.conversion_settings import RetargetOptions  # noqa: E402
from keymark.core.take.motion import Motion  # noqa: E402
from keymark.operators.bridge.actions import curves_of  # noqa: E402
from keymark.operators.bridge.armature import build_armature  # noqa: E402
from keymark.operators.bridge.character.measure import measure  # noqa: E402
from keymark.operators.bridge.character.read_character import read_character  # noqa: E402
from keymark.operators.bridge.character.retarget import Retargeted, retarget  # noqa: E402
from keymark.operators.bridge.fcurves import write_motion  # noqa: E402
from rotation_copying import copy_rotations, sized_actor  # noqa: E402

SEEDS = (1001, 1002, 1003, 1004)
"""Characters drawn at random; none that a test looks at."""
METHODS = ("Keymark", "copied rotations")
COLUMNS = {
    "arms_deg": ("arms", 1),
    "legs_deg": ("legs", 1),
    "skate_mm": ("skate", 3),
    "penetration_mm": ("below floor", 1),
    "hands_mm": ("hands", 1),
    "hands_floor_mm": ("hands at floor", 1),
    "ik_fk_mm": ("IK to FK", 2),
    "keys_share": ("keys", 0),
    "curve_share": ("keys a curve", 0),
    "ms_a_frame": ("ms a frame", 1),
}
MEASURING = "Measuring the character"
"""The last stage of retargeting, which the peer has none of: its time is left out."""
WORST = ("penetration_mm", "hands_floor_mm", "ik_fk_mm")
"""Columns of which the worst take counts, not the mean."""
Row = dict[str, float]
Maker = Callable[[], bpy.types.Object]


def characters(folder: Path) -> dict[str, Maker]:
    """What makes each character's armature object, by name; those that are generated go into `folder`."""
    found: dict[str, Maker] = {"Rigify basic human": lambda: add_rig(rigify_file(folder))}
    found |= {
        f"MPFB {name}": lambda one=one: build_character(one) for name, one in shared_characters().items()
    }
    found["plain, relaxed arms, scale 0.01"] = lambda: build_character(
        plain_character(arms_down_deg=70.0, scale=0.01, roll_rad=0.4)
    )
    found["plain, no shoulders or toes"] = lambda: build_character(
        plain_character(arms_down_deg=45.0, without=("shoulder", "toe", "chest"))
    )
    found |= {f"random {seed}": lambda seed=seed: build_character(varied(seed).character) for seed in SEEDS}
    return found


def motions(takes: dict[str, Path]) -> Iterator[tuple[str, Motion]]:
    """Each take's motion by `map` from hand-posed keyframes."""
    for name, folder in takes.items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        trial = read_trial(folder)
        trial = keyed(trial, hand_posed(trial, exact_postures(trial)), trial.take.keyframe_indices)
        yield name, trial.estimated("map")


def measured(make: Maker, motion: Motion) -> dict[str, Row]:
    """The figures of one motion on one character, by method."""
    source = segment_motion(
        motion.body,
        motion.posture,
        motion.time_s,
        natural_extremities(motion.body, motion.posture, motion.time_s),
    )
    frames = motion.frame_start + np.arange(len(motion.time_s), dtype=np.float64)
    own, written = _retargeted(make, source, frames)
    return {METHODS[0]: own, METHODS[1]: _copied(make, motion, source, frames, written)}


def _scene(frames: np.ndarray) -> bpy.types.Scene:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = int(frames[0]), int(frames[-1])
    return scene


def _retargeted(make: Maker, source: SegmentMotion, frames: np.ndarray) -> tuple[Row, Retargeted]:
    scene = _scene(frames)
    armature = make()
    character = read_character(armature)
    character_map = recognize(character).character_map
    started, seconds = time.process_time(), 0.0

    def report(progress: Progress) -> None:
        nonlocal seconds
        if progress.stage != MEASURING:
            seconds = time.process_time() - started

    job = retarget(armature, source, frames, character_map, RetargetOptions())
    result = run(job, report)
    curves = curves_of(result.write(scene, "Motion"), armature).values()
    median = float(np.median([len(curve.keyframe_points) for curve in curves]))
    row = _row(result.quality, seconds, len(frames)) | {"curve_share": 100.0 * median / len(frames)}
    return row, result


def _copied(make: Maker, motion: Motion, source: SegmentMotion, frames: np.ndarray, own: Retargeted) -> Row:
    """The peer's figures: on a plain skeleton, by the very same measure."""
    scene = _scene(frames)
    armature = make()
    character = read_character(armature)
    actor = build_armature(scene, motion.body)
    write_motion(actor, motion, frames=frames)
    sized_actor(actor, source, own.motion.size)
    started = time.process_time()
    action = copy_rotations(actor, armature, own.character_map, (int(frames[0]), int(frames[-1])))
    seconds = time.process_time() - started
    found = run(measure(armature, action, frames, source, own.motion, character, own.character_map, (), {}))
    return _row(found.quality, seconds, len(frames)) | {"keys_share": 100.0}


def _row(quality: Quality, seconds: float, frame_count: int) -> Row:
    row = {name: float(value) for name, value in asdict(quality).items() if value is not None}
    if quality.keys and quality.dense_keys:
        row["keys_share"] = 100.0 * quality.keys / quality.dense_keys
    return row | {"ms_a_frame": 1e3 * seconds / frame_count}


def summary(rows: list[Row]) -> Row:
    """One row of several takes: means, and the worst of `WORST`."""
    found = {}
    for column in COLUMNS:
        values = [row[column] for row in rows if column in row]
        if values:
            found[column] = float(max(values) if column in WORST else np.mean(values))
    return found


def table(results: dict[str, dict[str, list[Row]]]) -> list[str]:
    """Lines of Markdown: a row a character and method."""
    titles = [title for title, _ in COLUMNS.values()]
    lines = ["| character | method | " + " | ".join(titles) + " |", "|---|---" + "|---:" * len(titles) + "|"]
    for name, by_method in results.items():
        for method, rows in by_method.items():
            row = summary(rows)
            cells = [
                f"{row[column]:.{digits}f}" if column in row else ""
                for column, (_, digits) in COLUMNS.items()
            ]
            lines.append(f"| {name} | {method} | " + " | ".join(cells) + " |")
    return lines


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    chosen = chosen_takes(parser.parse_args(arguments).takes)
    results: dict[str, dict[str, list[Row]]] = {}
    refused: dict[str, str] = {}
    by_take: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as folder:
        makers = characters(Path(folder))
        for take, motion in motions(chosen):
            for name, make in makers.items():
                try:
                    found = measured(make, motion)
                except InputError as error:
                    refused[name] = str(error)
                    continue
                by_take.setdefault(take, {})[name] = found
                for method, row in found.items():
                    results.setdefault(name, {}).setdefault(method, []).append(row)
    lines = [
        f"Means of {', '.join(by_take)} (below floor, hands at floor, IK to FK: the worst). Directions "
        "against the performer's [degrees]; way of resting feet [mm a frame]; soles below the floor, hands "
        "from where they belong, IK from FK [mm]; keys, and those of the median curve [% of one on every "
        "frame]; processor time.",
        "",
        *table(results),
        *(f"\nRefused: {name}: {why}" for name, why in refused.items()),
    ]
    write_results("retargeting", "\n".join(lines), json.dumps(by_take, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
