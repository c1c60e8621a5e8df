"""What each lever of the whole-clip estimate is worth: each off by itself.

Usage: levers.py [TAKE ...] [--off LEVER ...] [--evidence KIND ...]. See README.md beside this file.
"""

import argparse
import json
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from evidence import detected
from takes import chosen_takes, load_project, write_results
from trials import Trial, read_trial

load_project()

from keymark.core import api  # noqa: E402
from keymark.core.estimate import (  # noqa: E402
    contour_evidence,
    contour_search,
    keyframe_evidence,
    reconstruct,
    refinement,
    whole_clip,
    window_problem,
)
from keymark.core.estimate.keypoint_trust import KeypointTrust  # noqa: E402
from keymark.core.markers import regions as segmentation  # noqa: E402
from keymark.core.markers.moments import Coverage  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.take.evidence import CONTOURS, KEYPOINTS, MARKERS  # noqa: E402
from keymark.core.take.read_footage import read_footage  # noqa: E402
from keymark.core.take.take import with_evidence  # noqa: E402
from keymark.core.terms import region_model, regions  # noqa: E402
from keymark.core.terms.contact import StillnessTerm  # noqa: E402
from keymark.core.terms.motion import LimitTerm  # noqa: E402

Switch = tuple[Any, str, Any]  # a module, a name in it, and what stands in for that
EVIDENCE = {"markers": (MARKERS, CONTOURS), "keypoints": (KEYPOINTS, CONTOURS), "contours": (CONTOURS,)}
ALL = "all of it"


def job(result: Callable[..., Any]) -> Callable[..., Any]:
    """A job that is done at once."""

    def done(*given: Any) -> Any:
        yield from ()
        return result(*given)

    return done


def without(term: type) -> tuple[Switch, ...]:
    """A switch that leaves out a term."""
    terms = window_problem.window_terms
    return ((window_problem, "window_terms", lambda *of: [t for t in terms(*of) if not isinstance(t, term)]),)


def trusting(model: Any, sources: tuple[str, ...], *_: Any) -> KeypointTrust:
    """All keypoints are believed."""
    return KeypointTrust(np.ones(len(sources)), np.full(len(sources), np.nan), {})


def without_album(body: Any, camera: Any, seen: Any, *more: Any, **named: Any) -> Any:
    """The estimate without contours."""
    return estimate(body, camera, replace(seen, album=None), *more, **named)


def unjudged(model: Any, at: Any, belief: Any) -> Any:
    """What keyframes say without contours."""
    return read_belief(model, replace(at, contours=None), belief)


find_shifts, read_belief = contour_evidence.find_shifts, whole_clip.read_belief
estimate = reconstruct.estimate_whole_clip
no_variance: Callable[..., Any] = lambda area, *_: np.zeros((*area.shape, regions.FEATURES))  # noqa: E731
OFF: Mapping[str, tuple[Switch, ...]] = {
    ALL: (),
    "contours": ((reconstruct, "estimate_whole_clip", without_album),),
    "nine looks: five": ((contour_search, "LOOKS", 5),),
    "shifts along limbs": (
        (
            contour_evidence,
            "find_shifts",
            lambda *of: replace(s := find_shifts(*of), variance=s.variance + np.inf),
        ),
    ),
    "shapes of parts": ((contour_evidence, "_fit_shapes", job(lambda model, *_: model)),),
    "contours judge keyframes": ((whole_clip, "read_belief", unjudged),),
    "size of posing errors": ((keyframe_evidence, "SCALES", np.ones(1)),),
    "distrust of markers": ((keyframe_evidence, "_distrust", lambda of, _: np.ones(of.shape[1])),),
    "matting": (
        (
            segmentation,
            "coverage",
            lambda _, m: Coverage(np.flatnonzero(m), np.ones(int(m.sum()), np.float32)),
        ),
    ),
    "edge of the picture": ((region_model, "near_edge", lambda _, area, __: np.zeros(area.shape[:2], bool)),),
    "variance of what is missing": (
        (regions, "missing_variance", no_variance),
        (keyframe_evidence, "missing_variance", no_variance),
    ),
    "turns": ((refinement, "choose_turns", job(lambda problem, states: (problem, states))),),
    "sizes of motion": ((refinement, "adapted", job(lambda problem, _, states: (problem, states))),),
    "sizes of limbs": ((refinement, "limb_sizes", lambda problem, *_: problem.limb_size),),
    "sizes of depth": ((refinement, "_depth_factor", lambda problem, *_: problem.depth_factor),),
    "feet at rest": without(StillnessTerm),
    "joint limits": without(LimitTerm),
    "annealing": ((window_problem, "TEMPERATURES", (1.0,) * len(window_problem.TEMPERATURES)),),
    "errors of keypoints learned": ((keyframe_evidence, "learned_std", lambda *of: of[3]),),
    "trust of keypoints": ((whole_clip, "keypoint_trust", trusting),),
    "swaps of keypoints": ((whole_clip, "find_swaps", lambda points, *_: np.zeros(points.seen.shape, bool)),),
    "doubt at swaps": ((whole_clip, "doubted_at_changes", lambda points, *_: points),),
}  # what is replaced to have a lever off


