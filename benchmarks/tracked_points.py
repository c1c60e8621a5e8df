"""Motion tracks as an animator sets them: six points of the body, each a little off and drifting."""

import numpy as np
from keyframing import random_source
from takes import load_project
from trials import Trial

load_project()

from keymark.core.arrays import Array  # noqa: E402
from keymark.core.body.human import HUMAN  # noqa: E402
from keymark.core.detect.keypoints import People, SeenPeople  # noqa: E402

TRACKED = ("head", "wrist.L", "wrist.R", "hip.L", "ankle.L", "ankle.R")
OFF_M = 0.03
"""Distance of a patch of cloth from the joint's center, as seen in the picture [m]."""
DRIFT_M = 0.02
"""Standard deviation of a track's drift about that ..."""
DRIFT_FRAMES = 30
"""... and the frames in which two thirds of it are forgotten."""
JITTER_PX = 0.4


def tracked_people(trial: Trial) -> People:
    """The true points as Blender's tracker would follow them, from a seed of the take."""
    random = random_source(trial)
    camera, frames = trial.take.camera, len(trial.truth)
    own = [HUMAN.point_names.index(name) for name in TRACKED]
    true = trial.truth[:, own]
    pixel, depth = camera.project(true, np.arange(frames)[:, None])
    scale = camera.focal_px / np.maximum(depth, 0.1)
    off = OFF_M / np.sqrt(2.0) * random.standard_normal((len(TRACKED), 2))
    drift = _wander(random, (frames, len(TRACKED), 2)) * DRIFT_M / np.sqrt(2.0)
    seen = pixel + (off + drift) * scale[..., None] + JITTER_PX * random.standard_normal(pixel.shape)
    score, hint = np.ones((1, len(TRACKED))), np.full((1, len(TRACKED), 3), np.nan)
    people = tuple(SeenPeople(one[None], score, hint) for one in seen)
    return People(TRACKED, "tracks", camera.resolution, people)


def _wander(random: np.random.Generator, shape: tuple[int, ...]) -> Array:
    """A first-order process of unit deviation along the first axis."""
    kept = float(np.exp(-1.0 / DRIFT_FRAMES))
    steps = random.standard_normal(shape)
    steps[1:] *= np.sqrt(1.0 - kept**2)
    for frame in range(1, shape[0]):
        steps[frame] += kept * steps[frame - 1]
    return np.asarray(steps)
