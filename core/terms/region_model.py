"""Measurement model of the markers' image regions, with Jacobians."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property
from types import MappingProxyType

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.body_volume import Piece, PieceStack, body_pieces, marker_parts, segment_piece
from ..body.kinematics import Body, Pose
from ..body.rotations import cross
from ..camera.camera import Camera
from .occlusion import (
    TINY,
    Silhouette,
    edge_cut,
    near_edge,
    part_outlines,
    sample_silhouette,
    view_pieces,
    visible_share,
)

MOMENTS = ((0, 0), (0, 1), (1, 1))  # entries of a second-moment matrix in the order of rows: xx, xy, yy
USUAL: Mapping[str, Mapping[str, float]] = MappingProxyType(
    {
        "trunk": {"first": 0.07, "last": 1.12},
        "forearm": {"first": 0.04, "last": 0.89},
        "shin": {"first": 0.11, "last": 0.88, "girth": 1.17},
    }
)
"""A shirt covers the shoulders, which rise above their joints, and ends at the hip bones; trousers and
stockings are thicker than the leg inside. Medians of calibrations at a dozen performers' keyframes."""
PIECES_AT_ONCE = 600  # counted over frames, so that their samples fit in the cache


@dataclass(frozen=True, eq=False)
class MarkerPlacement:
    """Position of a marker on its segment and its thickness: the calibrated parameters."""

    segment: str
    first: float = 0.05  # share of the segment's length at which the color begins
    last: float = 0.95  # share at which it ends
    lateral_m: float = 0.0  # displacement along the segment's lateral direction [m]
    sagittal_m: float = 0.0  # displacement along its sagittal direction [m]
    girth: float = 1.0  # thickness relative to the average body's

    @classmethod
    def usual(cls, segment: str) -> "MarkerPlacement":
        """The usual placement of single-colored garments on a segment."""
        return cls(segment, **USUAL.get(segment.split(".")[0], {}))

    def pieces(self, body: Body) -> tuple[Piece, ...]:
        """The volume covered by the marker."""
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

    centroid: Array  # (F, M, 2) [px]
    second_moment: Array  # (F, M, 2, 2) [px²]
    area: Array  # (F, M) visible area [px²]
    visible: Array  # (F, M) visible share of the silhouette
    centroid_jacobian: Array | None = None  # (F, M, 2, D) [px per m or rad]
    moment_jacobian: Array | None = None  # (F, M, 3, D) of the entries xx, xy, yy [px² per m or rad]

    @classmethod
    def unmarked(cls, frames: int, dofs: int | None) -> "RegionPrediction":
        """The prediction of no marker at all, M = 0, with Jacobians by `dofs` unknowns where given."""
        empty = np.zeros((frames, 0))
        prediction = cls(np.zeros((frames, 0, 2)), np.zeros((frames, 0, 2, 2)), empty, empty)
        if dofs is None:
            return prediction
        by_tangent = {"centroid_jacobian": np.zeros((frames, 0, 2, dofs))}
        return replace(prediction, **by_tangent, moment_jacobian=np.zeros((frames, 0, 3, dofs)))

    @classmethod
    def concatenate(cls, stretches: list["RegionPrediction"]) -> "RegionPrediction":
        """One prediction of several stretches of frames, all with Jacobians or all without."""
        columns = {field.name: [getattr(one, field.name) for one in stretches] for field in fields(cls)}
        known = {name: parts for name, parts in columns.items() if parts[0] is not None}
        return cls(**{name: np.concatenate(parts) for name, parts in known.items()})


