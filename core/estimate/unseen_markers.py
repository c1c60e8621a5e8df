"""Negative evidence: a marker that should be seen and is not.

Visibility has no useful slope by a posture, so this is a cost by which whole hypotheses are compared, such as
a limb on either side of another in depth.
"""

import numpy as np
from scipy.ndimage import maximum_filter1d

from ..arrays import Array, BoolArray
from ..footage.camera import Camera
from ..observation.regions import RegionPrediction
from ..prior.process_noise import REFERENCE_STEP_S
from .clip_problem import ClipProblem
from .clip_state import ClipState
from .terms.regions import ObservedRegions

HALF_FOUND, FOUND_SLOPE = 0.27, 11.0
"""Visible share of which a region is found as often as not, and the slope of the log odds: of 6,800 regions
of true postures, 2 in 100 below a share of 0.05 were found, 58 at 0.25, 86 at 0.45, 97 at 0.65, all but 4 of
1,000 above 0.7."""
USUAL_MISSES, SURE_OF_IT = 0.01, 20.0
"""Share of wholly visible regions that are missed, and the keyframes that this belief is worth."""
NEIGHBORS_S = 0.5
"""Time before and after within which a region's best quality tells how well it could be seen."""
EDGE_SHARE = 2.0
"""Regions are cut off nearer to the picture's edge than this many of their deviations."""


def unseen_cost(problem: ClipProblem, state: ClipState, findable: Array) -> Array:
    """(F,) negative logarithm of the probability that the markers which are not seen are not found.

    Nearly zero where every marker predicted to be visible was found. It joins the costs of what is seen.

    Args:
        problem: The clip's problem.
        state: Any state of F of its frames.
        findable: (F, M) what `findable_share` says of the clip, once for all states of it that are compared.
    """
    model = problem.evidence.model
    found = found_share(model.evaluate(state.pose, state.frame), model.camera)
    seen = np.isfinite(problem.observed.centroid[state.frame, :, 0])
    could = findable[state.frame]
    return np.asarray(np.where(seen, 0.0, -np.log1p(-could * found)).sum(-1))


def findable_share(problem: ClipProblem) -> Array:
    """(F, M) how surely each marker of a whole clip is found where it is wholly visible."""
    return _quality_near(problem.observed, problem.step_s) * (1.0 - missed_share(problem))


def missed_share(problem: ClipProblem) -> Array:
    """(M,) share of each marker's regions that are missed though they should be seen, at the keyframes."""
    frame, model = problem.keyframes, problem.evidence.model
    pose = model.body.pose(problem.prior[frame])
    found = found_share(model.evaluate(pose, frame), model.camera)
    unseen = ~np.isfinite(problem.observed.centroid[frame, :, 0])
    missed = (found * unseen).sum(axis=0) + USUAL_MISSES * SURE_OF_IT
    return np.asarray(missed / (found.sum(axis=0) + SURE_OF_IT))


def found_share(predicted: RegionPrediction, camera: Camera) -> Array:
    """(F, M) share of such regions that are found where colors and light are good."""
    found = 0.5 + 0.5 * np.tanh(0.5 * FOUND_SLOPE * (predicted.visible - HALF_FOUND))
    return np.asarray(np.where(_inside(predicted, camera), found, 0.0))


def _inside(predicted: RegionPrediction, camera: Camera) -> BoolArray:
    """(F, M) whether regions lie well inside the picture."""
    size = np.array(camera.resolution, dtype=np.float64)
    variance = np.stack([predicted.second_moment[..., axis, axis] for axis in (0, 1)], axis=-1)
    margin = EDGE_SHARE * np.sqrt(variance)
    return np.asarray(((predicted.centroid > margin) & (predicted.centroid < size - margin)).all(-1))


def _quality_near(observed: ObservedRegions, step_s: Array) -> Array:
    """(F, M) best quality of each region shortly before and shortly after, the smaller of both."""
    pace = float(np.median(step_s)) if len(step_s) else REFERENCE_STEP_S
    reach = max(round(NEIGHBORS_S / pace), 1)
    best = [
        maximum_filter1d(observed.quality, reach + 1, axis=0, origin=side, mode="constant")
        for side in (reach // 2, -((reach + 1) // 2))
    ]
    return np.asarray(np.clip(np.minimum(*best), 0.0, 1.0))
