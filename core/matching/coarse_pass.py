"""Coarse pass over a few frames: the floor's height, and how well a library's single postures fit."""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import IndexArray
from ..footage.camera import Camera
from .emissions import FrameEmissions, StateFeatures, evaluate_emissions
from .frame_likelihood import FrameLikelihood, frame_likelihoods
from .match_evidence import MatchEvidence
from .noise_scales import NoiseScales, student_scales

FLOOR_STD_M = 0.05
"""Standard deviation of the hips' height between performers."""
WORLD_FLOOR_M = 0.25
"""A floor found this near to z = 0 is taken to be there: sizes are no more exact, and scenes are built
there."""
FLOOR_COST_MARGIN = 1.5
"""Mean cost of a frame that putting the floor at z = 0 may add before another height is preferred."""
MOST_FRAMES = 15
UNKNOWN_FLOOR_STD_M = 2.0


@dataclass(frozen=True)
class CoarsePass:
    """Result of the coarse pass."""

    floor_m: float
    """Height of the floor, by the sizes in the picture and the feet; 0 where that is about right."""
    cost: float
    """Mean negative log likelihood of a frame's best posture, with the noise scales that these frames
    suggest; an order in time hardly lowers it."""


def coarse_pass(
    camera: Camera, evidence: MatchEvidence, frames: IndexArray, states: StateFeatures
) -> CoarsePass:
    """Fit single postures to some frames without knowing the floor.

    Args:
        camera: The camera.
        evidence: The markers' regions and the keypoints.
        frames: Frames to choose from.
        states: The library's postures in all headings.
    """
    chosen = frames[np.unique(np.linspace(0, len(frames) - 1, MOST_FRAMES).astype(int))]
    likelihoods = frame_likelihoods(camera, evidence, chosen, 0.0, UNKNOWN_FLOOR_STD_M)
    emissions = [evaluate_emissions(likelihood, states) for likelihood in likelihoods]
    floor = _floor_height_m(likelihoods, emissions, states)
    if abs(floor) > WORLD_FLOOR_M:
        on_ground = frame_likelihoods(camera, evidence, chosen, 0.0, FLOOR_STD_M)
        ground_emissions = [evaluate_emissions(likelihood, states) for likelihood in on_ground]
        if _mean_cost(ground_emissions) - _mean_cost(emissions) < FLOOR_COST_MARGIN:
            floor = 0.0
    else:
        floor = 0.0
    noise_scales = _noise_scales(evidence, likelihoods, emissions, states)
    refined = frame_likelihoods(camera, evidence, chosen, floor, FLOOR_STD_M, noise_scales)
    return CoarsePass(floor, _mean_cost([evaluate_emissions(likelihood, states) for likelihood in refined]))


def _mean_cost(emissions: list[FrameEmissions]) -> float:
    return float(np.mean([emission.cost.min() for emission in emissions]))


def _floor_height_m(
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
    order = np.argsort(heights)
    half = int(np.searchsorted(np.cumsum(weights[order]), 0.5 * weights.sum()))
    return float(heights[order[min(half, len(order) - 1)]])


def _noise_scales(
    evidence: MatchEvidence,
    likelihoods: list[FrameLikelihood],
    emissions: list[FrameEmissions],
    states: StateFeatures,
) -> NoiseScales:
    """Scales of the centroids' noise, from the residuals of each frame's best posture."""
    residuals = []
    for likelihood, emission in zip(likelihoods, emissions, strict=True):
        best = int(emission.cost.argmin())
        centroid = states.vectors[:-2, emission.states[best]].reshape(-1, 3)
        residual = np.einsum(
            "mki,mi->mk", likelihood.image_axes, centroid + emission.hips[:, best] - likelihood.location
        )
        residuals.append(residual * likelihood.weight[:, None])
    return replace(
        NoiseScales.of(evidence),
        centroid=student_scales(
            np.array(residuals), np.array([likelihood.visible for likelihood in likelihoods]), 1.0
        ),
    )
