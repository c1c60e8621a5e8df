"""The markers' image regions against their prediction: centroid and second moments, in pixels.

A second-moment residual is turned into the observed region's own axes and divided by twice the mean
deviation along them, the linearized difference of matrix square roots: three numbers in pixels, with no
angle to wrap and nothing singular when the region is round (instead of S_θ and S_λ, paper eqs 5 and 6).
"""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import ClassVar

import numpy as np

from ..arrays import Array, IndexArray
from ..markers.region_tracks import RegionTracks
from .region_model import MOMENTS, RegionModel, RegionPrediction
from .term import ClipState, Rows, Term

FEATURES = 5  # rows of one marker: centroid x, y and three of shape


@dataclass(frozen=True)
class RegionNoise:
    """Noise of an observed region against a perfect model of the body.

    Two sources: the image (pixels, chroma subsampling, blur) and the surface (limbs are no cylinders,
    sleeves shift), which scales with the limb. Part of the latter changes slowly: a bias.
    """

    pixel_std_px: float = 0.35
    surface_centroid_share: float = 0.10  # of the segment's mean half-width, like the three that follow
    surface_shape_share: float = 0.07
    bias_centroid_share: float = 0.20
    bias_shape_share: float = 0.14
    bias_time_s: float = 0.67
    least_visible: float = 0.15  # least predicted visibility of a region that is compared

    def surface_std(self, width: Array) -> Array:
        """(..., 5) standard deviation of each feature for limbs of half-width (...) [as the width]."""
        return width[..., None] * _per_feature(self.surface_centroid_share, self.surface_shape_share)

    def bias_std(self, width: Array) -> Array:
        """(..., 5) standard deviation of each feature's slow bias for limbs of half-width (...)."""
        return width[..., None] * _per_feature(self.bias_centroid_share, self.bias_shape_share)


NOISE = RegionNoise()


def _per_feature(centroid: float, shape: float) -> Array:
    return np.repeat([centroid, shape], (2, FEATURES - 2))


@dataclass(frozen=True, eq=False)
class ObservedRegions:
    """Tracks with the axes and deviations that residuals need."""

    centroid: Array  # (F, M, 2), NaN where hidden
    second_moment: Array
    axes: Array  # (F, M, 2, 2) columns are the observed axes
    deviation: Array  # (F, M, 2) standard deviation of the region along them [px]
    area: Array  # (F, M) [px], NaN where hidden
    quality: Array  # (F, M)

    @classmethod
    def from_tracks(cls, tracks: RegionTracks) -> "ObservedRegions":
        """Axes and deviations of every visible region."""
        seen = tracks.visible
        moments = np.where(seen[..., None, None], tracks.second_moment, np.eye(2))
        quality = np.where(seen, tracks.quality, 0.0)
        values, axes = np.linalg.eigh(moments)
        # 0.6 px: what pixels resolve
        deviation = np.sqrt(np.maximum(values, 0.6**2))
        return cls(tracks.centroid, moments, axes, deviation, tracks.area, quality)

    def __getitem__(
        self, index: slice | IndexArray | tuple[slice | IndexArray, IndexArray]
    ) -> "ObservedRegions":
        """Some of the frames, of the frames and markers, or of the pairs of both."""
        return ObservedRegions(*(getattr(self, field.name)[index] for field in fields(self)))


def feature_rows(observed: ObservedRegions, predicted: RegionPrediction) -> tuple[Array, Array | None]:
    """Residuals (F, M, 5) [px], predicted minus observed, and their Jacobian (F, M, 5, D) if predicted."""
    centroid = predicted.centroid - observed.centroid
    turned = (
        np.swapaxes(observed.axes, -1, -2)
        @ (predicted.second_moment - observed.second_moment)
        @ observed.axes
    )
    divisor = observed.deviation[..., :, None] + observed.deviation[..., None, :]
    shape = np.stack([turned[..., a, b] / divisor[..., a, b] for a, b in MOMENTS], axis=-1)
    residual = np.concatenate([centroid, shape], axis=-1)
    if predicted.centroid_jacobian is None or predicted.moment_jacobian is None:
        return residual, None
    # Turning is linear in the entries xx, xy, yy: a 3 x 3 matrix a region.
    u = observed.axes
    turn = np.stack(
        [
            np.stack(
                [
                    u[..., 0, a] * u[..., 0, b],
                    u[..., 0, a] * u[..., 1, b] + u[..., 1, a] * u[..., 0, b],
                    u[..., 1, a] * u[..., 1, b],
                ],
                axis=-1,
            )
            / divisor[..., a, b, None]
            for a, b in MOMENTS
        ],
        axis=-2,
    )
    rows = [predicted.centroid_jacobian, turn @ predicted.moment_jacobian]
    return residual, np.concatenate(rows, axis=-2)


