"""Search for the edges of body parts in the pictures: color changes along each contour sample's normal.

At every pixel along the normal the part's colors compete with those of what lies behind it; an edge lies
where the part wins on the inner side and loses on the outer. Over all pixels this gives a distribution of
the edge's distance, whose mean and variance are the measurement (as Hanek & Beetz 2004, *The contracting
curve density algorithm*, fit curves to two sides' statistics): colors that do not differ measure nothing.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, Image, IndexArray
from ..body.body_volume import TRUNK
from ..body.kinematics import Body, Pose
from ..body.posture import Posture
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints
from ..markers.appearance import Appearance
from ..terms.contours import ContourModel, ContourPrediction
from ..terms.occlusion import HIDDEN_DEPTH_M, PartOutlines, outline_depth

INNER, OUTER = 2.0, 2.5  # distances inside and outside the contour at which occlusion is decided
LARGEST_LOG_RATIO = 4.0  # bound of a single pixel's log likelihood ratio


@dataclass(frozen=True)
class SearchRange:
    """How far from its prediction an edge is looked for, in pixels of the pictures."""

    reach: int  # reach of the search along the normal
    prior_std: float  # of the edge's distance; it is taken out of the measurement again
    farthest: float  # a more distant edge is likelier another part's


NARROW = SearchRange(6, 3.0, 4.0)  # once the body is known to a few pixels


@dataclass(frozen=True, eq=False)
class Edges:
    """Edges near N contour samples in F frames."""

    distance: Array  # (F, N) from the sample along its normal [px]; zero where nothing was found
    variance: Array  # (F, N) [px²], infinite where nothing was found


def find_edges(
    model: ContourModel,
    predicted: ContourPrediction,
    pose: Pose,
    frame: IndexArray,
    pictures: Image,
    factor: float,
    appearance: Appearance,
    search: SearchRange = NARROW,
) -> Edges:
    """Search for the edges near predicted contours.

    `pictures` (F, rows, columns, 3) are small ones, `factor` pixels of the camera to one of theirs.
    """
    behind, shown = _occlusion(model, predicted, model.part_outlines(pose, frame), factor)
    offset = np.arange(-search.reach, search.reach + 1.0)
    rows, columns = pictures.shape[1:3]
    middle = predicted.pixel / factor
    reach = min(search.reach, NARROW.reach) * np.abs(predicted.normal)
    shown &= ((middle >= reach) & (middle + reach < [columns, rows])).all(axis=-1)
    # From here on only the E visible samples, about half of all.
    picture, sample = np.nonzero(shown)
    places = middle[shown][:, None] + offset[:, None] * predicted.normal[shown][:, None]
    column, row = np.moveaxis(np.floor(places).astype(np.intp), -1, 0)
    inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
    column, row = np.clip(column, 0, columns - 1), np.clip(row, 0, rows - 1)
    evidence, comparable = _log_likelihood_ratios(
        appearance, model.part_of[sample], behind[shown], row, column, pictures[picture[:, None], row, column]
    )
    evidence[~inside] = 0.0
    # Evidence summed up is the log likelihood of the edge after each pixel, up to a constant.
    _, (mean, variance) = measured(np.cumsum(evidence, axis=-1), offset + 0.5, search.prior_std, 1.0)
    found = comparable & (variance < search.prior_std**2) & (np.abs(mean) < search.farthest)
    edges = Edges(np.zeros(shown.shape), np.full(shown.shape, np.inf))
    edges.distance[picture[found], sample[found]] = mean[found] * factor
    edges.variance[picture[found], sample[found]] = variance[found] * factor**2
    return edges


def _log_likelihood_ratios(
    appearance: Appearance,
    part: IndexArray,
    behind: IndexArray,
    row: IndexArray,
    column: IndexArray,
    seen: Image,
) -> tuple[Array, BoolArray]:
    """Log likelihood ratios (E, K) of each part to its background, and whether both looks are known (E,)."""
    own = appearance.part(part[:, None], seen)
    other = np.empty_like(own)
    covered, free = behind >= 0, behind < 0
    other[covered] = appearance.part(behind[covered, None], seen[covered])
    other[free] = appearance.background(row[free], column[free], seen[free])
    # A background that was never free is guessed, and a guess would draw edges outwards.
    outer = row.shape[1] // 2 + 1
    known = appearance.known[row, column]
    comparable = covered | known[:, outer : outer + NARROW.reach].all(axis=-1)
    ratio = np.clip(own - other, -LARGEST_LOG_RATIO, LARGEST_LOG_RATIO)
    ratio[:, outer:] = np.where(known[:, outer:] | covered[:, None], ratio[:, outer:], 0.0)
    return ratio, comparable


def measured(
    likelihood: Array, places: Array, prior_std: float, grain: float
) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Mean and variance (...) of a distance by log likelihoods (..., K) at places (K,), with its prior.

    Then both without it, as a measurement. A distance lies anywhere in its `grain`.
    """
    log = likelihood - 0.5 * (places / prior_std) ** 2
    weight = np.exp(log - log.max(axis=-1, keepdims=True))
    weight /= weight.sum(axis=-1, keepdims=True)
    mean = weight @ places
    variance = np.sum(weight * (places - mean[..., None]) ** 2, axis=-1) + grain**2 / 12.0
    added = np.maximum(1.0 / variance - prior_std**-2, 1e-9)
    return (mean, variance), (mean / (variance * added), 1.0 / added)


