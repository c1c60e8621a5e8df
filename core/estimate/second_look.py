"""A second look for markers that were lost, blurred or half hidden, now that it is known where they should be.

Tracking knows colors and paths; by now postures and the look of background and body are known too. Where the
estimate predicts a marker in sight and none was tracked, or little of it, the album's picture around is unmixed
(`unmixing`). What is found there must be too much for chance, about as large as predicted and, the farther off
the prediction, in line with frames beside it.
"""

from collections.abc import Generator
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import binary_dilation

from ..arrays import Array, BoolArray, Image, IndexArray, chunks
from ..body.body_volume import body_pieces
from ..body.limbs import limb_of
from ..body.posture import Posture
from ..footage.appearance import Appearance
from ..footage.clips.album import Album
from ..footage.segmentation.moments import centroid_and_second_moment
from ..footage.segmentation.unmixing import Palette, Surface, Unmixed, contrast, scaled, traces
from ..footage.surface_colors import (
    bare_surfaces,
    common_colors,
    in_contrast,
    is_alike,
    marker_surfaces,
)
from ..progress import Part, scaled as progress
from .clip_problem import ClipProblem
from .clip_state import ClipState
from .contour_evidence import ContourEvidence
from .window_problem import WindowProblem
from .windows import Window
from .terms.regions import FEATURES, ObservedRegions

ROUNDS = 3
LOST = 0.5
"""Quality of a tracked region below which there is a second look."""
BESIDE = 2
"""Frames from hidden ones within which what little is tracked of a marker is looked at again."""
LEAST_AREA_PX = 6.0
"""Least predicted area, in pixels of the album."""
LEAST_GAIN = 10.0
"""Log likelihood ratio of a find: a window has e^8 places, and e^2 is for all the frames."""
LEAST_PEAK = 0.3
"""Least of a find's largest shares; skin and other colors never learned pass for less."""
NEAR = 1.0
"""Distance from the prediction, in lengths of the marker, within which a find stands alone."""
STEP = 1.0
"""Distance between successive frames: a limb moves less than its own length in one, else it is a smear."""
FARTHEST = 3.0
LEAST_AREA_SHARE, MOST_AREA_SHARE = 0.15, 2.0
"""Of the area predicted."""
AREA_DEVIATION = 1.2
MORE = 1.3
"""How much larger than the tracked region a find must be to replace it."""
PLACE_STD = 0.5
"""Standard deviation of a find's centroid beyond a tracked region's, in pixels of the album."""
SHUTTER = 0.5
"""Share of the time between frames in which the shutter is open: usual, between a quarter and all of it."""
CHUNK_FRAMES = 100


@dataclass(eq=False)
class _Finds:
    """What was found of M markers in F frames."""

    moments: Array
    """(F, M, 6), NaN where nothing."""
    sure: Array
    """(F, M) gain a pixel over the largest."""


def find_lost(
    problem: ClipProblem, spans: list[Window], states: list[ClipState], contours: ContourEvidence, anew: bool
) -> Part[ClipProblem]:
    """The problem with lost markers found in the frames that windows keep; states follow them where any are.

    Args:
        problem: The clip's problem.
        spans: The windows.
        states: The state of each by the markers so far; those of windows with finds are replaced.
        contours: The look of performer and background, and the clip's pictures.
        anew: Whether all frames are looked at.
    """
    left = list(range(len(spans)))
    for number in range(ROUNDS):
        begun = number / ROUNDS
        kept = [(spans[one], states[one].posture[spans[one].kept]) for one in left]
        frame = np.concatenate([np.arange(window.keep_first, window.keep_last) for window, _ in kept])
        posture = Posture.concatenate([posture for _, posture in kept])
        looking = look_again(problem, posture, frame, contours.appearance, contours.album)
        found = yield from progress(looking, begun, begun)
        changed = (found.observed.area != problem.observed.area) & np.isfinite(found.observed.area)
        left = [one for one in range(len(spans)) if changed[spans[one].frames].any()]
        problem = found
        for one in left:
            part = WindowProblem(problem, spans[one], states[one])
            yield from progress(part.follow_markers(), begun, (number + 1) / ROUNDS)
            states[one] = part.state.without_cache()
        if not left:
            break
    return problem


