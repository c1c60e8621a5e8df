"""What a posture predicts of the markers' image regions, with Jacobians: the model g of method `map`.

Each marker covers a calibrated part of its segment's volume. Its visible silhouette is sampled; nearer
body parts hide samples; centroid and second moments are those of what stays visible (paper, eqs 1 to 4,
predicted instead of measured). Derivatives hold the samples' weights fixed.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..body.kinematics import Body, Pose
from ..body.shapes import Piece, body_pieces, marker_parts, segment_piece
from ..footage.camera import Camera
from .cover import Cover, cover, hidden_share, may_hide
from .outline import Outline, outline, view_piece

Array = NDArray[np.float64]

MOMENTS = ((0, 0), (0, 1), (1, 1))
"""Entries of a second-moment matrix in the order of rows: xx, xy, yy."""


@dataclass(frozen=True, eq=False)
class MarkerPlacement:
    """Where a marker sits on its segment and how thick it is there: what calibration finds."""

    segment: str
    first: float = 0.05
    """Share of the segment at which the colour begins."""
    last: float = 0.95
    """Share at which it ends."""
    lateral_m: float = 0.0
    """Displacement along the segment's lateral direction [m]."""
    sagittal_m: float = 0.0
    """Displacement along its sagittal direction [m]."""
    girth: float = 1.0
    """Thickness relative to the average body's."""

    def pieces(self, body: Body) -> tuple[Piece, ...]:
        """The volume that wears the colour."""
        parts = [segment_piece(body, name) for name in marker_parts(self.segment)]
        lengths = np.array([np.linalg.norm(part.end - part.start) for part in parts])
        edges = np.concatenate([[0.0], np.cumsum(lengths)]) / lengths.sum()
        pieces = []
        for i, part in enumerate(parts):
            scale = lengths.sum() / lengths[i]
            first = (self.first - edges[i]) * scale if i == 0 else 0.0
            last = (self.last - edges[i]) * scale if i == len(parts) - 1 else 1.0
            offset = self.lateral_m * part.lateral + self.sagittal_m * part.sagittal
            pieces.append(part.cut(first, last).changed(offset, self.girth))
        return tuple(pieces)


@dataclass(frozen=True, eq=False)
class RegionPrediction:
    """Predicted regions of M markers in F frames."""

    centroid: Array
    """(F, M, 2) [px]."""
    second_moment: Array
    """(F, M, 2, 2) [px²]."""
    area: Array
    """(F, M) visible area [px²]."""
    visible: Array
    """(F, M) share of the silhouette that nothing hides."""
    centroid_jacobian: Array | None = None
    """(F, M, 2, D) [px per m or rad]."""
    moment_jacobian: Array | None = None
    """(F, M, 3, D) of the entries xx, xy, yy [px² per m or rad]."""


