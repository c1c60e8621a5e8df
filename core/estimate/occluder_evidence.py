"""Learns from a clip what stands before the performer.

Where the body is predicted, and the picture shows the unmoving background's color, something lies nearer than
the body; where the body is seen, nothing does. Of every pixel of the album's pictures this makes, over frames
and keyframes, an evidence for each depth from which on a body may be hidden there.
"""

from collections.abc import Generator
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from ..arrays import Array, BoolArray, Image, IndexArray, SingleArray
from ..body.posture import Posture
from ..footage.appearance import NO_PART, Appearance
from ..observation.occluders import StaticOccluders
from ..observation.part_map import part_map
from .contour_evidence import ContourEvidence
from .keyframe_evidence import evenly_spread

LOOK_S = 1.0 / 6.0
"""Time between the frames looked at: nearer ones show the same posture, with the same error."""
MOST_LOOKS = 300
MOST_KEYFRAMES = 60
KEYFRAME_WEIGHT = 2.0
"""Of a look at a keyframe, whose posture is known better than an estimated one."""
UNSHAPELY = ("head", "hand", "foot")
"""Parts whose outlines are too rough: hair, fingers and shoes differ from the average body's."""
INSIDE_PX = 2.0
"""Pixels nearer to the body's outline say nothing: the body is known by about so much ..."""
INSIDE_SHARE = 0.3
"""... and its thickness by about this share."""
LARGEST_LOG_RATIO = 3.0
"""Bound of what a single look says of a pixel."""
LEAST_EVIDENCE = 2.0
"""Log odds of a pixel that may belong to an occluder."""
LEAST_LOOKS = 4.0
"""Looks that must show an occluder, a keyframe counting twice."""
SHOWN_PX = 6
"""Pixels of an occluder that a look must show clearly to count."""
CLEARLY = 1.0
"""Log odds of a pixel that a look shows clearly to be hidden, or not."""
STATIC_DEVIATION = 8.3
"""Least deviation of a background pixel's colors [levels], as coarse as the histograms of parts, so that
neither of two surfaces of the same color is preferred."""
UNLIKE = -16.0
"""Log density [per level³] of colors that a pixel's background does not have: some 3.7 deviations off."""
ALIKE = 1.0
"""Log odds for the background that gray trousers before a gray floor have as well."""
OTHER_PART = 2.0
"""Log odds against another part of the body at a pixel than the predicted one."""
BIN_M = 0.25
"""Resolution in depth."""
MOST_BINS = 12
REACH_M = 0.2
"""Distance at which a body that is not where it is predicted is seen instead of it."""
SAME_EVIDENCE = 0.5
"""Log odds that tell nothing about the bin of depth."""
NEAREST_SHARE = 0.1
"""Share of an occluder's pixels that may be wrong about the nearest body that it hides."""
SMALLEST_M = 0.12
"""Side of the smallest occluder, a square: less hides hardly anything of a limb."""
GROWTH_M = 0.3
"""Distance over which an occluder is believed to go on where its color does and no body is seen."""
SAME_COLOR = 12.0
"""Difference of colors [levels in any channel] within an occluder's surface."""
SMOOTH_PX = 1.0
GAP_PX = 2
"""Gaps of twice as many pixels in an occluder are closed."""


@dataclass(frozen=True, eq=False)
class _Look:
    """One picture near the body as predicted: N pixels, of which the body covers some."""

    pixel: IndexArray
    """(N,) flat indices in the picture."""
    part: IndexArray
    """(N,) the predicted part there, -1 beside the body."""
    inside: BoolArray
    """(N,) well inside a part whose outline is known."""
    beside: BoolArray
    """(N,) beside the body, not on its edge."""
    color: Image
    """(N, 3)."""
    static: SingleArray
    """(N,) log likelihood of the unmoving background."""
    weight: float