@dataclass(frozen=True, eq=False)
class RegionModel:
    """Predicts the image regions of given markers on an actor."""

    body: Body
    camera: Camera
    placements: tuple[MarkerPlacement, ...]

    @cached_property
    def _pieces(self) -> PieceStack:
        """The volumes covered by markers, Q of them, marker after marker."""
        return PieceStack.of(piece for placement in self.placements for piece in placement.pieces(self.body))

    @cached_property
    def _marker_of(self) -> IndexArray:
        """(Q,) the marker of each piece."""
        counts = [len(marker_parts(placement.segment)) for placement in self.placements]
        return np.repeat(np.arange(len(counts)), counts)

    @cached_property
    def _first_pieces(self) -> tuple[IndexArray, IndexArray]:
        """The first piece of each marker, and all other pieces."""
        _, first = np.unique(self._marker_of, return_index=True)
        return first, np.setdiff1d(np.arange(len(self._marker_of)), first)

    @cached_property
    def half_widths_m(self) -> Array:
        """(M,) mean half-width of the limb each marker sits on [m]."""
        pieces = [placement.pieces(self.body) for placement in self.placements]
        return np.array([np.mean([piece.half_widths for piece in own]) for own in pieces])

    @cached_property
    def _parts(self) -> PieceStack:
        return PieceStack.of(body_pieces(self.body))

    @cached_property
    def _own(self) -> BoolArray:
        """(Q, O) whether a part of the body belongs to the marker of a piece."""
        own = [marker_parts(self.placements[m].segment) for m in self._marker_of]
        return np.array([[part in names for part in self._parts.segments] for names in own])

    def evaluate(self, pose: Pose, frame: IndexArray, jacobian: bool = False) -> RegionPrediction:
        """Predict every marker's region.

        `jacobian`: with those of centroid and moments by the posture's tangent. Wholly hidden markers keep
        the moments of their whole silhouette.
        """
        if not self.placements:
            dofs = pose.posture.skeleton.dof_count if jacobian else None
            return RegionPrediction.unmarked(len(frame), dofs)
        count = max(1, round(len(frame) * len(self._marker_of) / PIECES_AT_ONCE))
        edges = [len(frame) * i // count for i in range(count + 1)]
        stretches = [slice(*pair) for pair in zip(edges[:-1], edges[1:], strict=True)]
        return RegionPrediction.concatenate([self._stretch(pose[s], frame[s], jacobian) for s in stretches])

    def _stretch(self, pose: Pose, frame: IndexArray, jacobian: bool) -> RegionPrediction:
        view = view_pieces(self._pieces, pose, self.camera, frame)
        samples = sample_silhouette(self._pieces, view)
        pixels, depth = self.camera.project(samples.world, frame[:, None, None])
        scale = (self.camera.focal_px / np.maximum(depth, 1e-3)) ** 2  # [px² per m²]
        parts = part_outlines(self._parts, pose, self.camera, frame)
        seen = scale * visible_share(pixels, depth, parts, self._own)
        cell, size = samples.area * scale, self.camera.resolution
        edge = np.nonzero(near_edge(pixels, cell, size))
        cut = edge_cut(pixels[edge], cell[edge], size)
        seen[edge] *= cut.share
        visible_area = self._per_marker((samples.area * seen).sum(2))
        whole_area = np.maximum(self._per_marker((samples.area * scale).sum(2)), TINY)
        visible = visible_area / whole_area
        # A wholly hidden marker is compared with no measurement, but its moments stay finite.
        hidden = visible < 1e-3
        factor = np.where(hidden[:, self._marker_of, None], scale, seen)
        total = np.maximum(np.where(hidden, whole_area, visible_area), TINY)
        factor = factor / total[:, self._marker_of, None]
        # The samples' weights, which sum to one over a marker: alone, and times offsets from the centroid.
        weighted = np.empty((*factor.shape[:2], 3, factor.shape[2]))
        np.multiply(factor, samples.area, out=weighted[:, :, 0])
        centroid = self._per_marker((weighted[:, :, :1] @ pixels)[:, :, 0])
        centered = np.moveaxis(pixels, -1, 2) - centroid[:, self._marker_of, :, None]  # (F, Q, 2, S)
        np.multiply(weighted[:, :, :1], centered, out=weighted[:, :, 1:])
        moment = self._per_marker(weighted[:, :, 1:] @ np.swapaxes(centered, -1, -2))
        prediction = RegionPrediction(centroid, moment, visible_area, visible)
        if not jacobian:
            return prediction
        cutting = edge, cut.slope
        derived = self._derive(samples, pose, frame, factor, weighted, centered, moment, cutting)
        return replace(prediction, **derived)

    def _per_marker(self, values: Array) -> Array:
        """Sum over the pieces of each marker: (F, Q, ...) to (F, M, ...)."""
        first, others = self._first_pieces
        total = values[:, first]
        for piece in others:
            total[:, self._marker_of[piece]] += values[:, piece]
        return total

    def _derive(
        self,
        samples: Silhouette,
        pose: Pose,
        frame: IndexArray,
        factor: Array,
        weighted: Array,
        centered: Array,
        moment: Array,
        cutting: tuple[tuple[IndexArray, ...], Array],
    ) -> dict[str, Array]:
        """Jacobians of centroid and moments, through the spatial velocity of each piece.

        `factor` (F, Q, S) turns a sample's area into its weight; `weighted` (F, Q, 3, S) holds the weights,
        alone and times `centered`; `cutting` are the pieces at the picture's edge, and how fast it cuts their
        samples.
        """
        count = samples.area.shape[-1]
        rates = self.camera.motion_jacobian(samples.world, frame[:, None, None])  # (F, Q, S, 2, 6)
        flat = np.moveaxis(rates, 2, -1).reshape(*rates.shape[:2], 12, count)
        summed = (weighted @ np.swapaxes(flat, -1, -2)).reshape(*weighted.shape[:3], 2, 6)
        mixed = summed[:, :, 1:]
        second = np.stack([mixed[:, :, a, b] + mixed[:, :, b, a] for a, b in MOMENTS], axis=2)
        middle = moment[:, self._marker_of]
        moving = np.concatenate([summed[:, :, 0], second], axis=2)  # (F, Q, 5, 6)
        effect = np.empty((*moving.shape[:3], count))
        effect[:, :, :2] = centered
        for row, (a, b) in enumerate(MOMENTS, start=2):
            np.multiply(centered[:, :, a], centered[:, :, b], out=effect[:, :, row])
            effect[:, :, row] -= middle[..., a, b, None]
        effect *= factor[:, :, None]
        # What moves out of the picture is seen no more.
        edge, slope = cutting
        lost = effect[edge] * samples.area[edge][:, None]  # (E, 5, S)
        moving[edge] += np.einsum("eks,esa,esab->ekb", lost, slope, rates[edge], optimize=True)
        rows = self._to_world(moving, frame)
        # Rotation also changes the share of the silhouette that each sample stands for.
        rows[..., 3:] += effect @ samples.area_rate
        moved = pose.posture.skeleton.moved_by[self._pieces.joint]  # (Q, D)
        derived = self._per_marker((rows @ pose.screws[:, None]) * moved[:, None])
        return {"centroid_jacobian": derived[:, :, :2], "moment_jacobian": derived[:, :, 2:]}

    def _to_world(self, rows: Array, frame: IndexArray) -> Array:
        """Convert derivatives (F, Q, K, 6) by a motion in camera axes to those by a motion in world axes."""
        rotation, location = self.camera.pose(frame[:, None])
        turned = np.swapaxes(rotation, -1, -2)
        linear, angular = rows[..., :3] @ turned, rows[..., 3:] @ turned
        # Rotation about an origin far from the camera is also a translation.
        return np.concatenate([linear, angular + cross(location[..., None, :], linear)], axis=-1)
