"""`keymark demo`: convert the demonstration take, whose true motion is known, and score the result."""

import argparse
from collections.abc import Mapping

from ....core.errors import InputError
from ....core.estimate.reconstruct import reconstruct
from ....core.progress import run
from ....core.review.score import Score, read_truth, score_points
from ....core.take.conversion_settings import ConversionSettings
from ....core.take.description import describe
from ....core.take.motion import Motion
from ....core.take.take import Take
from ..console import arguments_console
from ..conversion.blender_files import BLEND
from ..conversion.convert_take import REPORT, convert_take
from ..version import ROOT
from .convert import conversion_summary

DEMO = ROOT / "presets" / "demo" / "aerobic"
KEYFRAMES = DEMO / "keyframes_noisy.json"
"""Keyframes with the errors that a person makes when posing."""
COLUMNS = {"mpjpe": "all", "rooted": "about hips", "depth": "in depth", "image": "across", "jitter": "jitter"}


def demo_command(arguments: argparse.Namespace) -> None:
    """Convert the demonstration take and print the error of each method."""
    if not DEMO.is_dir():
        raise InputError(
            f"{DEMO}: the demonstration take is missing from this installation; install Keymark anew"
        )
    with arguments_console(arguments) as console:
        done = convert_take(
            describe(DEMO), arguments.output, console, ConversionSettings(KEYFRAMES), arguments.debug
        )
        console.stage("Trying the paper's filter")
        filtered = run(reconstruct(done.take, "ekf", done.reconstruction.reading))
        scores = {
            "interpolation": _score(done.take, done.reconstruction.interpolation),
            "ekf": _score(done.take, filtered.motion),
            "map": _score(done.take, done.reconstruction.motion),
        }
        result = {
            **conversion_summary(done),
            "scores_mm": {name: score.to_dict() for name, score in scores.items()},
        }
        output = arguments.output
        lines = [
            f"Error against the true motion of {scores['map'].frames} frames, posed in "
            f"{scores['map'].keyframes} of them, in millimeters:",
            *_table(scores),
            f"Open in Blender: {output / BLEND}",
            f"Pictures:        {output / REPORT}",
        ]
        console.finish(result, "\n".join(lines))


def _score(take: Take, motion: Motion) -> Score:
    truth = read_truth(DEMO / "truth.json", motion.frame_start, len(motion.time_s))
    known = motion.method != "interpolation"
    sigma = motion.sigma_m if known else None
    return score_points(motion.points, truth, motion.keyframe_indices, take.camera, sigma)


def _table(scores: Mapping[str, Score]) -> list[str]:
    lines = [" " * 16 + "".join(f"{title:>12}" for title in COLUMNS.values())]
    for name, score in scores.items():
        values = score.to_dict()
        lines.append(f"  {name:14}" + "".join(f"{values[column]:12.1f}" for column in COLUMNS))
    return lines