def _occlusion(
    model: ContourModel, predicted: ContourPrediction, parts: PartOutlines, factor: float
) -> tuple[IndexArray, BoolArray]:
    """Index of the part behind each contour sample, -1 for none, and whether its edge is visible."""
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
    # A nearer part shows its own edge there.
    shown &= ~joined & (depth >= predicted.depth)
    return np.where(np.isfinite(depth), nearest, -1), shown


# --- Schedule of looks


WIDEST_M = (0.25, 0.13, 0.20)
"""Reach, deviation and farthest edge of the first look: interpolation of keyframes errs by 5 to 20 cm."""
LOOKS = 9  # looks of the schedule; each is about a seventh narrower than the one before
ENDS = (
    ("wrist.L",),
    ("wrist.R",),
    ("ankle.L",),
    ("ankle.R",),
    ("hip.L", "hip.R", "shoulder.L", "shoulder.R"),
)  # body points of which one of each group locates its limb, or the trunk
HEAD = "head"


@dataclass(frozen=True)
class Schedule:
    """Looks, one after the other."""

    looks: tuple[SearchRange, ...]

    @property
    def judging(self) -> SearchRange:
        """The search at keyframes: those posed by hand are off by several centimeters."""
        return self.looks[2 * len(self.looks) // 3]

    @property
    def is_wide(self) -> bool:
        """Whether edges are looked for farther away than markers leave them."""
        return any(look != NARROW for look in self.looks)


BY_MARKERS = Schedule((NARROW, NARROW))  # where markers locate every limb


def contour_schedule(
    body: Body,
    camera: Camera,
    factor: float,
    marked: tuple[str, ...],
    prior: Posture,
    keypoints: Keypoints | None = None,
) -> Schedule:
    """The looks for a clip.

    `factor`: pixels of the camera to one of the pictures; `marked`: the segments with markers; the prior
    tells the performer's distance.
    """
    if all_located(body, marked):
        return BY_MARKERS
    depth = np.median(camera.depth(prior.translation, np.arange(prior.batch[0])))
    scale = float(camera.pixels_per_meter(depth)) / factor
    last = np.array([NARROW.reach, NARROW.prior_std, NARROW.farthest])
    # 36: bound of the first look's reach, for the sake of time
    first = np.array(WIDEST_M) * min(scale, 36 / WIDEST_M[0])
    if keypoints is not None and points_locate(keypoints):
        # 0.5: width of the first look where keypoints locate the limbs, to 2 to 6 cm
        first *= 0.5
    looks = np.geomspace(np.maximum(first, last), last, LOOKS)
    return Schedule(
        tuple(SearchRange(round(reach), std, farthest) for reach, std, farthest in looks.tolist())
    )


def all_located(body: Body, marked: tuple[str, ...]) -> bool:
    """Whether a marker is worn on the trunk, the head's too, and on each arm and leg."""
    skeleton = body.skeleton
    first = {one.name: int(skeleton.dof_starts[one.joint]) for one in skeleton.segments}
    trunk, *limbs = (set(limb.tolist()) for limb in skeleton.limbs)
    worn = {first[name] for name in marked if name != TRUNK}
    if TRUNK not in marked and not worn & trunk:
        return False
    return all(worn & limb for limb in limbs if first[HEAD] not in limb)


def points_locate(keypoints: Keypoints) -> bool:
    """Whether keypoints show the ends of all limbs, and the trunk, in most frames."""
    seen = keypoints.seen.mean(axis=0)
    best = {name: 0.0 for group in ENDS for name in group}
    for name, share in zip(keypoints.names, seen.tolist(), strict=True):
        best[name] = max(best.get(name, 0.0), share)
    return all(max(best[name] for name in group) > 0.5 for group in ENDS)
