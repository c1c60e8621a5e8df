"""The whole clip's estimation problem, cut into windows, and the steps that solve one."""

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..footage.camera import Camera
from ..observation import depths
from ..prior.process_noise import REFERENCE_STEP_S
from ..progress import Part, Preview, scaled
from .ankle_height import FOOTING_STD_M
from .clip_state import ClipState
from .contour_evidence import ContourEvidence
from .keyframe_evidence import KeyframeEvidence
from .terms.depths import DepthTerm
from .terms.ground import GroundTerm
from .terms.limits import LimitTerm
from .terms.quadratic import QuadraticBuilder, QuadraticTerm
from .terms.regions import FEATURES, ObservedRegions, RegionNoise, RegionTerm
from .terms.smoothness import SmoothnessTerm
from .terms.stillness import StillnessTerm
from .terms.term import NormalEquations, Term
from .windows import Window

TEMPERATURES = (8.0, 4.0, 2.0, *(1.0 for _ in range(9)))
FAR_TEMPERATURES = (64.0, 32.0, 16.0, 16.0, 8.0, 8.0, 4.0, 4.0, 2.0, 2.0, *(1.0 for _ in range(14)))
"""From keyframes that nobody posed the way is longer, and has more wrong turns."""
REFINEMENTS = (1.0, 1.0)
"""The steps that contours join in, when the markers have brought them within reach of their edges."""
LOOKS = 2
"""How often contours are looked for, each time nearer to where they are."""
LARGEST_STEP = 0.5
"""No unknown of the posture moves further in one step [m, rad]."""
SETTLED = 3e-3
"""The estimate has settled once no unknown of any posture moves further in a step [m, rad]."""
LOOKING_SHARE = 0.5
"""Share of following the contours that looking for them is."""
FOOT_POINTS = ("ankle.L", "ankle.R")
LARGEST_VARIATION = 20.0
"""Usual size of the deviation itself, in usual accelerations: weak, for what nothing else determines."""


@dataclass(frozen=True, eq=False)
class ClipProblem:
    """All that the estimate of a clip of F frames follows from, but for its pictures."""

    body: Body
    camera: Camera
    """As stated; the evidence has the lens that was found."""
    evidence: KeyframeEvidence
    factor: Array
    """(D, D) of the deviation's accelerations."""
    prior: Posture
    """A batch of F postures."""
    keyframes: IndexArray
    """(K,) frames whose prior was posed."""
    observed: ObservedRegions
    width_px: Array
    """(F, M) half-width of each marker's limb [px]."""
    step_s: Array
    """(F - 1,) time between frames [s]."""
    noise: RegionNoise
    matched: BoolArray
    """(K,) which keyframes nobody posed."""
    depth_std_m: Array
    """(F,) how far the prior's depths may be off [m]."""
    footing_m: Array | None = None
    """(F,) usual height of the lower ankle [m]; None where no floor is known of."""

    @property
    def frames(self) -> int:
        """Number of frames F."""
        return self.prior.batch[0]

    def window(self, window: Window, start: ClipState | None = None) -> "WindowProblem":
        """The problem of a window, to go on from a state of it; from the prior by default."""
        if start is None:
            frames, markers = window.last - window.first, self.observed.quality.shape[1]
            start = ClipState(
                self.body,
                self.prior[window.frames],
                np.arange(window.first, window.last),
                self.factor,
                np.zeros((frames, self.body.skeleton.dof_count)),
                np.zeros((frames, markers * FEATURES)),
            )
        return WindowProblem(self, window, start)


