"""What else a frame may show, and how probable each is."""

import numpy as np

from ..arrays import Array, SingleArray
from ..body.posture import Posture
from .candidate import Candidate, MatchedFrame
from .state_path import Path

MOST = 6
LOOKED_AT = 150
"""The most probable states among which distinct ones are sought."""
DISTINCT_M = 0.08
"""Postures whose points differ by less, the hips aligned, are the same to whoever looks."""
ABOUT_RIGHT_M = 0.10
"""Mean distance of the points, the hips aligned, within which a match is about right."""
CERTAIN = 0.02, 0.98
"""No probability is believed to be outside these."""
BASE, SHARE_COUNTS = -3.3, 1.0 / 3.0
"""Logistic regression, rounded, of being about right, on 23 matches of 15 takes with truth, with right and
wrong libraries: of 393 postures said to be up to 30, 50, 70 and 85 % sure, 13, 40, 73 and 93 % were."""


def alternatives(
    path: Path, share: SingleArray, frame: int, index: int, chosen: Posture, nearest: int, explained: float
) -> MatchedFrame:
    """The chosen posture of a frame and distinct ones beside it, the likelier first.

    Args:
        path: The way that was found.
        share: (K,) probability of each of the frame's states.
        frame: Which of the path's frames.
        index: Its position in the clip.
        chosen: The posture that was chosen there.
        nearest: Which of the chains' postures that is nearest to.
        explained: How much of the frame it explains, 0 to 1.
    """
    fit = path.fits[frame]
    best = fit.row(int(path.best[frame]))
    count = min(LOOKED_AT, len(share))
    likely = np.argpartition(-share, count - 1)[:count]
    likely = likely[np.argsort(-share[likely], kind="stable")]
    likely = np.concatenate([[best], likely[likely != best]]).astype(np.intp)
    postures = path.postures(frame, likely)
    shape = _shape(path, postures)
    shape[0] = _shape(path, Posture.stack([chosen]))[0]
    weight = share[likely] / max(float(share[likely].sum()), 1e-12)
    kept: list[int] = []
    for place in range(len(likely)):
        if all(_apart(shape[place], shape[other]) > DISTINCT_M for other in kept):
            kept.append(place)
        if len(kept) == MOST:
            break
    found = []
    for place in kept:
        near = np.linalg.norm(shape - shape[place], axis=-1).mean(axis=-1) < ABOUT_RIGHT_M
        state = int(fit.states[likely[place]])
        posture = state // len(path.turned.heading_rad) if place else nearest
        found.append(
            Candidate(
                chosen if place == 0 else postures[place],
                path.chains.name(posture),
                path.chains.is_mirrored(posture),
                confidence(float(weight[near].sum()), explained),
            )
        )
    return MatchedFrame(index, tuple(found))


def confidence(share: float, explained: float) -> float:
    """Probability that a posture is about right.

    Being the only one among the library's that comes into question is not enough: the library may hold none
    that is right, and then the markers are off.

    Args:
        share: Probability of the posture and those about like it among all of the library.
        explained: How much of the frame the match explains, 0 to 1.
    """
    odds = [np.log(value / (1.0 - value)) for value in np.clip([share, explained], *CERTAIN)]
    return float(1.0 / (1.0 + np.exp(-(BASE + SHARE_COUNTS * odds[0] + odds[1]))))


def _shape(path: Path, postures: Posture) -> Array:
    """(N, P, 3) points relative to the hips [m]."""
    body = path.chains.body
    return np.asarray(body.points(body.pose(postures)) - postures.translation[:, None])


def _apart(first: Array, second: Array) -> float:
    return float(np.linalg.norm(first - second, axis=-1).mean())
