"""Coarse pass over a few frames: the floor's height and a library's fit by single postures, in no order."""

import numpy as np

from ..arrays import IndexArray
from ..footage.camera import Camera
from ..numerics.smoothing import weighted_median
from .emissions import FrameEmissions, StateFeatures, evaluate_emissions
from .frame_likelihood import FrameLikelihood, frame_likelihoods
from .match_evidence import MatchEvidence

FLOOR_STD_M = 0.05
"""Standard deviation of the hips' height between performers."""
WORLD_FLOOR_M = 0.25
"""A floor found this near to z = 0 is taken to be there: sizes are no more exact, and scenes are built
there."""
FLOOR_COST_MARGIN = 1.5
"""Mean cost of a frame that putting the floor at z = 0 may add before another height is preferred."""
MOST_FRAMES = 15
UNKNOWN_FLOOR_STD_M = 2.0


def floor_height_m(
    camera: Camera, evidence: MatchEvidence, frames: IndexArray, states: StateFeatures
) -> float:
    """Height of the floor, by the sizes in the picture and the feet; 0 where that is about right.

    Args:
        camera: The camera.
        evidence: The markers' regions and the keypoints.
        frames: Frames to choose from.
        states: The library's postures in all headings.
    """
    likelihoods = frame_likelihoods(camera, evidence, _few(frames), 0.0, UNKNOWN_FLOOR_STD_M)
    emissions = [evaluate_emissions(likelihood, states) for likelihood in likelihoods]
    floor_m = _median_height_m(likelihoods, emissions, states)
    if abs(floor_m) <= WORLD_FLOOR_M:
        return 0.0
    added = single_posture_cost(camera, evidence, frames, states, 0.0) - _mean_cost(emissions)
    return 0.0 if added < FLOOR_COST_MARGIN else floor_m


def single_posture_cost(
    camera: Camera, evidence: MatchEvidence, frames: IndexArray, states: StateFeatures, floor_m: float
) -> float:
    """Mean negative log likelihood of a frame's best posture, by which libraries are compared.

    Args:
        camera: The camera.
        evidence: The markers' regions and the keypoints.
        frames: Frames to choose from.
        states: The library's postures in all headings.
        floor_m: Height of the floor [m].
    """
    likelihoods = frame_likelihoods(camera, evidence, _few(frames), floor_m, FLOOR_STD_M)
    return _mean_cost([evaluate_emissions(likelihood, states) for likelihood in likelihoods])


def _few(frames: IndexArray) -> IndexArray:
    """Evenly chosen ones of some frames."""
    return frames[np.unique(np.linspace(0, len(frames) - 1, MOST_FRAMES).astype(int))]


def _mean_cost(emissions: list[FrameEmissions]) -> float:
    return float(np.mean([emission.cost.min() for emission in emissions]))


def _median_height_m(
    likelihoods: list[FrameLikelihood], emissions: list[FrameEmissions], states: StateFeatures
) -> float:
    """Median of the floor's height over the frames [m], each weighed by its number of visible points."""
    heights, weights = np.empty(len(likelihoods)), np.empty(len(likelihoods))
    for frame, (likelihood, emission) in enumerate(zip(likelihoods, emissions, strict=True)):
        share = np.exp(emission.cost.min() - emission.cost)
        heights[frame] = (
            share * (emission.hips[2] - states.vectors[-2, emission.states])
        ).sum() / share.sum()
        weights[frame] = likelihood.visible.sum()
    return weighted_median(heights, weights)
