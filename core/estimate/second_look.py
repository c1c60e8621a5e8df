"""A second look for markers that were lost, blurred or half hidden, once it is known where they should be."""

from collections.abc import Generator
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import binary_dilation

from ..arrays import Array, BoolArray, IndexArray, SingleArray
from ..body.body_volume import body_pieces
from ..body.human import limb_of
from ..body.posture import Posture
from ..markers.ignored_regions import is_ignored
from ..markers.moments import centroid_and_second_moment
from ..markers.region_tracks import RegionTracks
from ..markers.surface_colors import bare_surfaces, common_colors, is_alike, marker_surfaces, usual_background
from ..markers.unmixing import Palette, Traces, traces
from ..progress import Part, scaled
from ..terms.regions import FEATURES, SMALLEST_DEVIATION_PX, ObservedRegions
from ..terms.state import ClipState
from .clip_problem import ClipProblem
from .contour_evidence import ContourEvidence
from .window_problem import WindowProblem
from .windows import Window


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


ROUNDS = 3  # looks at most: what is found moves the body, and with it where the rest is looked for


@dataclass(frozen=True)
class LookOptions:
    """What is looked for at a second look, and what is believed of it."""

    lost: float = 0.5  # quality below which a tracked region beside lost ones is looked at again
    beside: int = 2  # frames from lost ones within which it is: a blur comes and goes
    # How much larger than such a region a find must be to replace it, and the prediction to look for it.
    more: float = 1.3
    least_area_px: float = 6.0  # least predicted area, in pixels of the album
    # Log likelihood ratio of a find: a window has e^8 places for it, and one in e^2 of all may be chance.
    least_gain: float = 10.0
    least_rest_gain: float = 3.0  # of what something before it cuts off from a find
    least_peak: float = 0.3  # least of a find's largest shares; colors that were never learned pass for less
    # Least mean gain of its pixels, relative to the largest: what others explain as well tells no place.
    least_certainty: float = 0.25
    least_size: float = 0.15  # area of a find relative to the predicted one
    most_size: float = 2.0
    size_deviation: float = 1.2  # standard deviation of its logarithm, as for tracking
    # distance from the prediction, in the marker's lengths, within which a find stands alone
    near: float = 1.0
    # Growth of the distance that is searched with each frame in which the marker is lost, in its lengths.
    widening: float = 0.5
    farthest: float = 5.0  # largest such distance: that from one side of the body to the other, two arms long
    # percentile of its predicted lengths that is a marker's own, hardly foreshortened
    stretched: float = 80.0
    half: float = 0.6  # half of the marker's length, and its blur
    # Distance of a find from the prediction, in the marker's lengths, from which on its window is solved
    # anew; what is nearer is taken in by the steps that follow with contours.
    moving: float = 0.3
    # Largest step of a limb between frames, in its marker's lengths: longer ones leave nothing but a smear.
    step: float = 1.0
    rest_reach: float = 0.7  # distance of such a rest from the find, in the marker's lengths
    # standard deviation of a find's features beyond a tracked region's, in pixels of the album
    place_std: float = 0.5
    # share of the time between frames in which the shutter is open: between nothing and all of it
    shutter: float = 0.5


