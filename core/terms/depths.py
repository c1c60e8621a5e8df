"""Depths of links between keypoints, as a network guesses them, and of principal points (paper, eq. 9)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..arrays import Array, IndexArray
from ..body.human import LIMB_SEGMENTS
from ..body.kinematics import Body, Pose
from ..body.posture import Posture
from ..body.skeleton import SIDES
from ..camera.camera import Camera
from .keypoints import KeypointModel
from .term import ClipState, Rows, Term

# --- Links of the body whose depth a network guesses


Ends = tuple[str, ...]  # body points whose middle is the end of a link
HIPS: Ends = ("hip.L", "hip.R")
SHOULDERS: Ends = ("shoulder.L", "shoulder.R")
HEADS: tuple[Ends, ...] = (("head",), ("nose",), ("ear.L", "ear.R"))  # what may stand for it, by preference


@dataclass(frozen=True, eq=False)
class DepthLinks:
    """L links between the N points of a model."""

    names: tuple[str, ...]  # (L,) without the side, which links on both sides share
    sources: tuple[str, ...]  # (L,) whose points they join
    ends: Array  # (L, N) weights of the points: 1 in all for the far end, -1 for the near one

    @classmethod
    def between(cls, names: Sequence[str], sources: Sequence[str]) -> "DepthLinks":
        """All links between points that one source has."""
        found: list[tuple[str, str, Array]] = []
        for source in dict.fromkeys(sources):
            index = {n: i for i, (n, s) in enumerate(zip(names, sources, strict=True)) if s == source}
            for name, far, near in _links(index):
                weights = np.zeros(len(names))
                for points, sign in ((far, 1.0), (near, -1.0)):
                    weights[[index[point] for point in points]] = sign / len(points)
                found.append((name, source, weights))
        ends = np.array([weights for _, _, weights in found]).reshape(len(found), len(names))
        return cls(tuple(name for name, _, _ in found), tuple(source for _, source, _ in found), ends)

    def lengths_m(self, model: KeypointModel) -> Array:
        """(L,) the links' lengths at rest [m]."""
        skeleton = model.body.skeleton
        rest = model.body.pose(Posture.from_vector(skeleton, np.zeros((1, skeleton.dof_count))))
        return np.linalg.norm(self.ends @ model.world(rest)[0], axis=-1)

    def guessed(self, depth: Array) -> Array:
        """(F, L) depths of the links by the points' guessed ones (F, N) [m]; NaN where an end is missing."""
        known = np.isfinite(depth)
        missing = (~known).astype(float) @ (self.ends != 0.0).T.astype(float)
        return np.where(missing == 0.0, np.where(known, depth, 0.0) @ self.ends.T, np.nan)

    def depths(self, model: KeypointModel, pose: Pose, frame: IndexArray) -> Array:
        """(F, L) depths of the links at F poses [m]; `frame` (F,) as in the clip."""
        return np.asarray(model.camera.depth(model.world(pose), frame[:, None]) @ self.ends.T)

    def jacobian(self, model: KeypointModel, pose: Pose, frame: IndexArray) -> Array:
        """(F, L, D) derivative of the depths by the posture's tangent."""
        used = np.flatnonzero(self.ends.any(axis=0))
        world = model.world(pose)[:, used]
        axis = model.camera.depth_jacobian(world, frame[:, None])
        return np.asarray(self.ends[:, used] @ pose.along_jacobian(model.joint[used], world, axis))


def _links(index: dict[str, int]) -> list[tuple[str, Ends, Ends]]:
    """Name, far and near end of the links between the points of one source."""
    head = next((ends for ends in HEADS if all(point in index for point in ends)), ())
    wanted: list[tuple[str, Ends, Ends]] = [
        ("hips", HIPS[:1], HIPS[1:]),
        ("shoulders", SHOULDERS[:1], SHOULDERS[1:]),
        ("trunk", SHOULDERS, HIPS),
        ("head", head, SHOULDERS),
    ]
    for _, near, far in LIMB_SEGMENTS:
        wanted += [(far, (f"{far}.{side}",), (f"{near}.{side}",)) for side in SIDES]
    return [
        (name, far, near)
        for name, far, near in wanted
        if far and all(point in index for point in (*far, *near))
    ]


@dataclass(frozen=True, eq=False)
class DepthHintTerm(Term):
    """Compares the depths of all links with what they are expected to be by the network's guess."""

    model: KeypointModel
    links: DepthLinks
    expected: Array  # (F, L) depth of each link by its guess [m]; NaN where there is none
    std_m: Array  # (F, L) its error; infinite for what is not believed
    lasting: Array | None = None
    is_image: ClassVar[bool] = True

    def rows(self, state: ClipState, slopes: bool = True) -> Iterator[Rows]:
        """One row for each link."""
        error = (self.links.depths(self.model, state.pose, state.frame) - self.expected) / self.std_m
        by = self.links.jacobian(self.model, state.pose, state.frame) if slopes else None
        by = None if by is None else (by / self.std_m[..., None])[:, :, None]
        yield Rows(error[..., None], by, np.isfinite(error) & np.isfinite(self.std_m))


# --- Depths of the principal points, d(θ) of the paper


# 0.1: variance of each depth's noise v_d [m²]: the paper's 10⁵ mm²
DEPTH_STD_M = 0.1**0.5


def point_depths(body: Body, camera: Camera, pose: Pose, frame: IndexArray | int) -> Array:
    """Depths of the principal points along the viewing axis (paper, eq. 9).

    (..., P) [m], positive in front of the camera, of poses of any batch shape; `frame` of the batch shape.
    """
    return camera.depth(body.points(pose), np.asarray(frame)[..., None])


def depths_jacobian(body: Body, camera: Camera, pose: Pose, frame: IndexArray | int) -> Array:
    """Derivative of the depths by the posture's tangent step, (..., P, D); arguments as `point_depths`."""
    points = body.points(pose)
    axis = camera.depth_jacobian(points, np.asarray(frame)[..., None])  # (..., P, 3)
    return pose.along_jacobian([point.joint for point in body.skeleton.points], points, axis)


@dataclass(frozen=True, eq=False)
class DepthTerm(Term):
    """d(θ) against d(θ_p)."""

    camera: Camera
    prior_depth: Array  # (F, P) [m]
    std_m: Array  # (F, P) [m]
    degrees: ClassVar[float | None] = None

    def rows(self, state: ClipState, slopes: bool = True) -> Iterator[Rows]:
        """One row for each point."""
        depth = point_depths(state.body, self.camera, state.pose, state.frame)
        by = depths_jacobian(state.body, self.camera, state.pose, state.frame) if slopes else None
        by = None if by is None else (by / self.std_m[..., None])[:, :, None]
        error = (depth - self.prior_depth) / self.std_m
        yield Rows(error[..., None], by, np.ones(error.shape, dtype=bool))
