"""Method `map`: the most probable postures of the whole clip at once (maximum a posteriori).

Gauss-Newton over all frames, which is the iterated Kalman smoother (Bell 1994, *The iterated Kalman
smoother as a Gauss-Newton method*). The unknown is the deviation δ from the prior: smooth over time but for
bursts, as large as the keyframes' own differences suggest, near zero at keyframes by as much as they are
trusted; the regions, the prior's depths, feet at rest and the hinges' ranges pull on it. Image noise is
annealed, so that early steps do not lock on to a wrong visibility.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints
from ..markers.ignored_regions import IgnoredPixels
from ..markers.region_tracks import RegionTracks
from ..numerics.vectors import runs
from ..prior.frame_prior import REFERENCE_STEP_S, process_noise_factor
from ..progress import Part, scaled
from ..terms.keypoints import KeypointModel, ObservedKeypoints
from ..terms.reference import ExpectedPoints
from ..terms.region_model import MarkerPlacement, RegionModel
from ..terms.regions import ObservedRegions, RegionNoise, limb_widths
from ..video.album import Album
from .clip_problem import ClipProblem, KeyframeEvidence
from .contour_evidence import ContourEvidence, contour_rows, learn_contours
from .contour_search import all_located, contour_schedule
from .keyframe_error import depth_std_m
from .keyframe_evidence import SeenAtKeyframes
from .keyframe_trust import FEWEST_POSED, calibrating, read_mixed_keyframes
from .keypoint_evidence import KeypointEvidence
from .keypoint_fit import KeypointFit, keypoint_fit
from .keypoint_trust import doubted_at_changes, find_swaps, keypoint_trust, upright
from .performer_placement import lower_ankle_m
from .refinement import doubting, refine, rests_of
from .warm_start import blend_weight, continued, revised_windows
from .window_problem import WindowProblem
from .windows import Window, spliced, windows

MARKERS_SHARE, REFINED_SHARE = 0.35, 0.6  # of the work: following markers, all before contours


@dataclass(frozen=True)
class WholeClipOptions:
    """Noise of the whole-clip estimate, and the length of its windows."""

    regions: RegionNoise = field(default_factory=RegionNoise)
    window_s: float = 20.0  # longer clips are solved in windows of about this length [s] ...
    margin_s: float = 3.0  # ... that overlap by this, several times as far as any term remembers [s]
    resting: bool = True  # where keyframes are found, feet that rest are held


@dataclass(frozen=True, eq=False)
class Seen:
    """What was seen in the F frames of a clip."""

    tracks: RegionTracks  # regions of M markers
    segments: tuple[str, ...]  # the segment each marker is bound to
    keypoints: Keypoints | None = None  # the performer's; None for none
    album: Album | None = None  # pictures of all frames, in which contours are measured; None leaves them out
    ignored: IgnoredPixels | None = None  # what of the pictures is never a marker; None for nothing
    there: BoolArray | None = None  # (F,) frames in which the performer is there; all where None


@dataclass(frozen=True, eq=False)
class Believed:
    """What is believed of the motion before the footage is asked."""

    prior: Posture  # F postures that pass through the keyframes
    keyframes: tuple[int, ...]  # frames of the K keyframes, at least one
    match_scale: Array | None = None
    """(K,) size of each matched keyframe's error, relative to a usual difference between performers; 0 for
    posed ones, which all are by default."""
    lower_ankle: Array | None = None  # (F,) where all keyframes are matched [m]; by soles where None
    unseen: tuple[str, ...] = ()  # limbs that are never seen, whose feet say nothing of the place
    reference: ExpectedPoints | None = None  # where a motion from elsewhere has the points; None without one
    corrected: BoolArray | None = None  # (K,) which of the keyframes a person vouches for in the picture


@dataclass(frozen=True, eq=False)
class WholeClipResult:
    """The estimate of F frames; another estimate of the same clip may start from it."""

    posture: Posture  # a batch of F postures; the prior's where the performer is not there
    covariance: Array  # (F, D, D) of the posture's own tangent; NaN where he is not there
    residual_px: Array  # (F, M) predicted to observed centroids [px]; NaN where not compared
    problem: ClipProblem  # the problem it solves
    contours: ContourEvidence | None  # None where no background can be trusted
    outlined: BoolArray | None = None  # (F, O) which parts' contours were seen, where limbs have no markers

    @cached_property
    def keypoints(self) -> KeypointFit:
        """How the keypoints agree with the estimate."""
        problem = self.problem
        evidence = problem.evidence.keypoints
        return keypoint_fit(evidence, problem.keypoints, problem.points, problem.swapped, self.posture)

    @property
    def evidence(self) -> KeyframeEvidence:
        """Calibration from the footage at the keyframes: posing error, markers' placement, lens."""
        return self.problem.evidence


