"""Calibration of hints of depth on posed keyframes: what a link's depth is expected to be by its guess.

By Bayesian linear regression, link by link, with links on both sides of the body alike. A guess that tells
nothing gets a gain near zero, or an error so large that it does not matter.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, IndexArray
from ..body.kinematics import Pose
from ..observation.depth_links import DepthLinks
from ..observation.keypoints import KeypointModel

USUAL_ERROR = 0.2
"""Error of a guess over the link's length: the sine of some twelve degrees."""
GAIN_STD, OFFSET_STD = 0.5, 0.2
"""Standard deviation of the gain from 1, and of the offset over the link's length."""
NAME_COUNT, LINK_COUNT = 12.0, 6.0
"""Numbers of errors that the usual error, and that of a link's name, weigh as much as."""
CLIP_FACTOR = 1.4
"""Between keyframes errors count as this many times as large: those of neighboring links are alike."""
MEMORY_S = 0.25
"""Time in which an error fades to a third."""
ROUNDS = 4
LARGEST_ERROR = 4.0
"""A larger error, in standard deviations, counts as one this large."""


@dataclass(frozen=True, eq=False)
class DepthEvidence:
    """What the L links' guesses are worth."""

    links: DepthLinks
    gain: Array
    """(L,) expected depth by a guess: gain times guess plus offset."""
    offset_m: Array
    """(L,)."""
    std_m: Array
    """(L,) error of what is expected [m]."""
    memory_s: float = MEMORY_S
    """Time in which an error fades to a third [s]."""

    @classmethod
    def usual(cls, links: DepthLinks, model: KeypointModel) -> "DepthEvidence":
        """Guesses taken as they are, before any keyframe is posed."""
        length = links.lengths_m(model)
        return cls(links, np.ones_like(length), np.zeros_like(length), USUAL_ERROR * length)

    @property
    def error_m(self) -> Array:
        """(L,) error that the estimate of a clip reckons with [m]."""
        return CLIP_FACTOR * self.std_m

    def expected(self, depth: Array) -> Array:
        """(F, L) expected depths of the links by the points' guessed depths (F, N) [m]."""
        return np.asarray(self.gain * self.links.guessed(depth) + self.offset_m)


def read_depths(
    evidence: DepthEvidence,
    model: KeypointModel,
    pose: Pose,
    frame: IndexArray,
    depth: Array,
    posing_std_m: float,
) -> DepthEvidence:
    """The evidence as K posed keyframes have it.

    Args:
        evidence: The usual one.
        model: The points' calibrated model.
        pose: The keyframes' poses.
        frame: (K,) their frames.
        depth: (K, N) the points' guessed depths there [m].
        posing_std_m: Error of a posed point [m].
    """
    links = evidence.links
    guessed, true = links.guessed(depth), links.depths(model, pose, frame)
    known = np.isfinite(guessed)
    guess = np.where(known, guessed, 0.0)
    length = links.lengths_m(model)
    usual = (USUAL_ERROR * length) ** 2
    posing = 2.0 * posing_std_m**2
    variance, gain, offset = usual.copy(), evidence.gain.copy(), evidence.offset_m.copy()
    names = np.array(links.names)
    for _ in range(ROUNDS):
        squared = np.zeros_like(guess)
        for i in range(len(names)):
            rows = np.stack([guess[:, i], np.ones(len(guess))], axis=-1) * known[:, i, None]
            noise = variance[i] + posing
            prior = np.array([GAIN_STD, OFFSET_STD * length[i]]) ** -2.0
            information = rows.T @ rows / noise + np.diag(prior)
            wanted = rows.T @ np.where(known[:, i], true[:, i], 0.0) / noise + prior * [1.0, 0.0]
            gain[i], offset[i] = np.linalg.solve(information, wanted)
            left = np.where(known[:, i], true[:, i], 0.0) - rows @ [gain[i], offset[i]]
            doubt = np.sum(rows * np.linalg.solve(information, rows.T).T, axis=-1)
            share = variance[i] / noise  # of what is left that is the guess's, not the keyframe's
            squared[:, i] = share**2 * np.minimum(left**2, LARGEST_ERROR**2 * noise) + share * posing + doubt
        for name in np.unique(names):
            same = names == name
            total, count = np.where(known, squared, 0.0)[:, same].sum(axis=0), known[:, same].sum(axis=0)
            pooled = (NAME_COUNT * usual[same].mean() + total.sum()) / (NAME_COUNT + count.sum())
            variance[same] = (LINK_COUNT * pooled + total) / (LINK_COUNT + count)
    return replace(evidence, gain=gain, offset_m=offset, std_m=np.sqrt(variance))
