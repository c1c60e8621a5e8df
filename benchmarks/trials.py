"""One take to test methods on: its markers are tracked once, and results are compared with its truth."""

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from takes import chosen_takes, load_project

load_project()

from auto_clamped import interpolate_auto_clamped  # noqa: E402
from keymark.core.api import reconstruct  # noqa: E402
from keymark.core.arrays import Array  # noqa: E402
from keymark.core.body.posture import Posture  # noqa: E402
from keymark.core.body.posture_spline import find_intervals  # noqa: E402
from keymark.core.detect.keypoint_file import read_keypoints  # noqa: E402
from keymark.core.markers.reading import Reading  # noqa: E402
from keymark.core.markers.region_tracks import RegionTracks  # noqa: E402
from keymark.core.prior.keyframes import Keyframe, interpolate  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.score import Score, read_truth, score_points  # noqa: E402
from keymark.core.take.motion import Motion  # noqa: E402
from keymark.core.take.read_footage import read_footage  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402
from keymark.core.take.take_file import read_take  # noqa: E402


def interpolate_linearly(keyframes: tuple[Keyframe, ...], frame_count: int) -> Posture:
    """Constant velocity between keyframes (slerp): the plainest baseline."""
    knots = np.array([keyframe.index for keyframe in keyframes], dtype=np.float64)
    posed = Posture.stack([keyframe.posture for keyframe in keyframes])
    interval, elapsed = find_intervals(knots, np.arange(frame_count, dtype=np.float64))
    share = elapsed / np.diff(knots)[interval]
    return posed[interval].plus(share[:, None] * posed[1:].minus(posed[:-1])[interval])


KEYPOINTS = "keypoints_mediapipe.json"
"""File of a detector's keypoints in a take's folder."""
INTERPOLATIONS = {
    "linear": interpolate_linearly,
    "auto-clamped": interpolate_auto_clamped,
    "prior": interpolate,
}
"""Keyframe interpolations, which do without the footage; README.md describes each."""


@dataclass(frozen=True, eq=False)
class Trial:
    """A take as a method's input, and its truth, which the method does not see."""

    take: Take
    reading: Reading
    truth: Array
    """(F, 13, 3) true points [m]."""
    unscored: tuple[int, ...]
    """Frames, from 0, that count in no mean, such as the keyframes."""

    @property
    def tracks(self) -> RegionTracks:
        """The markers' regions."""
        return self.reading.tracks

    def interpolated(self) -> dict[str, Array]:
        """Points (F, 13, 3) [m] of every interpolation of the keyframes."""
        body, keyframes, count = self.take.body, self.take.keyframes, len(self.truth)
        return {
            name: body.points(body.pose(interpolation(keyframes, count)))
            for name, interpolation in INTERPOLATIONS.items()
        }

    def estimated(self, method: str) -> Motion:
        """The motion by `map` or `ekf`."""
        return run(reconstruct(self.take, method, self.reading)).motion

    def score(self, points: Array, sigma_m: Array | None = None) -> Score:
        """Score of points (F, 13, 3) against the truth."""
        return score_points(points, self.truth, self.unscored, self.take.camera, sigma_m)

    def best_interpolation(self) -> Score:
        """The score of the interpolation nearest to the truth."""
        scores = [self.score(points) for points in self.interpolated().values()]
        return min(scores, key=lambda score: score.mpjpe)


def read_trial(folder: Path, keyframes: Path | None = None) -> Trial:
    """Read a take with its own keyframes, or with those of a file, and track its markers."""
    take = read_take(folder, keyframes)
    reading = run(reconstruct(take, "interpolation")).reading
    truth = read_truth(folder / "truth.json", take.frame_start, reading.tracks.frame_count)
    return Trial(take, reading, truth, take.keyframe_indices)


def read_unposed(folder: Path) -> Trial:
    """A take read without its keyframes, which then do not guide the tracking of markers either."""
    take = replace(read_take(folder), keyframes=())
    reading = run(read_footage(take))
    return Trial(
        take, reading, read_truth(folder / "truth.json", take.frame_start, reading.tracks.frame_count), ()
    )


def unposed_trials(names: Sequence[str], keypoints: bool, plain: bool = False) -> Iterator[tuple[str, Trial]]:
    """Named takes, or all with truth, each with its name and read without its keyframes.

    Args:
        names: Names or folders of takes; none for all.
        keypoints: Whether a detector's keypoints are followed as well; takes without any are then left out,
            else those without markers.
        plain: Whether takes in plain clothes are among all.

    Raises:
        SystemExit: No take is left.
    """
    takes = chosen_takes(names, plain)
    chosen = {name: at for name, at in takes.items() if not keypoints or (at / KEYPOINTS).is_file()}
    if not chosen:
        raise SystemExit(f"none of the takes has {KEYPOINTS}")
    for name, folder in chosen.items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        if keypoints:
            yield name, with_keypoints(read_unposed(folder), folder)
        elif read_take(folder).markers:
            yield name, read_unposed(folder)


def with_keypoints(trial: Trial, folder: Path) -> Trial:
    """The same take with the keypoints in its folder."""
    take, tracks = trial.take, trial.reading.tracks
    people = read_keypoints(folder / KEYPOINTS, tracks.frame_count, tracks.size, take.fps, take.frame_start)
    return replace(trial, take=replace(take, keypoints=(people,)))