def limb_widths(model: RegionModel, places: Array, frame: IndexArray) -> Array:
    """(F, M) image half-width [px] of each marker's limb on a body at world places (F, 3)."""
    scale = model.camera.pixels_per_meter(model.camera.depth(places, frame))
    return np.asarray(scale[:, None] * model.half_widths_m)


def missing_variance(area: Array, area_ratio: Array, predicted: RegionPrediction) -> Array:
    """(F, M, 5) variance [px²] of the features for the part of a region that is missing, at an unknown end.

    A table or a door that is not known to stand there may hide a part of a marker. A share f that is cut off
    a bar's end moves its centroid by √3 f of its standard deviation, and shortens that by f.

    `area` (F, M) is seen [px]; `area_ratio` (M,) is that of an unhidden region relative to the predicted one.
    """
    expected = np.maximum(predicted.area * area_ratio, 1.0)
    # 0.25: share of an area that may be missing for other reasons than occlusion
    missing = np.clip(np.nan_to_num(1.0 - area / expected) - 0.25, 0.0, 1.0)
    variance = np.stack([predicted.second_moment[..., axis, axis] for axis in (0, 1)], axis=-1)
    shape = np.broadcast_to(variance.sum(-1, keepdims=True), (*variance.shape[:-1], FEATURES - 2))
    return np.asarray(np.concatenate([3.0 * variance, shape], axis=-1) * missing[..., None] ** 2)


# --- The term


GROUPS = (slice(0, 2), slice(2, FEATURES))  # rows that are outliers together: centroid and shape


@dataclass(frozen=True, eq=False)
class RegionTerm(Term):
    """Compares every visible marker with its prediction."""

    model: RegionModel
    observed: ObservedRegions
    width_px: Array  # (F, M) mean half-width of each marker's limb in the image [px]
    distrust: Array  # (M,) factor of the noise of each marker's regions
    area_ratio: Array  # (M,) area of each marker's unhidden region, relative to the predicted one
    is_image: ClassVar[bool] = True

    def rows(self, state: ClipState, slopes: bool = True) -> Iterator[Rows]:
        """Two and three rows for each marker that is seen and predicted to be seen.

        A marker that is seen where the posture hides it costs as much as one that is far off.
        """
        predicted = self.model.evaluate(state.pose, state.frame, jacobian=slopes)
        residual, jacobian = feature_rows(self.observed, predicted)
        residual = residual + state.bias.reshape(residual.shape)
        information = self.information(residual, predicted)
        used, by_bias = information[..., 0] > 0.0, np.sqrt(information)
        seen = np.isfinite(self.observed.centroid[..., 0])
        # 20.0: cost of a marker that is seen where it should be hidden
        contradicted = np.where(seen, 20.0 * self.observed.quality, 0.0)
        column = np.arange(residual[0].size).reshape(residual.shape[1:])
        for group in GROUPS:
            by = None if jacobian is None else jacobian[:, :, group] * by_bias[:, :, group, None]
            bias = by_bias[..., group], column[..., group]
            idle = contradicted if group is GROUPS[0] else None
            yield Rows(residual[..., group] * by_bias[..., group], by, used, idle, bias)

    def information(self, residual: Array, predicted: RegionPrediction) -> Array:
        """Information (F, M, 5) of each row [1/px²], outliers or not; zero for what is not compared."""
        usable = np.isfinite(residual).all(-1) & (predicted.visible > NOISE.least_visible)
        trust = np.clip(self.observed.quality * predicted.visible, 1e-3, 1.0)
        variance = NOISE.pixel_std_px**2 + NOISE.surface_std(self.width_px) ** 2
        variance = variance * self.distrust[:, None] ** 2
        variance = variance + missing_variance(self.observed.area, self.area_ratio, predicted)
        return np.asarray(np.where(usable[..., None], trust[..., None] / variance, 0.0))
