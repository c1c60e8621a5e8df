"""Keypoints and guessed depths of a single frame, for several states of it side by side.

The rows are those of a clip's terms; but no frame comes before or after, so that errors last nowhere.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Array, BoolArray
from ...numerics.robust import student_cost, student_weight
from ...observation.depth_links import DepthLinks
from ...observation.keypoints import KeypointModel
from ..clip_state import ClipState
from .keypoints import KeypointTerm
from .term import DEGREES, NormalEquations


@dataclass(frozen=True, eq=False)
class FrameKeypointTerm:
    """Compares every keypoint of a frame with its prediction in each state."""

    clip_term: KeypointTerm
    """Of the same keypoints in as many frames as there are states."""
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add two rows for each keypoint."""
        error, std_px, used = self.clip_term.errors(state.pose, state.frame)
        jacobian = self.clip_term.model.pixels_jacobian(state.pose, state.frame) / std_px[..., None, None]
        jacobian = jacobian @ state.tangent_jacobian[:, None]
        _add_rows(equations, error, jacobian, used, temperature)

    def cost(self, state: ClipState) -> Array:
        """(F,) negative logarithm of Student's t over all keypoints, up to a constant."""
        error, _, used = self.clip_term.errors(state.pose, state.frame)
        return _cost(error, used)


@dataclass(frozen=True, eq=False)
class FrameDepthTerm:
    """Compares the depths of the body's links with a network's guess in each state."""

    model: KeypointModel
    links: DepthLinks
    expected: Array
    """(L,) depth of each link by its guess [m]; NaN where there is none."""
    std_m: Array
    """(L,) its error."""
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add a row for each link."""
        error, used = self._errors(state)
        jacobian = self.links.jacobian(self.model, state.pose, state.frame) @ state.tangent_jacobian
        jacobian = jacobian / self.std_m[:, None]
        _add_rows(equations, error, jacobian[:, :, None], used, temperature)

    def cost(self, state: ClipState) -> Array:
        """(F,) negative logarithm of Student's t over all links, up to a constant."""
        return _cost(*self._errors(state))

    def _errors(self, state: ClipState) -> tuple[Array, BoolArray]:
        depths = self.links.depths(self.model, state.pose, state.frame)
        error = ((depths - self.expected) / self.std_m)[..., None]
        return error, np.isfinite(error[..., 0]) & np.isfinite(self.std_m)


def _add_rows(
    equations: NormalEquations, error: Array, jacobian: Array, used: BoolArray, temperature: float
) -> None:
    """Add groups of rows (F, N, G) with Jacobians (F, N, G, n), each an outlier as a whole."""
    error = np.where(used[..., None], error, 0.0)
    squared = (error**2).sum(-1) / temperature
    weight = np.sqrt(np.where(used, student_weight(squared, DEGREES, error.shape[-1]), 0.0) / temperature)
    frames, _, _, unknowns = jacobian.shape
    jacobian = np.where(used[..., None, None], jacobian, 0.0) * weight[..., None, None]
    equations.add_rows(
        (error * weight[..., None]).reshape(frames, -1), jacobian.reshape(frames, -1, unknowns)
    )


def _cost(error: Array, used: BoolArray) -> Array:
    squared = np.where(used[..., None], error, 0.0) ** 2
    return np.asarray(student_cost(squared.sum(-1), DEGREES, error.shape[-1]).sum(-1))