def look_again(
    problem: ClipProblem, posture: Posture, frame: IndexArray, appearance: Appearance, album: Album
) -> Generator[float, None, ClipProblem]:
    """The problem with lost markers observed where they are found at a second look; yields the fraction done.

    Args:
        problem: The clip's problem.
        posture: Postures of the frames, by what was observed so far.
        frame: (N,) ascending frames that are looked at; others keep what is observed.
        appearance: The look of performer and background.
        album: Pictures of the clip.
    """
    observed = problem.observed
    surfaces = marker_surfaces(album, observed.centroid, observed.second_moment, observed.quality)
    (common, part), background = common_colors(appearance), in_contrast(appearance)
    deviation = appearance.deviation.astype(np.float64)
    limbs = np.array([limb_of(one.segment) for one in body_pieces(problem.body)])[part]
    worn = [limb_of(one.segment) for one in problem.evidence.model.placements]
    bare = bare_surfaces(common, surfaces, limbs[:, None] == np.array(worn))
    palettes = [
        None if own is None else Palette(own, tuple(one for one in [*surfaces, *bare] if one and not is_alike(own, one)))
        for own in surfaces
    ]
    look = _Look(album, background, deviation, palettes)
    expected = _Expected.of(problem, posture, frame)
    finds = np.full((*expected.area.shape, 6), np.nan)
    sure = np.zeros(expected.area.shape)
    wanted = expected.wanted(observed[frame], album, frame)
    for chunk in chunks(np.arange(len(frame)), CHUNK_FRAMES):
        for row in chunk[wanted[chunk].any(axis=1)].tolist():
            picture = album.picture(int(frame[row]))
            for marker in np.flatnonzero(wanted[row]).tolist():
                found = look.at(picture, marker, expected, row)
                if found is not None:
                    finds[row, marker], sure[row, marker] = found
        yield (chunk[-1] + 1) / len(frame) if len(chunk) else 1.0
    return replace(problem, observed=_with_finds(problem, expected, frame, finds, sure, surfaces))


@dataclass(frozen=True, eq=False)
class _Expected:
    """The prediction for N frames and M markers, in pixels of the clip."""

    centroid: Array
    """(N, M, 2)."""
    area: Array
    """(N, M)."""
    length: Array
    """(M,) the marker's length where it is not foreshortened."""
    reach: Array
    """(N, M) how far from it is looked."""
    visible: Array

    @classmethod
    def of(cls, problem: ClipProblem, posture: Posture, frame: IndexArray) -> "_Expected":
        evidence = problem.evidence
        predicted = evidence.model.evaluate(problem.body.pose(posture), frame)
        longest = np.linalg.eigvalsh(predicted.second_moment)[..., 1]
        length = np.percentile(np.sqrt(12.0 * longest), 80, axis=0)
        seen = problem.observed.quality >= LOST
        away = _frames_away(seen)[frame]
        reach = length * np.minimum(NEAR + STEP * 0.5 * away, FARTHEST)
        return cls(predicted.centroid, predicted.area * evidence.area_ratio, length, reach, predicted.visible)

    def wanted(self, observed: ObservedRegions, album: Album, frame: IndexArray) -> BoolArray:
        """(N, M) which are looked for."""
        there = np.array([int(index) in album for index in frame])[:, None]
        large = self.area >= LEAST_AREA_PX * album.factor**2
        missing = ~(observed.area * MORE > self.area) & (observed.quality < LOST)
        hidden = np.isnan(observed.centroid[..., 0])
        beside = binary_dilation(hidden, np.ones((2 * BESIDE + 1, 1), dtype=bool))
        return np.asarray(there & large & missing & beside & (self.visible > 0.15))


def _frames_away(seen: BoolArray) -> Array:
    """(F, M) number of frames to the nearest one in which a marker is seen, at least one."""
    index = np.arange(len(seen))[:, None]
    before = np.maximum.accumulate(np.where(seen, index, -len(seen)), axis=0)
    after = np.minimum.accumulate(np.where(seen, index, 2 * len(seen))[::-1], axis=0)[::-1]
    return np.asarray(np.maximum(np.minimum(index - before, after - index), 1), dtype=np.float64)