def estimate_whole_clip(
    body: Body,
    camera: Camera,
    seen: Seen,
    believed: Believed,
    options: WholeClipOptions | None = None,
    earlier: WholeClipResult | None = None,
) -> Part[WholeClipResult]:
    """Estimate every frame's posture from all frames.

    `earlier`: an estimate of the same pictures, reused for frames that have not changed since, within the
    tolerances of `warm_start`. Yields the fraction done and previews of windows.
    """
    options = options or WholeClipOptions()
    tracks, segments, album, prior = seen.tracks, seen.segments, seen.album, believed.prior
    observed = ObservedRegions.from_tracks(tracks)
    model = RegionModel(body, camera, tuple(MarkerPlacement.usual(name) for name in segments))
    width_px = limb_widths(model, prior.translation, np.arange(tracks.frame_count))
    index = np.array(believed.keyframes, dtype=np.intp)
    match_scale = np.zeros(len(index)) if believed.match_scale is None else believed.match_scale
    matched = match_scale > 0.0
    keypoints = Keypoints.none(tracks.frame_count) if seen.keypoints is None else seen.keypoints
    usual = KeypointEvidence.usual(body, camera, keypoints.names, keypoints.sources)
    swapped = _swaps(usual.model, keypoints, prior, index, tracks.time_s)
    keypoints = doubted_at_changes(keypoints.exchanged(swapped), swapped, tracks.time_s)
    corrected = np.zeros_like(matched) if believed.corrected is None else believed.corrected
    posed = index[calibrating(matched, corrected)]
    if keypoints.names and matched.all():  # keyframes posed in space tell how hints err
        keypoints = upright(keypoints, camera)
        usual = replace(usual, depths=usual.depths.unposed())
    points = ObservedKeypoints.of(keypoints)
    if keypoints.names and len(posed):
        said = keypoint_trust(usual.model, usual.sources, points, body.pose(prior[posed]), posed)
        usual = replace(usual, trust=said.trust, lag={name: lag for name, lag in said.lag.items() if lag})
    contours = None  # where markers judge keyframes, contours would add nothing
    if album is not None and not all_located(body, segments) and len(posed) >= FEWEST_POSED:
        schedule = contour_schedule(body, camera, album.factor, segments, prior)
        learning = learn_contours(body, camera, album, prior, posed, schedule)
        contours = yield from scaled(learning, 0.0, 0.0)
    outlines = None if contours is None else partial(contour_rows, contours)
    at = SeenAtKeyframes(
        index, prior[index], observed[index], width_px[index], usual, points[index], outlines
    )
    reading = read_mixed_keyframes(model, options.regions, at, match_scale, corrected)
    ankle_height_m = None  # posed keyframes say where the floor is, and better
    if matched.all() or believed.lower_ankle is not None:
        ankle_height_m = believed.lower_ankle
        if ankle_height_m is None:
            ankle_height_m = lower_ankle_m(body, prior[index], index, prior.batch[0])
    problem = ClipProblem(
        body=body,
        camera=camera,
        noise=options.regions,
        keyframes=index,
        matched=matched,
        corrected=corrected,
        evidence=(yield from scaled(reading, 0.0, 0.0)),
        factor=process_noise_factor(prior[index], tracks.time_s[index]),
        interpolated=prior,
        prior=prior,
        turns=np.zeros(max(len(index) - 1, 0), dtype=np.intp),
        depth_std_m=depth_std_m(index, matched, tracks.frame_count),
        ankle_height_m=ankle_height_m,
        limb_size=np.ones(body.skeleton.dof_count),
        rests=None,
        depth_factor=np.ones((tracks.frame_count, len(body.skeleton.points))),
        observed=observed,
        tracked=observed,
        width_px=width_px,
        ignored=seen.ignored,
        keypoints=keypoints,
        points=points,
        swapped=swapped,
        step_s=np.maximum(np.diff(tracks.time_s), 1e-3),
        there=np.ones(tracks.frame_count, dtype=bool) if seen.there is None else seen.there,
        unseen=believed.unseen,
        reference=believed.reference,
    )
    # Nothing but contours moves the postures away from the prior that they were learned from.
    kept = contours if not (segments or keypoints.names or matched.any()) else None
    return (yield from _solve(problem, options, album, earlier, kept))


