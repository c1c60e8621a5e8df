"""Method `map`: the most probable postures of the whole clip at once (maximum a posteriori).

Gauss-Newton over all frames, which is the iterated Kalman smoother (Bell 1994, *The iterated Kalman
smoother as a Gauss-Newton method*). The unknown is the deviation δ from the prior: smooth over time but for
bursts, as large as the keyframes' own differences suggest, near zero at keyframes by as much as they are
trusted; the regions, the prior's depths, feet at rest and the hinges' ranges pull on it. Image noise is
annealed, so that early steps do not lock on to a wrong visibility.
"""

from collections.abc import Generator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..body.kinematics import Body
from ..body.posture import Posture
from ..footage.album import Album
from ..footage.camera import Camera
from ..footage.tracks import RegionTracks
from ..observation import depths
from ..observation.regions import MarkerPlacement, RegionModel
from ..prior.variability import REFERENCE_STEP_S, acceleration_factor
from .clip_state import ClipState
from .contour_evidence import ContourEvidence, learn_contours
from .keyframe_evidence import KeyframeEvidence, read_keyframes
from .terms.depths import DepthTerm
from .terms.limits import LimitTerm
from .terms.quadratic import QuadraticBuilder, QuadraticTerm
from .terms.regions import FEATURES, ObservedRegions, RegionNoise, RegionTerm, limb_widths
from .terms.smoothness import SmoothnessTerm
from .terms.stillness import StillnessTerm
from .terms.term import NormalEquations, Term
from .windows import Window, windows

Array = NDArray[np.float64]

TEMPERATURES = (8.0, 4.0, 2.0, *(1.0 for _ in range(9)))
REFINEMENTS = (1.0, 1.0)
"""The steps that contours join in, when the markers have brought them within reach of their edges."""
LOOKS = 2
"""How often contours are looked for, each time nearer to where they are."""
MARKERS_SHARE = 0.7
"""Share of the work that is done before."""
LARGEST_STEP = 0.5
"""No unknown of the posture moves further in one step [m, rad]."""
SETTLED = 3e-3
"""The estimate has settled once no unknown of any posture moves further in a step [m, rad]."""
FOOT_POINTS = ("ankle.L", "ankle.R")
LARGEST_VARIATION = 20.0
"""Usual size of the deviation itself, in usual accelerations: weak, for what nothing else determines."""


@dataclass(frozen=True)
class WholeClipOptions:
    """What the whole-clip estimate believes, and how long a stretch it solves at once."""

    regions: RegionNoise = field(default_factory=RegionNoise)
    window_s: float = 20.0
    """Longer clips are solved in windows of about this length [s] ..."""
    margin_s: float = 3.0
    """... that reach this far into their neighbours: several times as far as any term remembers [s]."""


@dataclass(frozen=True, eq=False)
class WholeClipResult:
    """The estimate of F frames."""

    posture: Posture
    """A batch of F postures."""
    covariance: Array
    """(F, D, D) of the posture's own tangent."""
    evidence: KeyframeEvidence
    """What the footage at the keyframes told: how they were posed, how the markers sit, the lens."""
    residual_px: Array
    """(F, M) distance between the predicted and observed centroids [px]; NaN where not compared."""