def learn_occluders(
    contours: ContourEvidence, posture: Posture, keyframes: IndexArray, step_s: Array
) -> Generator[None, None, StaticOccluders | None]:
    """Learn the static occluders of a clip; it yields now and then, so that a job can be canceled.

    Args:
        contours: Pictures and appearance of a steady background.
        posture: The postures of all F frames, by their markers.
        keyframes: Frames whose posture is known best.
        step_s: (F - 1,) times between frames [s].

    Returns:
        None where nothing stands before the performer.
    """
    album, model = contours.album, contours.model
    frame, weight = _chosen(contours, posture.batch[0], keyframes, step_s)
    parts = model.part_outlines(model.body.pose(posture[frame]), frame)
    depth = parts.depth.mean(-1)  # (L, O)
    scale = float(np.median(model.camera.focal_px / np.maximum(depth, 0.1))) / album.factor
    reach = round(REACH_M * scale) + 1
    margin = np.maximum(INSIDE_PX, INSIDE_SHARE * parts.half_width.mean(-1) / album.factor)
    margin[:, [name.split(".")[0] in UNSHAPELY for name in model.parts.segments]] = np.inf
    shape = album.picture(int(frame[0])).shape[:2]
    looks = []
    for row, index in enumerate(frame.tolist()):
        labels = part_map(parts, row, (shape[1], shape[0]), album.factor)
        picture = album.picture(index)
        looks.append(_look(contours.appearance, picture, labels, margin[row], weight[row], reach))
        yield
    appearance = contours.appearance.with_colors(_own_colors(looks), len(model.parts.segments))
    bins = _Bins.of(depth)
    odds = np.zeros((bins.count, shape[0] * shape[1]), dtype=np.float32)
    shown = []
    for row, look in enumerate(looks):
        says = _says(look, appearance, shape, reach)
        within = look.pixel[look.inside]
        odds[bins.index[row][look.part[look.inside]], within] += look.weight * says
        shown.append(within[says > CLEARLY])
        yield
    hidden = _hidden_from(odds.reshape(-1, *shape), shown, weight, bins, (SMALLEST_M * scale) ** 2)
    if not np.isfinite(hidden).any():
        return None
    color = np.where(appearance.known[..., None], appearance.color, np.nan)
    free = odds.sum(axis=0).reshape(shape) > -LEAST_EVIDENCE
    return StaticOccluders(_grown(hidden, color, free, round(GROWTH_M * scale)), album.factor)


@dataclass(frozen=True, eq=False)
class _Bins:
    """Bins of depth, the nearest first."""

    first_m: float
    width_m: float
    index: IndexArray
    """(L, O) bin of each part in each look."""

    @classmethod
    def of(cls, depth: Array) -> "_Bins":
        """Bins for the parts' depths (L, O) [m]."""
        first = float(depth.min())
        width = max(BIN_M, (float(depth.max()) - first) / MOST_BINS)
        return cls(first, width, np.minimum(((depth - first) / width).astype(np.intp), MOST_BINS - 1))

    @property
    def count(self) -> int:
        """Number of bins."""
        return int(self.index.max()) + 1

    def hidden_from(self, bins: IndexArray) -> Array:
        """Depths [m] from which on bodies are hidden that were so in these bins, but not in nearer ones."""
        return np.asarray(self.first_m + (bins - 1) * self.width_m)


def _chosen(
    contours: ContourEvidence, frames: int, keyframes: IndexArray, step_s: Array
) -> tuple[IndexArray, Array]:
    """The frames looked at, and their weights."""
    known = keyframes[evenly_spread(keyframes, MOST_KEYFRAMES)]
    pace = float(np.median(step_s)) if len(step_s) else LOOK_S
    count = int(np.clip(round(frames * pace / LOOK_S), 1, MOST_LOOKS))
    spread = np.round((np.arange(count) + 0.5) * frames / count - 0.5).astype(np.intp)
    frame = np.union1d(known, spread)
    frame = frame[[index in contours.album for index in frame.tolist()]]
    return frame, np.where(np.isin(frame, known), KEYFRAME_WEIGHT, 1.0)


def _look(
    appearance: Appearance,
    picture: Image,
    labels: NDArray[np.int8],
    margin: Array,
    weight: float,
    reach: int,
) -> _Look:
    """What a picture shows near the body."""
    body = (labels != NO_PART).astype(np.uint8)
    side = 2 * reach + 1
    around = (cv2.dilate(body, np.ones((side, side), np.uint8)) > 0) & appearance.known
    pixel = np.flatnonzero(around)
    row, column = np.divmod(pixel, labels.shape[1])
    part = labels.ravel()[pixel].astype(np.intp)
    depth = cv2.distanceTransform(body, cv2.DIST_L2, 3).ravel()[pixel]
    beside = cv2.dilate(body, _disc(GAP_PX)).ravel()[pixel] == 0
    color = picture.reshape(-1, 3)[pixel]
    static = appearance.unmoving(row, column, color, STATIC_DEVIATION).astype(np.float32)
    return _Look(pixel, part, (part >= 0) & (depth > margin[part]), beside, color, static, float(weight))


def _own_colors(looks: list[_Look]) -> tuple[IndexArray, Image]:
    """The parts of pixels, and their colors, that the background before or behind the body cannot have lent.

    Parts that are hidden at times would else be taken for as gray as the table before them.
    """
    own = [look.inside & (look.static < UNLIKE) for look in looks]
    part = np.concatenate([look.part[one] for look, one in zip(looks, own, strict=True)])
    return part, np.concatenate([look.color[one] for look, one in zip(looks, own, strict=True)])