@dataclass(eq=False)
class WindowProblem:
    """The estimation problem of one window, and its solution."""

    clip: ClipProblem
    window: Window
    state: ClipState

    def __post_init__(self) -> None:
        """Gather the terms."""
        clip, frames = self.clip, self.window.frames
        self.evidence = clip.evidence
        self.observed = clip.observed[frames]
        self.width_px = clip.width_px[frames]
        self.step_s = clip.step_s[self.window.first : self.window.last - 1]
        skeleton = clip.body.skeleton
        pace = float(np.median(self.step_s)) / REFERENCE_STEP_S if len(self.step_s) else 1.0
        prior = clip.body.pose(self.state.prior)
        prior_depth = depths.evaluate(clip.body, clip.camera, prior, self.state.frame)
        feet = tuple(skeleton.point_names.index(name) for name in FOOT_POINTS)
        self.terms: list[Term] = [
            self._quadratic(),
            SmoothnessTerm(pace**1.5),
            RegionTerm(
                self.evidence.model,
                self.observed,
                clip.noise,
                self.width_px,
                self.evidence.distrust,
                self.evidence.whole,
            ),
            DepthTerm(clip.camera, prior_depth, clip.depth_std_m[frames, None]),
            LimitTerm(),
            StillnessTerm(clip.camera, feet, self.step_s),
        ]
        if clip.footing_m is not None:
            self.terms.append(GroundTerm(feet, clip.footing_m[frames], FOOTING_STD_M))

    def follow_markers(self) -> Part[None]:
        """Gauss-Newton with annealed image noise; yields the fraction done and the postures on the way."""
        far = bool(self.clip.matched.any())
        yield from self._descend(FAR_TEMPERATURES if far else TEMPERATURES, 0.0, 1.0)

    def follow_contours(self, contours: ContourEvidence) -> Part[None]:
        """Go on with the contours, looked for anew each time; yields like `follow_markers`."""
        others = list(self.terms)
        for look in range(LOOKS):
            looking = contours.term(self.state.posture, self.state.frame)
            begun, looked = look / LOOKS, (look + LOOKING_SHARE) / LOOKS
            term = yield from scaled(looking, begun, looked)
            self.terms = [*others, term]
            yield from self._descend(REFINEMENTS, looked, (look + 1) / LOOKS)

    def _descend(self, temperatures: tuple[float, ...], begun: float, ended: float) -> Part[None]:
        """Gauss-Newton steps until nothing moves any more."""
        for i, temperature in enumerate(temperatures):
            done = begun + (ended - begun) * i / len(temperatures)
            equations = NormalEquations(self.state.frames, self.state.unknowns.shape[1])
            for _ in self._gather(equations, temperature):
                yield done
            step = equations.matrix.factorise().solve(-equations.gradient)
            self.state, moved = self.state.stepped(step, LARGEST_STEP)
            yield begun + (ended - begun) * (i + 1) / len(temperatures)
            yield Preview(self.window.keep_first, self.state.posture[self.window.kept])
            if temperature == 1.0 and moved < SETTLED:
                break

    def kept(self) -> Generator[None, None, tuple[Posture, Array, Array]]:
        """Postures, their covariance and the centroids' residuals of the frames the window keeps.

        It yields now and then, so that whoever waits can stop waiting.
        """
        state, kept = self.state, self.window.kept
        dofs = state.variation.shape[1]
        equations = NormalEquations(state.frames, state.unknowns.shape[1])
        yield from self._gather(equations, 1.0)
        factorised = equations.matrix.factorise()
        yield
        blocks = factorised.covariance_blocks()[kept, :dofs, :dofs]
        yield
        chain = state.chain[kept]
        covariance = np.asarray(chain @ blocks @ np.swapaxes(chain, -1, -2), dtype=np.float64)
        predicted = self.evidence.model.evaluate(state.pose, state.frame)
        offset = predicted.centroid - self.observed.centroid
        distance = np.hypot(offset[..., 0], offset[..., 1])
        distance[predicted.visible <= self.clip.noise.least_visible] = np.nan
        return state.posture[kept], covariance, distance[kept]

    def _gather(self, equations: NormalEquations, temperature: float) -> Generator[None, None, None]:
        """Add the normal equations of all terms at the current state, one after the other."""
        _ = self.state.pose, self.state.chain  # which the terms share
        for term in self.terms:
            yield
            term.add_to(equations, self.state, temperature)
        yield

    def _quadratic(self) -> QuadraticTerm:
        """The deviation's size, trust in keyframes, and the biases' slow drift."""
        clip, noise = self.clip, self.clip.noise
        inside = (clip.keyframes >= self.window.first) & (clip.keyframes < self.window.last)
        dofs, frames = clip.body.skeleton.dof_count, len(self.width_px)
        size = noise.bias_std(self.width_px).reshape(frames, -1)
        builder = QuadraticBuilder(frames, dofs + size.shape[1])
        posture, bias = slice(0, dofs), slice(dofs, None)
        builder.add(posture, (1.0,), LARGEST_VARIATION)
        information = clip.factor.T @ self.evidence.information[inside] @ clip.factor
        builder.add_blocks(clip.keyframes[inside] - self.window.first, information)
        kept = np.exp(-self.step_s / noise.bias_time_s)[:, None]
        builder.add(bias, (-kept, 1.0), size[1:] * np.sqrt(1.0 - kept**2))
        first = np.full_like(size, np.inf)
        first[0] = size[0]
        builder.add(bias, (1.0,), first)
        return builder.term()
