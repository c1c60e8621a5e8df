"""Keypoints against their prediction, in pixels: robust, and with errors that last."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Array, BoolArray, IndexArray
from ...body.kinematics import Pose
from ...evidence.keypoints import LEAST_CONFIDENCE, PIXEL_STD, DepthLinks, KeypointModel, ObservedKeypoints
from ...numerics.robust import DEGREES, student_cost, student_weight
from ..clip_state import ClipState
from .motion import Drift, add_drift, drift, drift_cost
from .term import NormalEquations


@dataclass(frozen=True, eq=False)
class KeypointTerm:
    """Compares every keypoint that is seen with its prediction."""

    model: KeypointModel
    observed: ObservedKeypoints
    std_m: Array  # (N,) error of a sure detection along each axis [m]; infinite for what is not believed
    kept: Array  # (F - 1, N) share of an error that is left in the next frame
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add two rows for each keypoint."""
        error, std_px, used = self.errors(state.pose, state.frame)
        rows = drift(error, used, self.kept, temperature)
        factor = np.where(used, 1.0 / std_px, 0.0)
        jacobian = self.model.pixels_jacobian(state.pose, state.frame, factor)
        add_drift(equations, jacobian, rows, state.tangent_jacobian)

    def cost(self, state: ClipState) -> Array:
        """(F,) see `drift_cost`."""
        error, _, used = self.errors(state.pose, state.frame)
        return drift_cost(error, used, self.kept)

    def errors(self, pose: Pose, frame: IndexArray) -> tuple[Array, Array, BoolArray]:
        """Errors (F, N, 2) in standard deviations, these (F, N) [px], and which are compared (F, N)."""
        pixel, depth = self.model.camera.project(self.model.world(pose), frame[:, None])
        scale = self.model.camera.focal_px / np.maximum(depth, 0.1)
        sure = np.maximum(self.observed.confidence, LEAST_CONFIDENCE)
        std_px = np.hypot(self.std_m * scale / sure, PIXEL_STD)
        error = (pixel - self.observed.pixel) / std_px[..., None]
        return error, std_px, np.isfinite(error).all(axis=-1) & np.isfinite(std_px)

    def weigh(self, pose: Pose, frame: IndexArray) -> Drift:
        """The weights of all keypoints at given poses."""
        error, _, used = self.errors(pose, frame)
        return drift(error, used, self.kept)


# --- Keypoints and guessed depths of a single frame, for several states of it side by side


@dataclass(frozen=True, eq=False)
class FrameKeypointTerm:
    """Compares every keypoint of a frame with its prediction in each state."""

    clip_term: KeypointTerm  # of the same keypoints in as many frames as there are states
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
    expected: Array  # (L,) depth of each link by its guess [m]; NaN where there is none
    std_m: Array  # (L,) its error
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


# --- Hints of depth


@dataclass(frozen=True, eq=False)
class DepthHintTerm:
    """Compares the depths of all links with what they are expected to be by the network's guess."""

    model: KeypointModel
    links: DepthLinks
    expected: Array  # (F, L) depth of each link by its guess [m]; NaN where there is none
    std_m: Array  # (F, L) its error; infinite for what is not believed
    kept: Array  # (F - 1, 1) share of an error that is left in the next frame
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add one row for each link."""
        error, used = self._errors(state)
        rows = drift(error[..., None], used, self.kept, temperature)
        jacobian = self.links.jacobian(self.model, state.pose, state.frame)
        jacobian *= np.where(used, 1.0 / self.std_m, 0.0)[..., None]
        add_drift(equations, jacobian[:, :, None], rows, state.tangent_jacobian)

    def cost(self, state: ClipState) -> Array:
        """(F,) see `drift_cost`."""
        error, used = self._errors(state)
        return drift_cost(error[..., None], used, self.kept)

    def _errors(self, state: ClipState) -> tuple[Array, BoolArray]:
        """(F, L) errors in standard deviations, and which are known."""
        error = (self.links.depths(self.model, state.pose, state.frame) - self.expected) / self.std_m
        return error, np.isfinite(error) & np.isfinite(self.std_m)