LOOK = LookOptions()


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
        tracked, appearance = problem.tracked, contours.appearance
        surfaces = marker_surfaces(contours.album, tracked.centroid, tracked.second_moment, tracked.quality)
        common, part = common_colors(appearance)
        limbs = np.array([limb_of(piece.segment) for piece in body_pieces(problem.body)])[part]
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

    def look(
        self, problem: ClipProblem, posture: Posture, frame: IndexArray
    ) -> Generator[float, None, tuple[ObservedRegions, IndexArray]]:
        """Look for what is missed; yields the fraction done.

        `frame` (N,): ascending frames that are looked at. The regions observed with those found, and the
        frames of finds that are far from the prediction.
        """
        album, observed = self.contours.album, problem.observed[frame]
        expected = _Expected.of(problem, posture, frame)
        there = np.array([int(index) in album for index in frame], dtype=np.bool_)[:, None]
        wanted = there & expected.missed(observed, LOOK.least_area_px * album.factor**2)
        wanted &= np.array([palette is not None for palette in self.palettes])
        moments, certainty = np.full((*wanted.shape, 6), np.nan), np.zeros(wanted.shape)
        rows = np.flatnonzero(wanted.any(axis=1))
        for number, row in enumerate(rows.tolist()):
            picture = album.picture(int(frame[row]))
            mask = None if problem.ignored is None else problem.ignored.mask(int(frame[row]))
            for marker in np.flatnonzero(wanted[row]).tolist():
                window = expected.window(row, marker, album.factor, self.background.shape)
                if window is None:
                    continue
                palette, at = self.palettes[marker], (slice(*window[0]), slice(*window[1]))
                assert palette is not None
                seen = palette.unmix(picture[at], self.background[at], self.deviation[at])
                if mask is not None:
                    step = mask.shape[0] // picture.shape[0]
                    small = mask[step // 2 :: step, step // 2 :: step]
                    seen.gain[is_ignored(small)[: picture.shape[0], : picture.shape[1]][at]] = 0.0
                found = traces(seen, (window[1][0], window[0][0])).scaled(album.factor)
                best = expected.best(row, marker, found)
                if best is not None:
                    moments[row, marker] = found.moments[best].sum(axis=0)
                    certainty[row, marker] = found.certainty[best].mean()
            yield (number + 1) / len(rows)
        alike = [
            (one, other)
            for one, first in enumerate(self.palettes)
            for other, second in enumerate(self.palettes[:one])
            if first is not None and second is not None and is_alike(first.surface, second.surface)
        ]
        found_regions, kept = expected.held(observed, moments, certainty, alike, album.factor)
        row, marker = np.nonzero(kept)
        away = np.linalg.norm(found_regions.centroid - expected.centroid, axis=-1)
        far = frame[(kept & (away > LOOK.moving * expected.length)).any(axis=1)]
        return problem.observed.replaced((frame[row], marker), found_regions[row, marker]), far


def find_lost(
    problem: ClipProblem,
    spans: list[Window],
    states: list[ClipState],
    contours: ContourEvidence,
    among: BoolArray,
) -> Part[ClipProblem]:
    """The problem with lost markers observed where they are found; states follow those that are far off.

    `among` (F,): frames that are looked at; states with far finds are replaced.
    """
    if not spans or not among.any():
        return problem
    search, left = Search.of(problem, contours), list(range(len(spans)))
    for number in range(ROUNDS):
        begun, ended = number / ROUNDS, (number + 1) / ROUNDS
        inside = [np.arange(spans[one].keep_first, spans[one].keep_last) for one in left]
        kept = [states[one].posture[spans[one].kept][among[at]] for one, at in zip(left, inside, strict=True)]
        frame = np.concatenate([at[among[at]] for at in inside])
        if not len(frame):
            break
        looking = search.look(problem, Posture.concatenate(kept), frame)
        observed, far = yield from scaled(looking, begun, begun)
        problem = replace(problem, observed=observed)
        left = [one for one in left if ((far >= spans[one].first) & (far < spans[one].last)).any()]
        for one in left:
            part = WindowProblem(problem, spans[one], states[one])
            yield from scaled(part.follow_markers(), begun, begun)
            states[one] = part.state.without_cache()
        yield ended
        if not left:
            break
    return problem


@dataclass(frozen=True, eq=False)
class _Expected:
    """What is predicted of M markers in N frames, in pixels of the clip."""

    frame: IndexArray  # (N,)
    centroid: Array  # (N, M, 2)
    area: Array  # (N, M)
    seen: BoolArray  # (N, M) whether enough of it is predicted in sight to be compared
    length: Array  # (M,) the marker's length where it is hardly foreshortened
    reach: Array  # (N, M) how far around is searched
    sweep: Array  # (N, M, 2) motion while the shutter is open

    @classmethod
    def of(cls, problem: ClipProblem, posture: Posture, frame: IndexArray) -> "_Expected":
        evidence = problem.evidence
        predicted = evidence.model.evaluate(problem.body.pose(posture), frame)
        longest = np.sqrt(12.0 * np.linalg.eigvalsh(predicted.second_moment)[..., 1])
        length = np.percentile(longest, LOOK.stretched, axis=0)
        away = _frames_away(problem.observed.quality >= LOOK.lost)[frame]
        reach = length * np.minimum(LOOK.near + LOOK.widening * away, LOOK.farthest)
        seen = predicted.visible > problem.noise.least_visible
        sweep = np.zeros_like(predicted.centroid)
        if len(frame) > 1:
            sweep = LOOK.shutter * np.gradient(predicted.centroid, frame.astype(np.float64), axis=0)
        area = predicted.area * evidence.area_ratio
        return cls(frame, predicted.centroid, area, seen, length, reach, sweep)

    def missed(self, observed: ObservedRegions, least_area: float) -> BoolArray:
        """(N, M) which markers should be seen by more than they are."""
        hidden = np.isnan(observed.centroid[..., 0])
        beside = binary_dilation(hidden, np.ones((2 * LOOK.beside + 1, 1), dtype=np.bool_))
        small = ~(observed.area * LOOK.more > self.area) & (observed.quality < LOOK.lost)
        return np.asarray(self.seen & (self.area >= least_area) & beside & small)

    def window(
        self, row: int, marker: int, factor: int, shape: tuple[int, ...]
    ) -> tuple[tuple[int, int], tuple[int, int]] | None:
        """First and last row, and column, that are searched in a picture of a shape; None without any."""
        # So wide that what has its center within reach lies in it as a whole.
        reach = (self.reach[row, marker] + LOOK.half * self.length[marker]) / factor
        center = self.centroid[row, marker] / factor
        size = np.array([shape[1], shape[0]])
        left, top = np.clip(np.floor(center - reach), 0, size).astype(np.intp).tolist()
        right, bottom = np.clip(np.ceil(center + reach) + 1, 0, size).astype(np.intp).tolist()
        return ((top, bottom), (left, right)) if right > left and bottom > top else None

    def best(self, row: int, marker: int, found: Traces) -> IndexArray | None:
        """Those of R traces that are the marker: the likeliest, and what is cut off from it; else None."""
        moments, gain = found.moments, found.gain
        centroid, _ = centroid_and_second_moment(moments)
        away = np.linalg.norm(centroid - self.centroid[row, marker], axis=-1) / self.reach[row, marker]
        size = moments[:, 0] / self.area[row, marker]
        likely = (gain >= LOOK.least_gain) & (found.peak >= LOOK.least_peak) & (away <= 1.0)
        likely &= (found.certainty >= LOOK.least_certainty) & (size >= LOOK.least_size)
        likely &= size <= LOOK.most_size
        if not likely.any():
            return None
        by_size = np.log(np.maximum(size, LOOK.least_size)) / LOOK.size_deviation
        cost = 0.5 * by_size**2 + 0.5 * (2.0 * away) ** 2
        main = int(np.where(likely, cost, np.inf).argmin())
        apart = np.linalg.norm(centroid - centroid[main], axis=-1)
        near = apart <= LOOK.rest_reach * self.length[marker]
        own = np.flatnonzero((gain >= LOOK.least_rest_gain) & near)
        return own if size[own].sum() <= LOOK.most_size else np.array([main])

    def held(
        self,
        observed: ObservedRegions,
        moments: Array,
        certainty: Array,
        alike: list[tuple[int, int]],
        factor: int,
    ) -> tuple[ObservedRegions, BoolArray]:
        """Finds (N, M), and which of them hold against the frames beside them and against markers alike.

        `moments` (N, M, 6): raw moments of the finds, NaN for none; `alike`: pairs of markers of one color.
        """
        centroid, second = centroid_and_second_moment(moments)
        area, known = moments[..., 0], np.isfinite(observed.centroid[..., 0])
        kept = np.isfinite(area)
        same = np.linalg.norm(centroid - observed.centroid, axis=-1) < self.length
        kept &= ~known | (same & (area > LOOK.more * observed.area))
        place = np.where(kept[..., None], centroid, observed.centroid)
        kept &= self._in_line(place)
        away = np.linalg.norm(centroid - self.centroid, axis=-1)
        for one, other in alike:
            shared = np.linalg.norm(place[:, one] - place[:, other], axis=-1) < 0.5 * self.length[one]
            nearer = away[:, one] < away[:, other]
            both = kept[:, one] & kept[:, other]
            kept[shared & ~(both & nearer), one] = False
            kept[shared & ~(both & ~nearer), other] = False
        ratio = area / np.maximum(self.area, 1e-6)
        whole = np.clip(np.minimum(ratio, 1.5 / np.maximum(ratio, 1e-6)), 0.0, 1.0)
        second = np.where(kept[..., None, None], second, np.eye(2))
        found = ObservedRegions.found(
            centroid, second, area, whole * certainty, self._variance(second, LOOK.place_std * factor)
        )
        return found, kept

    def _in_line(self, place: Array) -> BoolArray:
        """(N, M) whether a place is near the predicted one, or within a step of that in a frame beside it."""
        step = np.linalg.norm(np.diff(place, axis=0), axis=-1)
        step = np.where((np.diff(self.frame) == 1)[:, None] & np.isfinite(step), step, np.inf)
        nothing = np.full((1, place.shape[1]), np.inf)
        least = np.minimum(np.concatenate([nothing, step]), np.concatenate([step, nothing]))
        away = np.linalg.norm(place - self.centroid, axis=-1)
        return np.asarray((away <= LOOK.near * self.length) | (least <= LOOK.step * self.length))

    def _variance(self, second: Array, place_std: float) -> Array:
        """(N, M, 5) variance of finds' features beyond that of tracked regions [px²].

        A region swept by s while the shutter is open gains s sᵀ / 12 in its second moment; for how long it is
        open is not known, so that all of it is noise.
        """
        values, axes = np.linalg.eigh(second)
        deviation = np.sqrt(np.maximum(values, SMALLEST_DEVIATION_PX**2))
        swept = np.einsum("nmij,nmi->nmj", axes, self.sweep)  # along the region's own axes
        variance = np.full((*swept.shape[:2], FEATURES), place_std**2)
        for row, (a, b) in enumerate(((0, 0), (0, 1), (1, 1)), start=2):
            gained = swept[..., a] * swept[..., b] / 12.0
            variance[..., row] += (gained / (deviation[..., a] + deviation[..., b])) ** 2
        return variance


def _frames_away(seen: BoolArray) -> Array:
    """(F, M) number of frames to the nearest one in which a marker is seen well, at least one."""
    count = len(seen)
    index = np.arange(count)[:, None]
    before = np.maximum.accumulate(np.where(seen, index, -count), axis=0)
    after = np.minimum.accumulate(np.where(seen, index, 2 * count)[::-1], axis=0)[::-1]
    return np.asarray(np.clip(np.minimum(index - before, after - index), 1, count), dtype=np.float64)