def _says(look: _Look, appearance: Appearance, shape: tuple[int, ...], reach: int) -> Array:
    """Log odds of an occluder at the pixels inside, by one look."""
    other = appearance.body(look.color)
    own = appearance.part(np.maximum(look.part, 0), look.color)
    ratio = look.static - np.where(look.part >= 0, np.maximum(own, other - OTHER_PART), other)
    ratio = np.clip(ratio - np.clip(ratio, 0.0, ALIKE), -LARGEST_LOG_RATIO, LARGEST_LOG_RATIO)
    # A limb that is missing here and seen beside is misplaced, not hidden.
    missing = _around(look.inside & (ratio > CLEARLY), look.pixel, shape, reach)
    elsewhere = _around(look.beside & (ratio < -CLEARLY), look.pixel, shape, reach)
    believed = np.clip(1.0 - elsewhere / np.maximum(missing, 0.5), 0.0, 1.0)
    return np.asarray(np.where(ratio > 0.0, believed * ratio, ratio)[look.inside])


def _disc(radius: int) -> Image:
    return np.asarray(
        cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1)), np.uint8
    )


def _around(mask: BoolArray, pixel: IndexArray, shape: tuple[int, ...], reach: int) -> SingleArray:
    """(N,) number of pixels of a mask (N,) in the square around each."""
    single = np.zeros(shape, dtype=np.float32)
    single.ravel()[pixel[mask]] = 1.0
    side = 2 * reach + 1
    counts = cv2.boxFilter(single, -1, (side, side), normalize=False, borderType=cv2.BORDER_CONSTANT)
    return np.asarray(counts.ravel()[pixel])


def _hidden_from(
    evidence: SingleArray, shown: list[IndexArray], weight: Array, bins: _Bins, smallest: float
) -> SingleArray:
    """(rows, columns) depth from which on a body is hidden [m]; infinite where nothing hides it.

    Args:
        evidence: (B, rows, columns) log odds of an occluder before bodies in each bin of depth.
        shown: Of each look, the flat pixels where it shows one.
        weight: (L,) of the looks.
        bins: The bins.
        smallest: Pixels of the smallest occluder.
    """
    odds = np.stack([cv2.GaussianBlur(one, (0, 0), SMOOTH_PX) for one in evidence])
    for nearer in range(len(odds) - 2, -1, -1):
        odds[nearer] += odds[nearer + 1]  # of an occluder before this bin, and none before nearer ones
    most = odds.max(axis=0)
    likely, best = most > LEAST_EVIDENCE, odds > most - SAME_EVIDENCE
    nearest, farthest = best.argmax(axis=0), len(odds) - 1 - best[::-1].argmax(axis=0)
    mask = cv2.morphologyEx(likely.astype(np.uint8), cv2.MORPH_CLOSE, _disc(GAP_PX))
    mask = cv2.morphologyEx(mask, cv2.MORPH_OPEN, _disc(1))  # what hangs by a thread is a thing of its own
    count, parts, stats, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
    looks = np.zeros(count)
    for one, pixels in zip(weight, shown, strict=True):
        looks[np.bincount(parts.ravel()[pixels], minlength=count) >= SHOWN_PX] += one
    kept = (stats[:, cv2.CC_STAT_AREA] >= smallest) & (looks >= LEAST_LOOKS)
    hidden = np.full(mask.shape, np.inf, dtype=np.float32)
    for part in np.flatnonzero(kept[1:]) + 1:
        here = parts == part
        # One thing: hidden by it anywhere, hidden by it everywhere, but for what was seen before it.
        seen = here & likely
        common = np.sort(farthest[seen])[int(NEAREST_SHARE * np.count_nonzero(seen))]
        hidden[here] = bins.hidden_from(common)
        hidden[seen] = bins.hidden_from(np.clip(common, nearest[seen], farthest[seen]))
    return hidden


def _grown(hidden: SingleArray, color: Array, allowed: BoolArray, growth: int) -> SingleArray:
    """The map grown over pixels of the same color that no body was seen before."""
    sure = np.isfinite(hidden)
    row, column = distance_transform_edt(~sure, return_distances=False, return_indices=True)
    difference = np.abs(color - color[row, column]).max(axis=-1)
    alike = sure | (allowed & (difference < SAME_COLOR))  # NaN is not
    mask = cv2.morphologyEx(sure.astype(np.uint8), cv2.MORPH_OPEN, _disc(GAP_PX))
    for _ in range(growth):
        mask = cv2.dilate(mask, _disc(1)) & alike.astype(np.uint8)
    return np.where((mask > 0) | sure, hidden[row, column], np.inf).astype(np.float32)
