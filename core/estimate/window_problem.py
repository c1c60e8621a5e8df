"""Gauss-Newton on one window of a clip: first by the markers, then with the contours."""

from collections.abc import Generator
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, BoolArray
from ..body.posture import Posture
from ..progress import Part, Preview, scaled
from ..terms.contours import AxialTerm, ContourTerm
from ..terms.keypoints import KeypointTerm
from ..terms.regions import FEATURES, NOISE, RegionTerm
from ..terms.solver import assembling, gauss_newton
from ..terms.term import ClipState, NormalEquations, total_cost
from .assembly import window_terms
from .clip_problem import ClipProblem
from .contour_evidence import ContourEvidence
from .windows import Window

TEMPERATURES = (8.0, 4.0, 2.0, 1.0, 1.0, 1.0)  # of a first descent, which need not converge yet
FOUND_TEMPERATURES = (64.0, 32.0, 16.0, 16.0, 8.0, 8.0, 4.0, 4.0, 2.0, 2.0, *(1.0 for _ in range(14)))
"""From found keyframes the descent is longer and has more local minima."""
MOST_UNPACKED = 64 << 20  # bytes of pictures unpacked once; others are unpacked for every look


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
        found = bool(self.clip.data.belief.doubt.any())
        yield from self._gauss_newton(FOUND_TEMPERATURES if found else TEMPERATURES)

    def converge(self, steps: int = 9) -> Part[None]:
        """Gauss-Newton with the terms there are, from where markers were followed; yields likewise."""
        yield from self._gauss_newton((1.0,) * steps)

    def descend(self, temperatures: tuple[float, ...]) -> Generator[None, None, Array]:
        """Gauss-Newton steps with the terms there are.

        (F,) negative logarithm of each frame's probability where the steps end, up to a constant;
        `temperatures` are factors of the image's variance.
        """
        for _ in self._gauss_newton(temperatures):
            yield
        return total_cost(self.terms, self.state)

    def follow_contours(self, contours: ContourEvidence) -> Part[None]:
        """Go on with the contours, whose edges are measured anew each round; yields like `follow_markers`."""
        others = list(self.terms)
        contours = replace(contours, album=contours.album.opened(MOST_UNPACKED))
        looks = len(contours.schedule.looks)
        for number, search in enumerate(contours.schedule.looks):
            step_s = None if contours.along is None else self.clip.data.step_s
            measuring = contours.measure(self.state.posture, self.state.frame, search, step_s)
            begun, measured = number / looks, (number + 0.5) / looks
            edges, shifts = yield from scaled(measuring, begun, measured)
            self.terms = [*others, edges] if shifts is None else [*others, edges, shifts]
            yield from scaled(self._gauss_newton((1.0, 1.0)), measured, (number + 1) / looks)

    def _gauss_newton(self, temperatures: tuple[float, ...]) -> Part[None]:
        done = 0
        for _, state, is_new in gauss_newton(self.terms, self.state, temperatures):
            done += is_new
            yield done / len(temperatures)
            if is_new:
                self.state = state
                yield Preview(self.window.keep_first, state.posture[self.window.kept])

    def outlined(self) -> BoolArray:
        """(F, O) whether each part's contours were seen at the last look, in the frames the window keeps."""
        term = next(term for term in self.terms if isinstance(term, ContourTerm))
        return term.parts_seen()[self.window.kept]

    def solution(self) -> Generator[None, None, tuple[Posture, Array, Array]]:
        """Postures, their covariance and the centroids' residuals of the frames the window keeps."""
        state, kept = self.state, self.window.kept
        dofs = state.variation.shape[1]
        unmarked = any(isinstance(term, AxialTerm) for term in self.terms)
        outlines = [unmarked and isinstance(term, ContourTerm | AxialTerm) for term in self.terms]
        # 9.0: Factor of the contours' variance in the covariance of limbs without markers: what errs in one
        # part does so for many frames and in its neighbors too, and rows linearized where a limb leans toward
        # the camera know of no other side.
        doubt = np.where(outlines, 9.0, 1.0).tolist()
        equations = NormalEquations(state.frames, state.unknowns.shape[1])
        for _ in assembling(equations, self.terms, state, 1.0, doubt):
            yield
        factorized = equations.matrix.factorize()
        yield
        blocks = factorized.covariance_blocks()[kept, :dofs, :dofs]
        yield
        tangent_jacobian = state.tangent_jacobian[kept]
        covariance = np.asarray(
            tangent_jacobian @ blocks @ np.swapaxes(tangent_jacobian, -1, -2), dtype=np.float64
        )
        predicted = self.clip.evidence.model.evaluate(state.pose, state.frame)
        offset = predicted.centroid - self.clip.data.observed.centroid[self.window.frames]
        distance = np.hypot(offset[..., 0], offset[..., 1])
        distance[predicted.visible <= NOISE.least_visible] = np.nan
        return state.posture[kept], covariance, distance[kept]


def image_cost(clip: ClipProblem, states: list[ClipState]) -> Array:
    """(F,) what each marker seen costs on average in each frame of a clip; zero where nothing was solved.

    A keypoint has two of a marker's five rows and counts as much less.

    Where states overlap, the later one counts.
    """
    cost = np.zeros(clip.frames)
    for state in states:
        first, last = int(state.frame[0]), int(state.frame[-1]) + 1
        part = WindowProblem(clip, Window(first, last, first, last), state)
        seen = [term.cost(state) for term in part.terms if isinstance(term, RegionTerm | KeypointTerm)]
        cost[first:last] = np.sum(seen, axis=0)
    count = (clip.data.observed.quality > 0.0).sum(axis=1) + 2.0 / FEATURES * clip.data.points.seen.sum(
        axis=1
    )
    return cost / np.maximum(count, 1.0)