def estimate_whole_clip(
    body: Body,
    camera: Camera,
    tracks: RegionTracks,
    segments: tuple[str, ...],
    prior: Posture,
    keyframe_indices: tuple[int, ...],
    options: WholeClipOptions | None = None,
    album: Album | None = None,
) -> Generator[float, None, WholeClipResult]:
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

    Yields:
        The fraction done, from 0 to 1.

    Returns:
        Postures, their covariance and what was calibrated on the way.
    """
    options = options or WholeClipOptions()
    observed = ObservedRegions.from_tracks(tracks)
    model = RegionModel(body, camera, tuple(MarkerPlacement(name) for name in segments))
    frame = np.arange(tracks.frame_count)
    width_px = limb_widths(model, prior.translation, frame)
    index = np.array(keyframe_indices, dtype=np.intp)
    evidence = read_keyframes(model, options.regions, observed[index], width_px[index], prior[index], index)
    factor = acceleration_factor(prior[index], tracks.time_s[index])
    step_s = np.maximum(np.diff(tracks.time_s), 1e-3)
    pace = float(np.median(step_s)) if len(step_s) else REFERENCE_STEP_S
    spans = list(windows(len(frame), round(options.window_s / pace), round(options.margin_s / pace)))

    def problem(window: Window, start: ClipState | None) -> _Problem:
        inside = (index >= window.first) & (index < window.last)
        return _Problem(
            body,
            camera,
            evidence,
            factor,
            prior[window.frames],
            frame[window.frames],
            observed[window.frames],
            width_px[window.frames],
            step_s[window.first : window.last - 1],
            np.flatnonzero(inside),
            index[inside] - window.first,
            options,
            start,
        )

    def share(window: Window, done: float) -> float:
        return (window.keep_first + done * (window.keep_last - window.keep_first)) / len(frame)

    # All windows by their markers first: what is learned from the whole clip then joins them without a seam.
    states: list[ClipState] = []
    for window in spans:
        part = problem(window, None)
        for done in part.follow_markers():
            yield MARKERS_SHARE * share(window, done)
        states.append(part.state.bare())
    contours = None
    if album is not None:
        kept = [state.posture[window.kept] for state, window in zip(states, spans, strict=True)]
        known = evidence.model.camera  # with the lens that was found
        contours = learn_contours(body, known, album, Posture.concatenate(kept), index)
    postures: list[Posture] = []
    dofs = body.skeleton.dof_count
    covariance = np.empty((len(frame), dofs, dofs))
    residual_px = np.empty(observed.quality.shape)
    for window in spans:
        part = problem(window, states.pop(0))
        if contours is not None:
            for done in part.follow_contours(contours):
                yield MARKERS_SHARE + (1.0 - MARKERS_SHARE) * share(window, done)
        inner = slice(window.keep_first, window.keep_last)
        posture, covariance[inner], residual_px[inner] = part.kept(window)
        postures.append(posture)
    yield 1.0
    return WholeClipResult(Posture.concatenate(postures), covariance, evidence, residual_px)


@dataclass(eq=False)
class _Problem:
    """The estimation problem of one window, and its solution."""

    body: Body
    camera: Camera
    evidence: KeyframeEvidence
    factor: Array
    """(D, D) of the deviation's accelerations."""
    prior: Posture
    frame: NDArray[np.intp]
    observed: ObservedRegions
    width_px: Array
    step_s: Array
    keyframes: NDArray[np.intp]
    """Which of the keyframes lie in the window."""
    keyframe_frames: NDArray[np.intp]
    """Their places in the window."""
    options: WholeClipOptions
    start: ClipState | None
    """Where to go on from; None for the prior."""

    def __post_init__(self) -> None:
        skeleton = self.body.skeleton
        frames, biases = len(self.frame), self.observed.quality.shape[1] * FEATURES
        self.state = self.start or ClipState(
            self.body,
            self.prior,
            self.frame,
            self.factor,
            np.zeros((frames, skeleton.dof_count)),
            np.zeros((frames, biases)),
        )
        pace = float(np.median(self.step_s)) / REFERENCE_STEP_S if len(self.step_s) else 1.0
        prior_depth = depths.evaluate(self.body, self.camera, self.body.pose(self.prior), self.frame)
        feet = tuple(skeleton.point_names.index(name) for name in FOOT_POINTS)
        self.terms: list[Term] = [
            self._quadratic(),
            SmoothnessTerm(pace**1.5),
            RegionTerm(
                self.evidence.model,
                self.observed,
                self.options.regions,
                self.width_px,
                self.evidence.distrust,
                self.evidence.whole,
            ),
            DepthTerm(self.camera, prior_depth),
            LimitTerm(),
            StillnessTerm(self.camera, feet, self.step_s),
        ]

    def follow_markers(self) -> Generator[float, None, None]:
        """Gauss-Newton with annealed image noise; yields the fraction done."""
        yield from self._descend(TEMPERATURES)

    def follow_contours(self, contours: ContourEvidence) -> Generator[float, None, None]:
        """Go on with the contours, looked for anew each time; yields the fraction done."""
        others = list(self.terms)
        for look in range(LOOKS):
            self.terms = [*others, contours.term(self.state.posture, self.frame)]
            for done in self._descend(REFINEMENTS):
                yield (look + done) / LOOKS

    def _descend(self, temperatures: tuple[float, ...]) -> Generator[float, None, None]:
        """Gauss-Newton steps until nothing moves any more; yields the fraction done."""
        for i, temperature in enumerate(temperatures):
            equations = self._equations(temperature)
            step = equations.matrix.factorise().solve(-equations.gradient)
            self.state, moved = self.state.stepped(step, LARGEST_STEP)
            yield (i + 1) / len(temperatures)
            if temperature == 1.0 and moved < SETTLED:
                break

    def kept(self, window: Window) -> tuple[Posture, Array, Array]:
        """Postures, their covariance and the centroids' residuals of the frames a window keeps."""
        state, dofs = self.state, self.state.variation.shape[1]
        blocks = self._equations(1.0).matrix.factorise().covariance_blocks()[window.kept, :dofs, :dofs]
        chain = state.chain[window.kept]
        covariance = np.asarray(chain @ blocks @ np.swapaxes(chain, -1, -2), dtype=np.float64)
        predicted = self.evidence.model.evaluate(state.pose, state.frame)
        offset = predicted.centroid - self.observed.centroid
        distance = np.hypot(offset[..., 0], offset[..., 1])
        distance[predicted.visible <= self.options.regions.least_visible] = np.nan
        return state.posture[window.kept], covariance, distance[window.kept]

    def _equations(self, temperature: float) -> NormalEquations:
        """The normal equations of all terms at the current state."""
        equations = NormalEquations(self.state.frames, self.state.unknowns.shape[1])
        for term in self.terms:
            term.add_to(equations, self.state, temperature)
        return equations

    def _quadratic(self) -> QuadraticTerm:
        """The deviation's size, trust in keyframes, and the biases' slow drift."""
        noise = self.options.regions
        dofs, frames = self.body.skeleton.dof_count, len(self.frame)
        size = noise.bias_std(self.width_px).reshape(frames, -1)
        builder = QuadraticBuilder(frames, dofs + size.shape[1])
        posture, bias = slice(0, dofs), slice(dofs, None)
        builder.add(posture, (1.0,), LARGEST_VARIATION)
        information = self.factor.T @ self.evidence.information[self.keyframes] @ self.factor
        builder.add_blocks(self.keyframe_frames, information)
        kept = np.exp(-self.step_s / noise.bias_time_s)[:, None]
        builder.add(bias, (-kept, 1.0), size[1:] * np.sqrt(1.0 - kept**2))
        first = np.full_like(size, np.inf)
        first[0] = size[0]
        builder.add(bias, (1.0,), first)
        return builder.term()
