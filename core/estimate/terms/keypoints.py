"""Keypoints against their prediction, in pixels: robust, and with errors that last."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Array, BoolArray, IndexArray
from ...body.kinematics import Pose
from ...evidence.keypoints import LEAST_CONFIDENCE, PIXEL_STD, DepthLinks, KeypointModel, ObservedKeypoints
from ..clip_state import ClipState
from .term import NormalEquations, add_errors, errors_cost


@dataclass(frozen=True, eq=False)
class KeypointTerm:
    """Compares every keypoint that is seen with its prediction."""

    model: KeypointModel
    observed: ObservedKeypoints
    std_m: Array  # (N,) error of a sure detection along each axis [m]; infinite for what is not believed
    kept: Array | None  # (F - 1, 1) share of an error that is left in the next frame; None: frames are apart
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add two rows for each keypoint."""
        error, std_px, used = self.errors(state.pose, state.frame)
        factor = np.where(used, 1.0 / std_px, 0.0)
        jacobian = self.model.pixels_jacobian(state.pose, state.frame, factor)
        add_errors(equations, error, used, jacobian, self.kept, temperature, state.tangent_jacobian)

    def cost(self, state: ClipState) -> Array:
        """(F,) see `errors_cost`."""
        error, _, used = self.errors(state.pose, state.frame)
        return errors_cost(error, used, self.kept)

    def errors(self, pose: Pose, frame: IndexArray) -> tuple[Array, Array, BoolArray]:
        """Errors (F, N, 2) in standard deviations, these (F, N) [px], and which are compared (F, N)."""
        pixel, depth = self.model.camera.project(self.model.world(pose), frame[:, None])
        scale = self.model.camera.focal_px / np.maximum(depth, 0.1)
        sure = np.maximum(self.observed.confidence, LEAST_CONFIDENCE)
        std_px = np.hypot(self.std_m * scale / sure, PIXEL_STD)
        error = (pixel - self.observed.pixel) / std_px[..., None]
        return error, std_px, np.isfinite(error).all(axis=-1) & np.isfinite(std_px)


@dataclass(frozen=True, eq=False)
class DepthHintTerm:
    """Compares the depths of all links with what they are expected to be by the network's guess."""

    model: KeypointModel
    links: DepthLinks
    expected: Array  # (F, L) depth of each link by its guess [m]; NaN where there is none
    std_m: Array  # (F, L) its error; infinite for what is not believed
    kept: Array | None  # as of `KeypointTerm`
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add one row for each link."""
        error, used = self._errors(state)
        jacobian = self.links.jacobian(self.model, state.pose, state.frame)
        jacobian = (jacobian * np.where(used, 1.0 / self.std_m, 0.0)[..., None])[:, :, None]
        add_errors(
            equations, error[..., None], used, jacobian, self.kept, temperature, state.tangent_jacobian
        )

    def cost(self, state: ClipState) -> Array:
        """(F,) see `errors_cost`."""
        error, used = self._errors(state)
        return errors_cost(error[..., None], used, self.kept)

    def _errors(self, state: ClipState) -> tuple[Array, BoolArray]:
        """(F, L) errors in standard deviations, and which are known."""
        error = (self.links.depths(self.model, state.pose, state.frame) - self.expected) / self.std_m
        return error, np.isfinite(error) & np.isfinite(self.std_m)
