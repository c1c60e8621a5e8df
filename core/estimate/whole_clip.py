"""Method `map`: the most probable postures of the whole clip at once (maximum a posteriori).

Gauss-Newton over all frames, which is the iterated Kalman smoother (Bell 1994, *The iterated Kalman
smoother as a Gauss-Newton method*). The unknown is the deviation δ from the prior: smooth over time but for
bursts, as large as the keyframes' own differences suggest, near zero at keyframes by as much as they are
trusted; the regions, the prior's depths, feet at rest and the hinges' ranges pull on it. Image noise is
annealed, so that early steps do not lock on to a wrong visibility.
"""

from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from ..arrays import Array, BoolArray, SingleArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints
from ..numerics.vectors import runs
from ..prior.frame_prior import REFERENCE_STEP_S
from ..progress import Part, scaled
from .belief import FEWEST_POSED, Belief
from .clip_problem import LOOSE_NECK, ClipData, ClipProblem, KeyframeEvidence, Seen, of_neck
from .contour_evidence import ContourEvidence, contour_rows, learn_contours
from .contour_search import all_located, contour_schedule
from .keyframe_evidence import SeenAtKeyframes, read_belief
from .keypoint_evidence import KeypointEvidence
from .keypoint_fit import KeypointFit, keypoint_fit
from .keypoint_trust import doubted_at_changes, find_swaps, keypoint_trust, upright
from .refinement import as_found, refine, rests_of
from .window_problem import WindowProblem
from .windows import spliced, windows

SHARES = {True: (0.2, 0.28), False: (0.6, 0.7)}
"""Of the work: following the markers, and all before the last steps; with pictures of frames and without."""


@dataclass(frozen=True, eq=False)
class WholeClipResult:
    """The estimate of F frames."""

    posture: Posture  # a batch of F postures; the prior's where the performer is not there
    covariance: SingleArray  # (F, D, D) of the posture's own tangent; NaN where he is not there
    residual_px: Array  # (F, M) predicted to observed centroids [px]; NaN where not compared
    problem: ClipProblem  # the problem it solves
    contours: ContourEvidence | None  # None where no background can be trusted
    outlined: BoolArray | None = None  # (F, O) which parts' contours were seen, where limbs have no markers

    @cached_property
    def keypoints(self) -> KeypointFit:
        """How the keypoints agree with the estimate."""
        data = self.problem.data
        return keypoint_fit(self.evidence.keypoints, data.keypoints, data.points, data.swapped, self.posture)

    @property
    def evidence(self) -> KeyframeEvidence:
        """Calibration from the footage at the keyframes: posing error, markers' placement, lens."""
        return self.problem.evidence


def estimate_whole_clip(
    body: Body, camera: Camera, seen: Seen, belief: Belief, hold_rests: bool = True
) -> Part[WholeClipResult]:
    """Estimate every frame's posture from all frames.

    `hold_rests`: where keyframes are found, feet that rest are held. Yields the fraction done and previews.
    """
    data, usual = _given(body, camera, seen, belief)
    album, keypoints, known = seen.album, data.keypoints, belief.frame[belief.calibrating]
    contours = None  # where markers judge keyframes, contours would add nothing
    if album is not None and not all_located(body, seen.segments) and len(known) >= FEWEST_POSED:
        schedule = contour_schedule(body, camera, album.factor, seen.segments, belief.prior)
        learning = learn_contours(body, camera, album, belief.prior, known, schedule)
        contours = yield from scaled(learning, 0.0, 0.0)
    outlines = None if contours is None else partial(contour_rows, contours)
    every = np.arange(len(data.time_s))
    at = SeenAtKeyframes(every, belief.prior, data.observed, data.width_px, usual, data.points, outlines)
    evidence = yield from scaled(read_belief(data.average, at[belief.frame], belief), 0.0, 0.0)
    if data.heads is not None:
        # How found keyframes turn heads that are seen is trusted less.
        loose = of_neck(body.skeleton, 1.0 / LOOSE_NECK)
        trust = np.where((~belief.posed & data.heads.seen[belief.frame])[:, None], loose, 1.0)
        evidence = replace(evidence, information=evidence.information * trust[:, :, None] * trust[:, None])
    # Nothing but contours moves the postures away from the prior that they were learned from.
    kept = contours if not (seen.segments or keypoints.names or belief.doubt.any()) else None
    return (yield from _solve(ClipProblem.begun(data, evidence), hold_rests, kept))