@dataclass(frozen=True, eq=False)
class _Look:
    """Looks for markers in pictures."""

    album: Album
    background: Array
    deviation: Array
    palettes: list[Palette | None]

    def at(
        self, picture: Image, marker: int, expected: _Expected, row: int
    ) -> tuple[Array, float] | None:
        """Raw moments (6,) of a marker's trace in pixels of the clip, and how sure it is; None without any."""
        factor, (rows, columns) = self.album.factor, picture.shape[:2]
        center, reach = expected.centroid[row, marker] / factor, expected.reach[row, marker] / factor
        if not (np.isfinite(center).all() and np.isfinite(reach)):
            return None
        left, top = np.clip(np.floor(center - reach), 0, (columns, rows)).astype(int).tolist()
        right, bottom = np.clip(np.ceil(center + reach) + 1, 0, (columns, rows)).astype(int).tolist()
        if right - left < 3 or bottom - top < 3:
            return None
        where = slice(top, bottom), slice(left, right)
        palette = self.palettes[marker]
        if palette is None:
            return None
        seen = palette.unmix(contrast(picture[where]), self.background[where], self.deviation[where])
        return self._best(seen, (left, top), expected, row, marker)

    def _best(
        self, seen: Unmixed, origin: tuple[int, int], expected: _Expected, row: int, marker: int
    ) -> tuple[Array, float] | None:
        found = traces(seen.share, seen.gain, origin, self.background.shape[1::-1])
        moments = scaled(found.moments, self.album.factor)
        if not len(moments):
            return None
        centroid, _ = centroid_and_second_moment(moments)
        away = np.linalg.norm(centroid - expected.centroid[row, marker], axis=-1)
        likely = (found.gain >= LEAST_GAIN) & (found.peak >= LEAST_PEAK) & (away <= expected.reach[row, marker])
        size = moments[:, 0] / expected.area[row, marker]
        likely &= (size > LEAST_AREA_SHARE) & (size < MOST_AREA_SHARE)
        if not likely.any():
            return None
        cost = 0.5 * (np.log(size) / AREA_DEVIATION) ** 2
        cost = np.where(likely, cost + 0.5 * (2.0 * away / expected.reach[row, marker]) ** 2, np.inf)
        main = int(cost.argmin())
        joined = (found.gain >= 0.3 * LEAST_GAIN) & (
            np.linalg.norm(centroid - centroid[main], axis=-1) < 0.7 * expected.length[marker]
        )
        joined[main] = True
        total = moments[joined].sum(axis=0)
        if total[0] > MOST_AREA_SHARE * expected.area[row, marker]:
            joined[:] = False
            joined[main] = True
            total = moments[main]
        return total, float(found.certainty[main])


def _with_finds(
    problem: ClipProblem,
    expected: _Expected,
    frame: IndexArray,
    moments: Array,
    sure: Array,
    surfaces: list[Surface | None],
) -> ObservedRegions:
    """The observed regions, with those finds that hold against the frames beside them."""
    observed = problem.observed
    centroid, second = centroid_and_second_moment(moments)
    area = moments[..., 0]
    tracked = observed[frame]
    # A larger find of the same region, or of one that was not tracked.
    place = np.where(np.isnan(centroid), tracked.centroid, centroid)
    kept = np.isfinite(area)
    known = np.isfinite(tracked.centroid[..., 0])
    kept &= ~known | (
        (area > MORE * np.nan_to_num(tracked.area))
        & (np.linalg.norm(centroid - tracked.centroid, axis=-1) < expected.length)
    )
    kept &= _in_line(expected, frame, centroid, place)
    for one, surface in enumerate(surfaces):
        for other in range(one):
            rival = surfaces[other]
            if surface is not None and rival is not None and is_alike(surface, rival):
                _only_one(kept, expected, centroid, place, one, other)
    ratio = area / np.maximum(expected.area, 1e-6)
    quality = np.clip(np.minimum(ratio, 1.5 / ratio), 0.0, 1.0) * sure
    variance = _variance(problem, expected, second, place)
    row, marker = np.nonzero(kept)
    found = ObservedRegions.found(*(one[row, marker] for one in (centroid, second, area, quality, variance)))
    return observed.replaced((frame[row], marker), found)


def _in_line(expected: _Expected, frame: IndexArray, centroid: Array, place: Array) -> BoolArray:
    away = np.linalg.norm(centroid - expected.centroid, axis=-1)
    fine = away < NEAR * expected.length
    step = np.full(away.shape, np.inf)
    apart = np.linalg.norm(np.diff(place, axis=0), axis=-1)
    apart[np.diff(frame) != 1] = np.inf
    apart = np.where(np.isnan(apart), np.inf, apart)
    step[1:] = apart
    step[:-1] = np.minimum(step[:-1], apart)
    return np.asarray(fine | (step < STEP * expected.length))


def _only_one(
    kept: BoolArray, expected: _Expected, centroid: Array, place: Array, one: int, other: int
) -> None:
    """Of two markers alike, a find that is the other's region is none."""
    same = np.linalg.norm(place[:, one] - place[:, other], axis=-1) < 0.5 * expected.length[one]
    away = [np.linalg.norm(centroid[:, m] - expected.centroid[:, m], axis=-1) for m in (one, other)]
    both = kept[:, one] & kept[:, other]
    first = same & np.where(both, away[0] > away[1], True)
    second = same & np.where(both, away[0] <= away[1], True)
    kept[first, one] = False
    kept[second, other] = False


def _variance(problem: ClipProblem, expected: _Expected, second: Array, place: Array) -> Array:
    """(N, M, 5) variance of finds beyond that of tracked regions [px²].

    A region that moves by s while the shutter is open gains s sᵀ / 12 in its second moment, of which the
    shutter's time is not known.
    """
    return np.zeros((*second.shape[:2], FEATURES))
