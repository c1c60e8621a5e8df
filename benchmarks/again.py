"""Reconstruction after one keyframe changed: cost and difference of a warm start against a cold one.

Usage: again.py [TAKE ...] [--long] with names or folders of takes; by default all found. See README.md.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from clock import processor_time
from keyframing import exact_postures, hand_posed
from long_clip import lengthened, with_one_moved
from takes import GROUPS, chosen_takes, group_of, load_project, write_results

load_project()

from keymark.core.body.posture import Posture  # noqa: E402
from keymark.core.estimate.reconstruct import Reconstruction, reconstruct  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.score import read_truth  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402
from keymark.core.take.take_file import read_take  # noqa: E402
from trials import Trial  # noqa: E402

LONG_S = 100.0
"""Length of the clip that --long makes of the first take."""


@dataclass(frozen=True)
class Again:
    """One change, reconstructed from the previous solution and from scratch."""

    cost: float
    """Processor time as a share of the cold run's."""
    mean_mm: float
    """Mean distance of the points from those of the cold run."""
    p99_mm: float
    """99th percentile of that distance."""
    largest_mm: float
    """Largest such distance."""
    moved_mm: float
    """Mean distance by which the change itself moved the points."""


def nothing_changed(take: Take, _: Posture) -> Take:
    """The take without a change."""
    return take


def one_moved(take: Take, _: Posture) -> Take:
    """The take with its middle keyframe posed a little differently."""
    return with_one_moved(take)


def one_added(take: Take, posed: Posture) -> Take:
    """The take with one more keyframe, in the middle of the widest gap."""
    frames = np.array(take.keyframe_indices)
    widest = int(np.diff(frames).argmax())
    index = int(frames[widest] + frames[widest + 1]) // 2
    more = sorted((*take.keyframes, Keyframe(index, posed[index])), key=lambda keyframe: keyframe.index)
    return replace(take, keyframes=tuple(more))


def one_deleted(take: Take, _: Posture) -> Take:
    """The take without its middle keyframe."""
    middle = len(take.keyframes) // 2
    return replace(take, keyframes=(*take.keyframes[:middle], *take.keyframes[middle + 1 :]))


CHANGES: dict[str, Callable[[Take, Posture], Take]] = {
    "nothing": nothing_changed,
    "moved": one_moved,
    "added": one_added,
    "deleted": one_deleted,
}


def measure(take: Take, posed: Callable[[Reconstruction], Posture]) -> dict[str, Again]:
    """Reconstruct all changes of a take.

    Args:
        take: The take.
        posed: Maps the first reconstruction to the postures of all frames, of which one is added.
    """
    reading = run(reconstruct(take, "interpolation")).reading
    first = run(reconstruct(take, "map", reading))
    postures = posed(first)
    return {name: compared(change(take, postures), first) for name, change in CHANGES.items()}


def compared(take: Take, first: Reconstruction) -> Again:
    """Compare a changed take reconstructed from scratch and from a first reconstruction."""
    results: list[Reconstruction] = []

    def estimate(earlier: Reconstruction | None) -> None:
        results.append(run(reconstruct(take, "map", first.reading, earlier)))

    cold = processor_time(lambda: estimate(None))
    warm = processor_time(lambda: estimate(first))
    anew, again = (result.motion.points for result in results)
    apart = 1e3 * np.linalg.norm(again - anew, axis=-1)
    moved = 1e3 * np.linalg.norm(anew - first.motion.points, axis=-1)
    return Again(
        warm / cold,
        float(apart.mean()),
        float(np.percentile(apart, 99)),
        float(apart.max()),
        float(moved.mean()),
    )


def hand_posed_from_truth(take: Take) -> Callable[[Reconstruction], Posture]:
    """Hand-posed postures of all frames of a take with truth."""

    def posed(first: Reconstruction) -> Posture:
        truth = read_truth(take.folder / "truth.json", take.frame_start, first.tracks.frame_count)
        trial = Trial(take, first.reading, truth, take.keyframe_indices)
        return hand_posed(trial, exact_postures(trial))

    return posed


def measure_long(folder: Path) -> dict[str, Again]:
    """Measure the changes in a long clip made of a take; the added keyframe has the reconstructed posture."""
    take = read_take(folder)
    frames = run(reconstruct(take, "interpolation")).tracks.frame_count
    with tempfile.TemporaryDirectory() as temporary:
        place = lengthened(folder, max(1, round(LONG_S * take.fps / frames)), Path(temporary) / "long")
        return measure(read_take(place), lambda first: first.motion.posture)


def table(rows: dict[str, dict[str, Again]]) -> str:
    """All changes as Markdown."""
    lines = [
        "After one keyframe is changed: processor time as a share of a cold run's, and the points' distance "
        "from the cold run's [mm], beside what the change itself moved.",
        "",
        "| take | keyframe | cost | mean | 99 % | largest | the change |",
        "|---" * 2 + "|---:" * 5 + "|",
    ]
    for name, found in rows.items():
        for change, one in found.items():
            cells = [f"{one.cost:.2f}", f"{one.mean_mm:.2f}", f"{one.p99_mm:.1f}", f"{one.largest_mm:.1f}"]
            lines.append(f"| {name} | {change} | " + " | ".join([*cells, f"{one.moved_mm:.1f}"]) + " |")
    return "\n".join(lines)


def mean_of(rows: list[dict[str, Again]]) -> dict[str, Again]:
    """Means over takes, and the largest distance of any."""
    found = {}
    for change in CHANGES:
        several = [asdict(row[change]) for row in rows]
        means = {key: float(np.mean([one[key] for one in several])) for key in several[0]}
        found[change] = Again(**{**means, "largest_mm": max(one["largest_mm"] for one in several)})
    return found


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    parser.add_argument("--long", action="store_true", help="a long clip made of the first take instead")
    options = parser.parse_args(arguments)
    takes = chosen_takes(options.takes)
    rows: dict[str, dict[str, Again]] = {}
    if options.long:
        name, folder = next(iter(takes.items()))
        rows[f"{name}, {LONG_S:g} s"] = measure_long(folder)
    else:
        members: dict[str, list[dict[str, Again]]] = {group: [] for group in GROUPS}
        for name, folder in takes.items():
            print(f"{name} ...", file=sys.stderr, flush=True)
            take = read_take(folder)
            rows[name] = measure(take, hand_posed_from_truth(take))
            members[group_of(folder)].append(rows[name])
        rows |= {f"**{group}**": mean_of(several) for group, several in members.items() if several}
    as_numbers: dict[str, Any] = {
        name: {change: asdict(one) for change, one in found.items()} for name, found in rows.items()
    }
    write_results("again_long" if options.long else "again", table(rows), json.dumps(as_numbers, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