def _given(body: Body, camera: Camera, seen: Seen, belief: Belief) -> tuple[ClipData, KeypointEvidence]:
    """What is known, with the keypoints' sides set right, and what is usual of these keypoints."""
    every, prior, time_s = np.arange(seen.tracks.frame_count), belief.prior, seen.tracks.time_s
    keypoints = Keypoints.none(len(every)) if seen.keypoints is None else seen.keypoints
    beside = keypoints.beside if belief.reference is None else {}  # which has depths for its points
    usual = KeypointEvidence.usual(body, camera, keypoints.names, keypoints.sources, beside)
    scale = camera.pixels_per_meter(camera.depth(prior.translation, every))
    predicted = usual.model.pixels(body.pose(prior), every)
    swapped = find_swaps(keypoints, predicted, scale, belief.frame, time_s)
    keypoints = doubted_at_changes(keypoints.exchanged(swapped), swapped, time_s)
    if keypoints.names and not belief.posed.any():  # keyframes posed in space tell how hints err
        keypoints = upright(keypoints, camera)
        usual = replace(usual, depths=usual.depths.unposed())
    data, known = ClipData(body, camera, belief, seen, keypoints, swapped), belief.frame[belief.calibrating]
    if keypoints.names and len(known):
        trusted = keypoint_trust(usual.model, usual.sources, data.points, body.pose(prior[known]), known)
        lag = {name: lag for name, lag in trusted.lag.items() if lag}
        usual = replace(usual, trust=trusted.trust, lag=lag)
    return data, usual


def _solve(problem: ClipProblem, hold_rests: bool, contours: ContourEvidence | None) -> Part[WholeClipResult]:
    """Estimate all frames in windows; `contours` None: to be learned once the markers are followed."""
    data = problem.data
    # 20.0: longer clips are solved in windows of about this length ...
    # 3.0: ... that overlap by this, several times as far as any term remembers
    length, margin = (round(one / (data.pace * REFERENCE_STEP_S)) for one in (20.0, 3.0))
    spans = [
        window.moved(first)
        for first, last in runs(data.there)
        for window in windows(last - first, length, margin)
    ]
    total = max(sum(window.keep_last - window.keep_first for window in spans), 1)
    shares = np.concatenate([[0.0], np.cumsum([w.keep_last - w.keep_first for w in spans]) / total])
    stretches = list(zip(spans, shares[:-1], shares[1:], strict=True))
    # All windows by their markers first: contours learned from the whole clip then join them without a seam.
    states, (followed, refined) = [], SHARES[data.seen.album is not None]
    hold_rests = hold_rests and bool(data.belief.doubt.any())
    doubted = as_found(problem) if hold_rests else problem
    for window, begun, ended in stretches:
        part = WindowProblem(doubted, window, problem.start(window))
        yield from scaled(part.follow_markers(), followed * begun, followed * ended)
        states.append(part.state.without_cache())
    if hold_rests:
        problem = replace(problem, rests=rests_of(doubted, spans, states))
    refining = refine(problem, spans, states, contours)
    problem, states, contours = yield from scaled(refining, followed, refined)
    dofs = data.body.skeleton.dof_count
    # Half of what is kept of a frame, even in single precision.
    covariance = np.full((problem.frames, dofs, dofs), np.nan, dtype=np.float32)
    outlined = None
    if contours is not None and contours.along is not None:
        outlined = np.zeros((problem.frames, len(contours.model.parts.segments)), dtype=bool)
    residual_px = np.full(data.observed.quality.shape, np.nan)
    postures: list[Posture] = []
    for window, begun, ended in stretches:
        first, last = (refined + (1.0 - refined) * share for share in (begun, ended))
        part = WindowProblem(problem, window, states.pop(0))
        last_steps = part.converge() if contours is None else part.follow_contours(contours)
        yield from scaled(last_steps, first, last)
        inner = slice(window.keep_first, window.keep_last)
        posture, covariance[inner], residual_px[inner] = yield from scaled(part.solution(), last, last)
        if outlined is not None:
            outlined[inner] = part.outlined()
        postures.append(posture)
    yield 1.0
    posture = spliced(problem.prior, spans, postures)
    return WholeClipResult(posture, covariance, residual_px, problem, contours, outlined)
