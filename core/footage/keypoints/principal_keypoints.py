"""The principal points of the performer as keypoints of any layout and of several sources show them.

Before keyframes tell where a detector puts its points, those that lie about at joints can be used, and for
the center of the head the ears or the nose.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...body.human import HUMAN
from .keypoints import Keypoints

HEAD, EARS, NOSE = "head", ("ear.L", "ear.R"), "nose"
NOSE_SHARE = 0.3
"""Confidence in the head's center where only the nose shows it, a decimeter in front of it."""
ALIKE_SHARE = 0.1
"""Distance of two sources' points, relative to the performer's size in the picture, within which both are
believed."""


def principal_keypoints(keypoints: Keypoints) -> Keypoints:
    """The principal points (F, P), in the skeleton's order; NaN where none shows one.

    Where several sources show the same point, those that agree with the most confident one are averaged.
    """
    size = performer_size_px(keypoints)
    found = [_agreed(keypoints, name, size) for name in HUMAN.point_names]
    head = HUMAN.point_names.index(HEAD)
    found[head] = found[head].or_else(_middle(*(_agreed(keypoints, name, size) for name in EARS)))
    found[head] = found[head].or_else(_agreed(keypoints, NOSE, size).doubted(NOSE_SHARE))
    return Keypoints(
        HUMAN.point_names,
        ("",) * len(found),
        np.stack([point.pixel for point in found], axis=1),
        np.stack([point.score for point in found], axis=1),
        np.stack([point.hint_m for point in found], axis=1),
    )


def performer_size_px(keypoints: Keypoints) -> Array:
    """(F,) larger side of the box around all keypoints [px], at least the clip's median; 0 without any."""
    seen = keypoints.seen
    if not seen.any():
        return np.zeros(keypoints.frame_count)
    high = np.where(seen[..., None], keypoints.pixel, -np.inf).max(axis=1)
    low = np.where(seen[..., None], keypoints.pixel, np.inf).min(axis=1)
    side = np.where(np.isfinite(high), high - low, 0.0).max(axis=1)
    return np.maximum(side, np.median(side[seen.any(axis=1)]))


@dataclass(frozen=True, eq=False)
class _Point:
    """One point of the body over F frames."""

    pixel: Array
    """(F, 2) [px], NaN where not seen."""
    score: Array
    """(F,) 0 where not seen."""
    hint_m: Array
    """(F, 3) NaN where there is none."""

    def doubted(self, share: float) -> "_Point":
        """The same point with less confidence."""
        return _Point(self.pixel, share * self.score, self.hint_m)

    def or_else(self, other: "_Point") -> "_Point":
        """This point where it is seen, the other elsewhere."""
        seen = np.isfinite(self.pixel).all(axis=-1)
        return _Point(
            np.where(seen[:, None], self.pixel, other.pixel),
            np.where(seen, self.score, other.score),
            np.where(seen[:, None], self.hint_m, other.hint_m),
        )


def _middle(first: _Point, second: _Point) -> _Point:
    """The point halfway between two that are both seen."""
    return _Point(
        0.5 * (first.pixel + second.pixel),
        np.minimum(first.score, second.score),
        0.5 * (first.hint_m + second.hint_m),
    )


def _agreed(keypoints: Keypoints, name: str, size_px: Array) -> _Point:
    """A point of the body by all sources that agree with the most confident one."""
    own = [index for index, known in enumerate(keypoints.names) if known == name]
    if not own:
        frames = keypoints.frame_count
        return _Point(np.full((frames, 2), np.nan), np.zeros(frames), np.full((frames, 3), np.nan))
    pixel, hint = keypoints.pixel[:, own], keypoints.hint_m[:, own]
    score = np.where(keypoints.seen[:, own], keypoints.score[:, own], -1.0)
    best = (np.arange(len(score)), score.argmax(axis=1))
    apart = np.linalg.norm(pixel - pixel[best][:, None], axis=-1)  # NaN where not seen
    weight = np.where(apart <= ALIKE_SHARE * size_px[:, None], np.maximum(score, 1e-6), 0.0)
    hinted = weight * np.isfinite(hint).all(axis=-1)
    return _Point(_mean(pixel, weight), np.maximum(score[best], 0.0), _mean(hint, hinted))


def _mean(values: Array, weight: Array) -> Array:
    """Weighted mean (F, C) of values (F, K, C); NaN where nothing weighs."""
    total = weight.sum(axis=1)[:, None]
    summed = (weight[..., None] * np.where(weight[..., None] > 0.0, values, 0.0)).sum(axis=1)
    return np.where(total > 0.0, summed / np.where(total > 0.0, total, 1.0), np.nan)
