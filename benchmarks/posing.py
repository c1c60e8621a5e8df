"""Assisted posing: errors of a start and of the pose fitted from it to one frame's markers.

Usage: posing.py [TAKE ...] with names or folders of takes with truth; by default all found. See README.md.
"""

import argparse
import json
import sys
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from clock import processor_time
from keyframing import exact_postures, hand_posed, keyed
from takes import GROUPS, chosen_takes, group_of, load_project, write_results
from trials import Trial, read_trial

load_project()

from keymark.core.body.posture import Posture  # noqa: E402
from keymark.core.estimate.single_frame import FrameFit, calibrated, fit_frame  # noqa: E402
from keymark.core.estimate.terms.regions import ObservedRegions  # noqa: E402
from keymark.core.observation.regions import MarkerPlacement, RegionModel  # noqa: E402
from keymark.core.prior.frame_prior import FramePrior, prior_from_keyframes  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402

STARTS = ("earlier", "between")
"""All earlier keyframes; those before and after. A frame without any is measured by frame_poses.py."""
TITLES = (
    *("take", "start", "fits", "error: start", "fit", "across: start", "fit"),
    *("markers: start", "fit", "worse", "CPU"),
)


@dataclass(frozen=True)
class Fit:
    """One frame fitted from one start."""

    start_mm: float
    """Mean distance of the 13 points from the truth, of the start."""
    fit_mm: float
    """The same of the fit."""
    across_start_mm: float
    """Part of the start's distance across the lines of sight, which the picture shows."""
    across_fit_mm: float
    start_px: float
    """Mean distance of the markers' centroids from the observed ones, of the start."""
    fit_px: float
    """The same of the fit."""
    cpu_ms: float
    """Processor time, calibration on the keyframes included."""

    @property
    def worse(self) -> bool:
        """Whether the fit is farther from the truth than the start."""
        return self.fit_mm > self.start_mm


def measure(trial: Trial) -> dict[str, list[Fit]]:
    """Fit the pose at every keyframe of a trial, by start; the other keyframes are the trial's."""
    found: dict[str, list[Fit]] = {start: [] for start in STARTS}
    for number, keyframe in enumerate(trial.take.keyframes):
        if not trial.tracks.visible[keyframe.index].any():
            continue
        earlier = trial.take.keyframes[:number]
        others = (*earlier, *trial.take.keyframes[number + 1 :])
        if earlier:
            found["earlier"].append(fitted(trial, keyframe.index, earlier))
        if earlier and len(earlier) < len(others):
            found["between"].append(fitted(trial, keyframe.index, others))
    return found


def fitted(trial: Trial, index: int, posed: tuple[Keyframe, ...]) -> Fit:
    """The operator's fit of one frame, given some posed keyframes, compared with the truth."""
    take = trial.take
    placements = tuple(MarkerPlacement.usual(segment) for segment in take.marker_segments)
    model = RegionModel(take.body, take.camera, placements)
    observed = ObservedRegions.from_tracks(trial.tracks)
    results: list[tuple[FramePrior, FrameFit]] = []

    def fit() -> None:
        belief = prior_from_keyframes(posed, index, take.fps)
        frames = np.array([keyframe.index for keyframe in posed], dtype=np.intp)
        postures = Posture.stack([keyframe.posture for keyframe in posed])
        evidence = calibrated(model, observed[frames], postures, frames)
        seen = observed[np.array([index], dtype=np.intp)]
        results.append((belief, fit_frame(evidence, seen, belief, index)))

    seconds = processor_time(fit)
    belief, fit_found = results[0]
    start_m, across_start_m = distances(trial, belief.posture, index)
    fit_m, across_fit_m = distances(trial, fit_found.posture, index)
    return Fit(
        1e3 * start_m,
        1e3 * fit_m,
        1e3 * across_start_m,
        1e3 * across_fit_m,
        float(np.nanmean(fit_found.before_px)),
        float(np.nanmean(fit_found.residual_px)),
        1e3 * seconds,
    )


def distances(trial: Trial, posture: Posture, index: int) -> tuple[float, float]:
    """Mean distance [m] of a posture's points from a frame's true ones, and its part across the sight."""
    body, camera = trial.take.body, trial.take.camera
    points, truth = body.points(body.pose(Posture.stack([posture])))[0], trial.truth[index]
    sight = truth - camera.pose(index)[1]
    sight /= np.linalg.norm(sight, axis=-1, keepdims=True)
    error = points - truth
    across = error - np.sum(error * sight, axis=-1, keepdims=True) * sight
    return float(np.linalg.norm(error, axis=-1).mean()), float(np.linalg.norm(across, axis=-1).mean())


def summary(fits: Iterable[Fit]) -> dict[str, float]:
    """Means over fits, and the share of fits that are worse than their start."""
    rows = list(fits)
    means = {name: float(np.mean([asdict(fit)[name] for fit in rows])) for name in asdict(rows[0])}
    return {**means, "worse": float(np.mean([fit.worse for fit in rows])), "fits": float(len(rows))}


def table(rows: dict[str, dict[str, dict[str, float]]]) -> str:
    """Summaries by take or group, and start, as Markdown."""
    lines = [
        "Mean error of the start and of the fitted pose [mm], the part of it across the lines of sight, the "
        "markers' distance [px], share of fits that are worse than their start, processor time a fit [ms].",
        "",
        "| " + " | ".join(TITLES) + " |",
        "|---" * 2 + "|---:" * (len(TITLES) - 2) + "|",
    ]
    for name, found in rows.items():
        for start, one in found.items():
            cells = [
                f"{one['fits']:.0f}",
                *(f"{one[key]:.1f}" for key in ("start_mm", "fit_mm", "across_start_mm", "across_fit_mm")),
                *(f"{one[key]:.1f}" for key in ("start_px", "fit_px")),
                f"{one['worse']:.2f}",
                f"{one['cpu_ms']:.0f}",
            ]
            lines.append(f"| {name} | {start} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    takes: dict[str, dict[str, list[Fit]]] = {}
    groups: dict[str, dict[str, list[Fit]]] = {group: {start: [] for start in STARTS} for group in GROUPS}
    for name, folder in chosen_takes(parser.parse_args(arguments).takes).items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        trial = read_trial(folder)
        posed = hand_posed(trial, exact_postures(trial))
        takes[name] = measure(keyed(trial, posed, trial.take.keyframe_indices))
        for start, fits in takes[name].items():
            groups[group_of(folder)][start] += fits
    everything = takes | {f"**{group}**": found for group, found in groups.items() if found[STARTS[0]]}
    rows = {
        name: {start: summary(fits) for start, fits in found.items() if fits}
        for name, found in everything.items()
    }
    as_lists: dict[str, Any] = {
        name: {start: [asdict(fit) for fit in fits] for start, fits in found.items()}
        for name, found in takes.items()
    }
    write_results("posing", table(rows), json.dumps({"summary": rows, "fits": as_lists}, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