def _swaps(
    model: KeypointModel, keypoints: Keypoints, prior: Posture, keyframes: IndexArray, time_s: Array
) -> BoolArray:
    """(F, N) keypoints whose sides are exchanged, by the interpolated keyframes."""
    if not keypoints.names:
        return np.zeros(keypoints.seen.shape, dtype=bool)
    frame = np.arange(len(time_s))
    depth = model.camera.depth(prior.translation, frame)
    scale = model.camera.focal_px / np.maximum(depth, 0.1)
    predicted = model.pixels(model.body.pose(prior), frame)
    return find_swaps(keypoints, predicted, scale, keyframes, time_s)


def _solve(
    problem: ClipProblem,
    options: WholeClipOptions,
    album: Album | None,
    earlier: WholeClipResult | None,
    contours: ContourEvidence | None,
) -> Part[WholeClipResult]:
    """Estimate in windows all frames, or those that changed since an earlier estimate."""
    pace = float(np.median(problem.step_s)) if len(problem.step_s) else REFERENCE_STEP_S
    length, margin = round(options.window_s / pace), round(options.margin_s / pace)
    kept = None if earlier is None else continued(earlier.problem, problem)
    if earlier is not None and kept is not None:
        problem, changed = kept
        spans = [
            window.moved(first)
            for first, last in runs(problem.there)
            for window in revised_windows(changed[first:last], length, margin // 2)
        ]
        result = yield from _solve_windows(problem, spans, changed, options, album, earlier)
        share = blend_weight(changed, margin // 2)[:, None]
        step = share * result.posture.minus(earlier.posture)
        return replace(result, posture=earlier.posture.plus(step))
    every = [
        window.moved(first)
        for first, last in runs(problem.there)
        for window in windows(last - first, length, margin)
    ]
    return (yield from _solve_windows(problem, every, problem.there, options, album, None, contours))


def _solve_windows(
    problem: ClipProblem,
    spans: list[Window],
    anew: BoolArray,
    options: WholeClipOptions,
    album: Album | None,
    earlier: WholeClipResult | None,
    contours: ContourEvidence | None = None,
) -> Part[WholeClipResult]:
    """Estimate the frames that windows keep.

    `anew` (F,): the frames decided anew; of all others `earlier` knows the estimate; `contours` None: to be
    learned once the markers are followed.
    """
    total = max(sum(window.keep_last - window.keep_first for window in spans), 1)
    shares = np.concatenate([[0.0], np.cumsum([w.keep_last - w.keep_first for w in spans]) / total])
    stretches = list(zip(spans, shares[:-1], shares[1:], strict=True))
    # All windows by their markers first: contours learned from the whole clip then join them without a seam.
    states = []
    resting = options.resting and bool(problem.matched.any())
    doubted = doubting(problem) if resting else problem
    for window, begun, ended in stretches:
        part = WindowProblem(doubted, window, problem.start(window))
        yield from scaled(part.follow_markers(), MARKERS_SHARE * begun, MARKERS_SHARE * ended)
        states.append(part.state.without_cache())
    if resting:
        problem = replace(problem, rests=rests_of(doubted, spans, states))
    if earlier is None:
        refining = refine(problem, spans, states, album, anew, contours)
    else:
        refining = refine(problem, spans, states, album, anew, earlier.contours, earlier.problem)
    problem, states, contours = yield from scaled(refining, MARKERS_SHARE, REFINED_SHARE)
    dofs = problem.body.skeleton.dof_count
    shape = (problem.frames, dofs, dofs)
    covariance = np.full(shape, np.nan) if earlier is None else earlier.covariance.copy()
    outlined = None if earlier is None or earlier.outlined is None else earlier.outlined.copy()
    if earlier is None and contours is not None and contours.along is not None:
        outlined = np.zeros((problem.frames, len(contours.model.parts.segments)), dtype=bool)
    unseen = np.full(problem.observed.quality.shape, np.nan)
    residual_px = unseen if earlier is None else earlier.residual_px.copy()
    postures: list[Posture] = []
    for window, begun, ended in stretches:
        first, last = (REFINED_SHARE + (1.0 - REFINED_SHARE) * share for share in (begun, ended))
        part = WindowProblem(problem, window, states.pop(0))
        last_steps = part.converge() if contours is None else part.follow_contours(contours)
        yield from scaled(last_steps, first, last)
        inner = slice(window.keep_first, window.keep_last)
        posture, covariance[inner], residual_px[inner] = yield from scaled(part.solution(), last, last)
        if outlined is not None:
            outlined[inner] = part.outlined()
        postures.append(posture)
    posture = spliced(problem.prior if earlier is None else earlier.posture, spans, postures)
    yield 1.0
    return WholeClipResult(posture, covariance, residual_px, problem, contours, outlined)
