"""Method `map`: the most probable postures of the whole clip at once (maximum a posteriori).

Gauss-Newton over all frames, which is the iterated Kalman smoother (Bell 1994, *The iterated Kalman
smoother as a Gauss-Newton method*). The unknown is the deviation δ from the prior: smooth over time but for
bursts, as large as the keyframes' own differences suggest, near zero at keyframes by as much as they are
trusted; the regions, the prior's depths, feet at rest and the hinges' ranges pull on it. Image noise is
annealed, so that early steps do not lock on to a wrong visibility.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import Array
from ..body.kinematics import Body
from ..body.posture import Posture
from ..footage.camera import Camera
from ..footage.clips.album import Album
from ..footage.region_tracks import RegionTracks
from ..observation.regions import MarkerPlacement, RegionModel
from ..prior.process_noise import REFERENCE_STEP_S, process_noise_factor
from ..progress import Part, scaled
from .ankle_height import lower_ankle_m
from .contour_evidence import ContourEvidence, learn_contours
from .keyframe_evidence import KeyframeEvidence
from .keyframe_trust import read_trust
from .match_error import depth_std_m
from .terms.regions import ObservedRegions, RegionNoise, limb_widths
from .warm_start import changed_frames, held, revised_share, revised_windows, same_setting
from .window_problem import ClipProblem
from .windows import Window, windows

MARKERS_SHARE = 0.5
"""Share of the work that is done before contours are looked for."""


@dataclass(frozen=True)
class WholeClipOptions:
    """What the whole-clip estimate believes, and how long a stretch it solves at once."""

    regions: RegionNoise = field(default_factory=RegionNoise)
    window_s: float = 20.0
    """Longer clips are solved in windows of about this length [s] ..."""
    margin_s: float = 3.0
    """... that reach this far into their neighbors: several times as far as any term remembers [s]."""


@dataclass(frozen=True, eq=False)
class WholeClipResult:
    """The estimate of F frames, and what another of the same clip can start from."""

    posture: Posture
    """A batch of F postures."""
    covariance: Array
    """(F, D, D) of the posture's own tangent."""
    residual_px: Array
    """(F, M) distance between the predicted and observed centroids [px]; NaN where not compared."""
    problem: ClipProblem
    """What it follows from."""
    contours: ContourEvidence | None
    """How performer and background look; None where no background can be trusted."""

    @property
    def evidence(self) -> KeyframeEvidence:
        """What the footage at the keyframes told: how they were posed, how the markers sit, the lens."""
        return self.problem.evidence


def estimate_whole_clip(
    body: Body,
    camera: Camera,
    tracks: RegionTracks,
    segments: tuple[str, ...],
    prior: Posture,
    keyframe_indices: tuple[int, ...],
    options: WholeClipOptions | None = None,
    album: Album | None = None,
    earlier: WholeClipResult | None = None,
    doubt: Array | None = None,
) -> Part[WholeClipResult]:
    """Estimate every frame's posture from all frames.

    Args:
        body: The actor's body.
        camera: The camera.
        tracks: Observed regions of F frames and M markers.
        segments: The segment each marker is bound to.
        prior: F postures that pass through the keyframes.
        keyframe_indices: Frames whose prior was posed, at least one.
        options: Noise, smoothness and windows.
        album: Pictures of all frames, for contours to be looked for; None does without.
        earlier: An estimate of the same pictures. What has not changed since is taken from it, within the
            tolerances of `revision`.
        doubt: (K,) of keyframes that a library was matched with and nobody posed, how far they are off, in
            usual differences between performers; 0 for posed ones, which all are by default.

    Yields:
        The fraction done, from 0 to 1, and what is known of a window's frames after every step.

    Returns:
        Postures, their covariance and what was calibrated on the way.
    """
    options = options or WholeClipOptions()
    observed = ObservedRegions.from_tracks(tracks)
    model = RegionModel(body, camera, tuple(MarkerPlacement.usual(name) for name in segments))
    width_px = limb_widths(model, prior.translation, np.arange(tracks.frame_count))
    index = np.array(keyframe_indices, dtype=np.intp)
    doubt = np.zeros(len(index)) if doubt is None else doubt
    matched = doubt > 0.0
    reading = read_trust(model, options.regions, observed[index], width_px[index], prior[index], index, doubt)
    evidence = yield from scaled(reading, 0.0, 0.0)
    factor = process_noise_factor(prior[index], tracks.time_s[index])
    step_s = np.maximum(np.diff(tracks.time_s), 1e-3)
    problem = ClipProblem(
        body,
        camera,
        evidence,
        factor,
        prior,
        index,
        observed,
        width_px,
        step_s,
        options.regions,
        matched,
        depth_std_m(index, matched, tracks.frame_count),
        # Posed keyframes say where the floor is, and better.
        lower_ankle_m(body, prior[index], index, tracks.frame_count) if matched.all() else None,
    )
    return (yield from _solve(problem, options, album, earlier))


