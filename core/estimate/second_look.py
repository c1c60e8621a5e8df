"""A second look for markers lost in a blur or half hidden, once it is known where they should be."""

from collections.abc import Generator
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from ..body.body_volume import body_pieces
from ..body.human import limb_of
from ..body.posture import Posture
from ..markers.ignored_regions import is_ignored
from ..markers.moments import centroid_and_second_moment
from ..markers.region_tracks import RegionTracks
from ..markers.surface_colors import (
    bare_surfaces,
    common_colors,
    is_alike,
    marker_surfaces,
    usual_background,
)
from ..markers.unmixing import Palette, Traces, traces
from ..terms.regions import FEATURES, NOISE, ObservedRegions
from .clip_problem import ClipProblem
from .contour_evidence import ContourEvidence


def seen_tracks(tracks: RegionTracks, observed: ObservedRegions) -> RegionTracks:
    """The tracks with the regions that the estimate compared; what it did not find anew stays as tracked."""
    found = np.isfinite(observed.area) & (observed.area != tracks.area)
    return replace(
        tracks,
        centroid=np.where(found[..., None], observed.centroid, tracks.centroid),
        second_moment=np.where(found[..., None, None], observed.second_moment, tracks.second_moment),
        area=np.where(found, observed.area, tracks.area),
        quality=np.where(found, observed.quality, tracks.quality),
    )


REACH = 2.0  # distance from the prediction within which a find's center lies, in a marker's lengths
MOST_SIZE = 2.0  # area of a find relative to the predicted one


@dataclass(frozen=True, eq=False)
class Search:
    """What is looked for, and before what: the colors of M markers, of the bare body and the background."""

    contours: ContourEvidence  # the clip's pictures, and the look of performer and background
    palettes: tuple[Palette | None, ...]  # (M,) None for a marker whose color was never seen well
    background: SingleArray  # (rows, columns, 3) blue, green, red; NaN where unknown
    deviation: SingleArray  # (rows, columns) its standard deviation

    @classmethod
    def of(cls, problem: ClipProblem, contours: ContourEvidence) -> "Search":
        """Learn the colors from the tracked regions and the appearance."""
        tracked, appearance = problem.data.tracked, contours.appearance
        surfaces = marker_surfaces(contours.album, tracked.centroid, tracked.second_moment, tracked.quality)
        common, part = common_colors(appearance)
        limbs = np.array([limb_of(piece.segment) for piece in body_pieces(problem.data.body)])[part]
        worn = np.array([limb_of(one.segment) for one in problem.evidence.model.placements])
        bare = bare_surfaces(common, surfaces, limbs[:, None] == worn)
        every = [one for one in (*surfaces, *bare) if one is not None]
        palettes = [
            None if own is None else Palette(own, tuple(one for one in every if not is_alike(own, one)))
            for own in surfaces
        ]
        return cls(
            contours, tuple(palettes), usual_background(appearance), appearance.deviation.astype(np.float64)
        )

    def traces(self, problem: ClipProblem, frame: int, marker: int, center: Array, reach: float) -> Traces:
        """Where a marker's color shows in a square about a place of a frame [pixels of the album]."""
        palette, picture = self.palettes[marker], self.contours.album.picture(frame)
        assert palette is not None
        size = np.array([picture.shape[1], picture.shape[0]])
        left, top = np.clip(np.floor(center - reach), 0, size - 1).astype(np.intp).tolist()
        right, bottom = np.clip(np.ceil(center + reach) + 1, 1, size).astype(np.intp).tolist()
        at = slice(top, max(bottom, top + 1)), slice(left, max(right, left + 1))
        seen = palette.unmix(picture[at], self.background[at], self.deviation[at])
        mask = None if problem.data.ignored is None else problem.data.ignored.mask(frame)
        if mask is not None:
            step = mask.shape[0] // picture.shape[0]
            small = mask[step // 2 :: step, step // 2 :: step]
            seen.gain[is_ignored(small)[: picture.shape[0], : picture.shape[1]][at]] = 0.0
        return traces(seen, (left, top))


def find_lost(
    problem: ClipProblem, posture: Posture, contours: ContourEvidence
) -> Generator[float, None, tuple[ClipProblem, IndexArray]]:
    """The problem with lost markers observed where they are found, in which frames; yields the fraction done.

    `posture`: F postures, by which they should be seen.
    """
    search, factor, evidence = Search.of(problem, contours), contours.album.factor, problem.evidence
    every = np.flatnonzero([index in contours.album for index in range(problem.frames)])
    predicted = evidence.model.evaluate(problem.data.body.pose(posture[every]), every)
    length = np.percentile(np.sqrt(12.0 * np.linalg.eigvalsh(predicted.second_moment)[..., 1]), 80.0, axis=0)
    area = predicted.area * evidence.area_ratio
    wanted = np.isnan(problem.observed.centroid[every, :, 0]) & problem.data.there[every, None]
    # 6.0: least predicted area, in pixels of the album
    wanted &= (predicted.visible > NOISE.least_visible) & (area >= 6.0 * factor**2)
    wanted &= np.array([palette is not None for palette in search.palettes])
    found: list[tuple[int, int]] = []
    moments, certainty = [], []
    rows = np.argwhere(wanted)
    for number, (row, marker) in enumerate(rows.tolist()):
        center, frame = predicted.centroid[row, marker], int(every[row])
        # So wide that what has its center within reach lies in it as a whole.
        reach = (REACH + 0.6) * length[marker] / factor
        seen = search.traces(problem, frame, marker, center / factor, reach).scaled(factor)
        own = _own(seen, center, length[marker], area[row, marker])
        if len(own):
            total = seen.moments[own].sum(axis=0)
            found.append((frame, marker))
            moments.append(total)
            ratio = total[0] / max(area[row, marker], 1e-6)
            certainty.append(seen.certainty[own].mean() * min(ratio, 1.5 / ratio, 1.0))
        yield (number + 1) / len(rows)
    if not found:
        return problem, every[:0]
    centroid, second = centroid_and_second_moment(np.array(moments))
    # 0.5: of a find's features beyond a tracked region's, in pixels of the album
    variance = np.full((len(found), FEATURES), (0.5 * factor) ** 2)
    regions = ObservedRegions.found(
        centroid, second, np.array(moments)[:, 0], np.clip(certainty, 0.0, 1.0), variance
    )
    frames, markers = np.array(found, dtype=np.intp).T
    return replace(problem, observed=problem.observed.replaced((frames, markers), regions)), frames


def _own(found: Traces, center: Array, length: float, area: float) -> IndexArray:
    """Those of R traces that are the marker: the likeliest near its place, and what is cut off from it."""
    centroid, _ = centroid_and_second_moment(found.moments)
    away = np.linalg.norm(centroid - center, axis=-1)
    size = found.moments[:, 0] / area
    # 10.0: Log likelihood ratio of a find: a window has e^8 places for it, and one in e^2 of all may be
    # chance.
    likely = (found.gain >= 10.0) & (away <= REACH * length) & (size <= MOST_SIZE)
    if not likely.any():
        return np.zeros(0, dtype=np.intp)
    main = int(np.where(likely, found.gain, -np.inf).argmax())
    near = np.linalg.norm(centroid - centroid[main], axis=-1) <= 0.7 * length
    # 3.0: of what something before it cuts off from a find
    own = np.flatnonzero((found.gain >= 3.0) & near)
    return own if size[own].sum() <= MOST_SIZE else np.array([main])