def measured(trial: Trial, evidence: str, lever: str) -> tuple[float, float]:
    """Mean error [mm] of a take held against some evidence with a lever off, and the coverage of 95 %."""
    take = with_evidence(trial.take, EVIDENCE[evidence])
    with ExitStack() as stack:
        for switch in OFF[lever]:
            stack.enter_context(patch.object(*switch))
        fresh = lever == "matting" or take.markers != trial.take.markers
        reading = run(read_footage(take)) if fresh else trial.reading
        motion = run(api.reconstruct(take, "map", reading)).motion
    score = trial.score(motion.points, motion.sigma_m)
    return score.mpjpe, score.coverage95 or 0.0


@cache
def trial_of(folder: Path) -> Trial:
    """A take with exact keyframes and the keypoints in its folder."""
    trial = read_trial(folder, folder / "keyframes.json")
    people = detected(folder, trial)
    return replace(trial, take=replace(trial.take, keypoints=() if people is None else (people,)))


def rows(folders: Mapping[str, Path], evidence: str, levers: list[str]) -> Iterator[tuple[str, ...]]:
    """Of each lever: its name, mean error and coverage, mean and largest error relative to all levers."""
    needed = {MARKERS: "markers", KEYPOINTS: "keypoints"}.get(EVIDENCE[evidence][0])
    trials = [trial_of(folder) for folder in folders.values()]
    trials = [trial for trial in trials if needed is None or getattr(trial.take, needed)]
    whole = np.array([measured(trial, evidence, ALL) for trial in trials])
    for lever in levers:
        found = whole if lever == ALL else np.array([measured(trial, evidence, lever) for trial in trials])
        share = found[:, 0] / whole[:, 0]
        mean, covered = found.mean(axis=0)
        values = (f"{mean:.1f}", f"{covered:.3f}", f"{share.mean():.3f}", f"{share.max():.2f}")
        yield evidence, lever, *values


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    parser.add_argument("--off", nargs="+", choices=OFF, default=list(OFF), metavar="LEVER")
    parser.add_argument("--evidence", nargs="+", choices=EVIDENCE, default=list(EVIDENCE), metavar="KIND")
    options = parser.parse_args(arguments)
    folders = chosen_takes(options.takes, plain=True)
    head = ("evidence", "off", "error", "covered", "share", "largest share")
    table = [head, ("---",) * 2 + ("---:",) * 4]
    for evidence in options.evidence:
        for row in rows(folders, evidence, list(dict.fromkeys((ALL, *options.off)))):
            print(*row, file=sys.stderr, flush=True)
            table.append(row)
    write_results(
        "levers", "\n".join("| " + " | ".join(row) + " |" for row in table), json.dumps(table, indent=1)
    )
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
