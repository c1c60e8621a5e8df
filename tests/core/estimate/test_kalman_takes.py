"""The paper's filter on rendered takes with truth, from the clip to the motion."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from _consistency import coverage
from keymark.core.estimate.reconstruct import reconstruct
from keymark.core.progress import run
from keymark.core.take.take_file import read_take


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "keyframes"), [("walk", "keyframes_noisy.json"), ("aerobic", "keyframes.json")]
)
def test_the_filter_beats_interpolation_and_knows_its_errors(
    take_folder: Callable[[str], Path], name: str, keyframes: str
) -> None:
    """On frames between keyframes it is at least a tenth closer, with an honest covariance in every frame."""
    folder = take_folder(name)
    take = read_take(folder, folder / keyframes)
    truth = json.loads((folder / "truth.json").read_text())["points"]
    true = np.stack([np.array(truth[point]) for point in take.body.skeleton.point_names], axis=1)
    done = run(reconstruct(take, "ekf"))
    assert done.motion.method == "ekf"
    assert set(done.motion.diagnostics) >= {"normalized_innovation_squared", "gated"}
    between = np.setdiff1d(np.arange(len(true)), done.motion.keyframe_indices)
    error, plain = (
        np.linalg.norm(motion.points - true, axis=-1) for motion in (done.motion, done.interpolation)
    )
    assert error[between].mean() < 0.9 * plain[between].mean()
    assert 0.9 < coverage(error, done.motion.sigma_m) < 0.995
