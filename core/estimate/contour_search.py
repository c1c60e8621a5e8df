"""Finding the edges of body parts in the pictures: along each contour sample's normal, where colors change.

At every place along the normal the part's colors compete with those of what lies behind it; an edge lies
where the part wins on the inner side and loses on the outer. Over all places this gives a distribution of
the edge's distance, and its mean and variance are the measurement (as Hanek & Beetz 2004, *The contracting
curve density algorithm*, fit curves to two sides' statistics): colors that do not differ measure nothing.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, Image, IndexArray
from ..body.kinematics import Pose
from ..footage.appearance import Appearance
from ..observation.contours import ContourModel, ContourPrediction
from ..observation.occlusion import HIDDEN_DEPTH_M, PartOutlines, outline_depth

REACH = 6
"""How far along the normal an edge is looked for, in pixels of the pictures."""
FARTHEST = 4.0
"""An edge found farther off is likelier another's."""
BELIEF = 3.0
"""Standard deviation of the edge's distance before looking; what looking adds is the measurement."""
INNER, OUTER = 2.0, 2.5
"""Places inside and outside the contour that decide what is seen there."""
MOST_EVIDENCE = 4.0
"""No pixel's colors speak more than this for either side, as a log likelihood ratio."""


@dataclass(frozen=True, eq=False)
class Edges:
    """What was found near N contour samples in F frames."""

    distance: Array
    """(F, N) from the sample along its normal [px]; zero where nothing was found."""
    variance: Array
    """(F, N) [px²], infinite where nothing was found."""


def find_edges(
    model: ContourModel,
    predicted: ContourPrediction,
    pose: Pose,
    frame: IndexArray,
    pictures: Image,
    factor: int,
    appearance: Appearance,
) -> Edges:
    """Look for the edges near predicted contours.

    Args:
        model: The contours' model.
        predicted: Its prediction.
        pose: Forward kinematics of the F postures it was made from.
        frame: (F,) their places in the clip.
        pictures: (F, rows, columns, 3) small pictures of the frames.
        factor: Pixels of the camera to one of the pictures.
        appearance: How parts and background look in them.
    """
    behind, shown = _surroundings(model, predicted, model.part_outlines(pose, frame), factor)
    offset = np.arange(-REACH, REACH + 1.0)
    rows, columns = pictures.shape[1:3]
    middle = predicted.pixel / factor
    reach = REACH * np.abs(predicted.normal)
    shown &= ((middle >= reach) & (middle + reach < [columns, rows])).all(axis=-1)
    # From here on only what is there to be seen, E samples: about half of all.
    picture, sample = np.nonzero(shown)
    places = middle[shown][:, None] + offset[:, None] * predicted.normal[shown][:, None]
    column, row = np.moveaxis(places.astype(np.intp), -1, 0)
    evidence, judged = _evidence(
        appearance, model.part_of[sample], behind[shown], row, column, pictures[picture[:, None], row, column]
    )
    mean, variance = _edge(evidence, offset)
    found = judged & (variance < BELIEF**2) & (np.abs(mean) < FARTHEST)
    edges = Edges(np.zeros(shown.shape), np.full(shown.shape, np.inf))
    edges.distance[picture[found], sample[found]] = mean[found] * factor
    edges.variance[picture[found], sample[found]] = variance[found] * factor**2
    return edges


def _evidence(
    appearance: Appearance,
    part: IndexArray,
    behind: IndexArray,
    row: IndexArray,
    column: IndexArray,
    seen: Image,
) -> tuple[Array, BoolArray]:
    """Log likelihood ratios (E, K) of parts to what lies behind them, and whether both are known (E,)."""
    own = appearance.part(part[:, None], seen)
    other = np.empty_like(own)
    covered, free = behind >= 0, behind < 0
    other[covered] = appearance.part(behind[covered, None], seen[covered])
    other[free] = appearance.background(row[free], column[free], seen[free])
    # What a background looks like that was never free is a guess, and a guess would draw edges outwards.
    judged = covered | appearance.known[row, column][:, REACH + 1 :].all(axis=-1)
    return np.clip(own - other, -MOST_EVIDENCE, MOST_EVIDENCE), judged


def _edge(evidence: Array, offset: Array) -> tuple[Array, Array]:
    """Mean and variance (...) of the edge's distance that evidence (..., K) at offsets (K,) adds."""
    between = offset + 0.5
    likelihood = np.cumsum(evidence, axis=-1)  # of the edge after each place, but for a constant
    log = likelihood - 0.5 * (between / BELIEF) ** 2
    weight = np.exp(log - log.max(axis=-1, keepdims=True))
    weight /= weight.sum(axis=-1, keepdims=True)
    mean = weight @ between
    # An edge lies anywhere in its pixel.
    variance = np.sum(weight * (between - mean[..., None]) ** 2, axis=-1) + 1.0 / 12.0
    added = np.maximum(1.0 / variance - BELIEF**-2, 1e-9)
    return mean / (variance * added), 1.0 / added


def _surroundings(
    model: ContourModel, predicted: ContourPrediction, parts: PartOutlines, factor: int
) -> tuple[IndexArray, BoolArray]:
    """Which part lies behind each contour sample, -1 for none, and whether its edge is there to be seen."""
    normal = factor * predicted.normal
    own = np.eye(len(model.parts.segments), dtype=bool)[model.part_of]
    before = (
        outline_depth(predicted.pixel - INNER * normal, parts) + HIDDEN_DEPTH_M < predicted.depth[..., None]
    )
    shown = ~(before & ~own).any(axis=-1)
    covering = outline_depth(predicted.pixel + OUTER * normal, parts)  # (F, N, O), infinite outside
    joined = (np.isfinite(covering) & model.adjoining).any(axis=-1)
    covering = np.where(model.adjoining, np.inf, covering)
    nearest = covering.argmin(axis=-1)
    depth = covering.min(axis=-1)
    # A nearer part's own edge is what shows there.
    shown &= ~joined & (depth >= predicted.depth)
    return np.where(np.isfinite(depth), nearest, -1), shown