def _solve(
    problem: ClipProblem, options: WholeClipOptions, album: Album | None, earlier: WholeClipResult | None
) -> Part[WholeClipResult]:
    """Estimate in windows what an earlier estimate does not tell already."""
    pace = float(np.median(problem.step_s)) if len(problem.step_s) else REFERENCE_STEP_S
    length, margin = round(options.window_s / pace), round(options.margin_s / pace)
    if earlier is not None and same_setting(earlier.problem, problem):
        same = held(earlier.problem, problem)
        if same is not None:
            changed = changed_frames(earlier.problem, same)
            spans = revised_windows(changed, length, margin // 2)
            result = yield from _solve_windows(same, spans, album, earlier)
            share = revised_share(changed, margin // 2)[:, None]
            step = share * result.posture.minus(earlier.posture)
            return replace(result, posture=earlier.posture.plus(step))
    return (yield from _solve_windows(problem, list(windows(problem.frames, length, margin)), album, None))


def _solve_windows(
    problem: ClipProblem, spans: list[Window], album: Album | None, earlier: WholeClipResult | None
) -> Part[WholeClipResult]:
    """Estimate the frames that some windows keep.

    Args:
        problem: What the estimate follows from.
        spans: The windows; without an earlier estimate they keep all of the clip's frames.
        album: Pictures of all frames.
        earlier: An estimate that holds in all other frames.
    """
    total = max(sum(window.keep_last - window.keep_first for window in spans), 1)
    shares = np.concatenate([[0.0], np.cumsum([w.keep_last - w.keep_first for w in spans]) / total])
    stretches = list(zip(spans, shares[:-1], shares[1:], strict=True))
    # All windows by their markers first: what is learned from the whole clip then joins them without a seam.
    states = []
    for window, begun, ended in stretches:
        part = problem.window(window)
        yield from scaled(part.follow_markers(), MARKERS_SHARE * begun, MARKERS_SHARE * ended)
        states.append(part.state.bare())
    contours = None if earlier is None else earlier.contours
    if earlier is None and album is not None:
        known = problem.evidence.model.camera  # with the lens that was found
        kept = [state.posture[window.kept] for state, window in zip(states, spans, strict=True)]
        learning = learn_contours(problem.body, known, album, Posture.concatenate(kept), problem.keyframes)
        contours = yield from scaled(learning, MARKERS_SHARE, MARKERS_SHARE)
    dofs = problem.body.skeleton.dof_count
    covariance = np.empty((problem.frames, dofs, dofs)) if earlier is None else earlier.covariance.copy()
    residual_px = np.empty(problem.observed.quality.shape) if earlier is None else earlier.residual_px.copy()
    postures: list[Posture] = []
    for window, begun, ended in stretches:
        first, last = (MARKERS_SHARE + (1.0 - MARKERS_SHARE) * share for share in (begun, ended))
        part = problem.window(window, states.pop(0))
        if contours is not None:
            yield from scaled(part.follow_contours(contours), first, last)
        inner = slice(window.keep_first, window.keep_last)
        posture, covariance[inner], residual_px[inner] = yield from scaled(part.kept(), last, last)
        postures.append(posture)
    posture = _spliced(problem.prior if earlier is None else earlier.posture, spans, postures)
    yield 1.0
    return WholeClipResult(posture, covariance, residual_px, problem, contours)


def _spliced(base: Posture, spans: list[Window], pieces: list[Posture]) -> Posture:
    """A batch of postures with those that windows keep replaced by pieces of their own."""
    translation, rotations, angles = base.translation.copy(), base.rotations.copy(), base.angles.copy()
    for window, piece in zip(spans, pieces, strict=True):
        inner = slice(window.keep_first, window.keep_last)
        translation[inner], rotations[inner], angles[inner] = piece.translation, piece.rotations, piece.angles
    return Posture(base.skeleton, translation, rotations, angles)
