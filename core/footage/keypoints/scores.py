"""Detectors' scores as confidences from 0 to 1, whatever they are: probabilities, responses or logits."""

import numpy as np

from ...arrays import Array

HIGH_SHARE = 0.95
"""Share of all scores that lie below the one that counts as certain: a few outliers set no scale."""


def confidences(scores: Array, where: str) -> tuple[Array, tuple[str, ...]]:
    """Scores as confidences, and a sentence where they had to be changed.

    Probabilities stay as they are; a negative one among them stands for nothing found. Negative scores beside
    such above 1 are logits, the logarithm of the odds. Responses of networks that exceed 1 (SimCC's heat
    maps, percentages) are divided by the one that most stay below: only their order and proportion mean
    anything. A file without any score vouches for all of its points.

    Args:
        scores: (S,) all scores of points that have a place; NaN where there is none.
        where: The file.
    """
    known = scores[np.isfinite(scores)]
    if not len(known) or not known.any():
        note = f"{where}: has no scores; every point in it is believed alike"
        return np.where(np.isnan(scores), np.nan, 1.0), (note,) if len(scores) else ()
    low, high = float(known.min()), float(known.max())
    if high <= 1.0:
        return np.maximum(scores, 0.0), ()
    if low < 0.0:
        note = f"{where}: its scores, {low:.3g} to {high:.3g}, were taken for logits and made confidences"
        return 1.0 / (1.0 + np.exp(-np.clip(scores, -50.0, 50.0))), (note,)
    certain = max(1.0, float(np.quantile(known, HIGH_SHARE)))
    note = f"{where}: its scores reach {high:.3g}; {certain:.3g} and more count as certain"
    return np.minimum(scores / certain, 1.0), (note,)