@dataclass(frozen=True, eq=False)
class RegionModel:
    """Predicts the regions of given markers on an actor seen by a camera."""

    body: Body
    camera: Camera
    placements: tuple[MarkerPlacement, ...]

    def evaluate(self, pose: Pose, frame: NDArray[np.intp], jacobian: bool = False) -> RegionPrediction:
        """Predict every marker's region.

        Args:
            pose: Forward kinematics of F postures.
            frame: (F,) index of each posture's frame in the clip, for a moving camera.
            jacobian: Whether to derive centroid and moments by the posture's tangent as well.

        Returns:
            The prediction; markers that are wholly hidden keep the moments of their whole silhouette.
        """
        covers = self._covers(pose, frame)
        columns = [
            self._marker(placement, pose, frame, covers, jacobian) for placement in self.placements
        ]
        centroid, moment, area, visible, d_centroid, d_moment = zip(*columns, strict=True)
        return RegionPrediction(
            np.stack(centroid, 1),
            np.stack(moment, 1),
            np.stack(area, 1),
            np.stack(visible, 1),
            np.stack(d_centroid, 1) if jacobian else None,
            np.stack(d_moment, 1) if jacobian else None,
        )

    def _covers(self, pose: Pose, frame: NDArray[np.intp]) -> list[Cover]:
        parts = body_pieces(self.body)
        return [cover(part, view_piece(part, pose, self.camera, frame), self.camera, frame) for part in parts]

    def _marker(
        self,
        placement: MarkerPlacement,
        pose: Pose,
        frame: NDArray[np.intp],
        covers: list[Cover],
        jacobian: bool,
    ) -> tuple[Array, ...]:
        outlines = [
            outline(piece, view_piece(piece, pose, self.camera, frame)) for piece in placement.pieces(self.body)
        ]
        world = np.concatenate([part.world for part in outlines], axis=1)  # (F, S, 3)
        pixels, depth = self.camera.project(world, frame[:, None])
        scale = (self.camera.focal_px / np.maximum(depth, 1e-3)) ** 2
        area = np.concatenate([part.area for part in outlines], axis=1) * scale  # (F, S) [px²]
        own = marker_parts(placement.segment)
        seen = _visibility(pixels, depth, [c for c in covers if c.segment not in own])
        visible_area = (area * seen).sum(1)
        visible = visible_area / np.maximum(area.sum(1), 1e-9)
        # A wholly hidden marker is not compared with anything, but its moments stay finite.
        factor = scale * np.where(visible[:, None] < 1e-3, 1.0, seen)
        factor = factor / np.maximum((area / scale * factor).sum(1, keepdims=True), 1e-12)
        weight = area / scale * factor
        centroid = np.einsum("fs,fsi->fi", weight, pixels)
        centred = pixels - centroid[:, None]
        moment = np.einsum("fs,fsi,fsj->fij", weight, centred, centred)
        empty = np.zeros(0)
        rows = (empty, empty)
        if jacobian:
            rows = self._derive(outlines, pose, frame, factor, pixels - centroid[:, None], moment)
        return centroid, moment, visible_area, visible, *rows

    def _derive(
        self,
        outlines: list[Outline],
        pose: Pose,
        frame: NDArray[np.intp],
        factor: Array,
        centred: Array,
        moment: Array,
    ) -> tuple[Array, Array]:
        """Rows of centroid (F, 2, D) and moments (F, 3, D), through the spatial velocity of each piece.

        `factor` (F, S) turns a sample's area into its weight.
        """
        d_centroid = np.zeros((len(frame), 2, pose.posture.skeleton.dof_count))
        d_moment = np.zeros((len(frame), 3, pose.posture.skeleton.dof_count))
        last = 0
        for part in outlines:
            span = slice(last, last + part.world.shape[1])
            last = span.stop
            local = self.camera.project_jacobian(part.world, frame[:, None])  # (F, S, 2, 3)
            x = centred[:, span]
            w = factor[:, span] * part.area
            # A point p of a body with spatial velocity (v, ω) moves by v - [p]x ω.
            twist = np.concatenate([local, np.cross(part.world[:, :, None, :], local)], axis=-1)
            first = np.einsum("fs,fsik->fik", w, twist)  # (F, 2, 6)
            mixed = np.einsum("fs,fsi,fsjk->fijk", w, x, twist, optimize=True)
            second = np.stack([mixed[:, a, b] + mixed[:, b, a] for a, b in MOMENTS], axis=1)
            # Turning also changes how much of the silhouette each sample stands for.
            rate = factor[:, span, None] * part.area_rate  # (F, S, 3)
            first[..., 3:] += np.einsum("fsk,fsi->fik", rate, x)
            spread = np.stack([x[..., a] * x[..., b] - moment[:, None, a, b] for a, b in MOMENTS], axis=-1)
            second[..., 3:] += np.einsum("fsk,fsi->fik", rate, spread)
            moved = pose.screws * pose.posture.skeleton.moved_by[part.joint]
            d_centroid += first @ moved
            d_moment += second @ moved
        return d_centroid, d_moment


def _visibility(pixels: Array, depth: Array, parts: list[Cover]) -> Array:
    """Share (F, S) of each sample that no part hides."""
    seen = np.ones(depth.shape)
    for part in parts:
        rows = np.nonzero(may_hide(pixels, depth, part))[0]
        if len(rows):
            seen[rows] *= 1.0 - hidden_share(pixels[rows], depth[rows], _pick(part, rows))
    return seen


def _pick(part: Cover, rows: NDArray[np.intp]) -> Cover:
    return Cover(
        part.segment,
        part.start[rows],
        part.end[rows],
        part.depth[rows],
        part.half_width[rows],
        part.overshoot[rows],
    )
