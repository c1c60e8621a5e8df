"""Gauss-Newton on one window of a clip: first by the markers, then with the contours."""

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.posture import Posture
from ..progress import Part, Preview, scaled
from .clip_problem import ClipProblem
from .clip_state import ClipState
from .contour_evidence import ContourEvidence
from .terms.assembly import window_terms, with_contours
from .terms.term import NormalEquations
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


@dataclass(eq=False)
class WindowProblem:
    """The estimation problem of one window, and its solution."""

    clip: ClipProblem
    window: Window
    state: ClipState

    def __post_init__(self) -> None:
        """Assemble the terms."""
        self.terms = window_terms(self.clip, self.window, self.state)

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
            self.terms = with_contours(others, term)
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
        predicted = self.clip.evidence.model.evaluate(state.pose, state.frame)
        offset = predicted.centroid - self.clip.observed.centroid[self.window.frames]
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
