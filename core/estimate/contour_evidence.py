"""Contours in the pictures, measured once the markers have located the body roughly.

The look of the body's parts and of the background is learned from some frames, the parts' thickness and place
from the keyframes, where the posture is known best; then edges are measured everywhere.
"""

from collections.abc import Generator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, BoolArray, Image, IndexArray, chunks
from ..body.kinematics import Body
from ..body.posture import Posture
from ..camera.camera import Camera
from ..markers.appearance import Appearance, BandColors, learn_appearance
from ..numerics.robust import DEGREES, student_weight
from ..terms.contours import (
    PIXEL_STD,
    SHAPE,
    SHARES,
    SIDES,
    SURFACE_SHARE,
    AxialTerm,
    ContourModel,
    ContourPrediction,
    ContourTerm,
    LimbAxes,
    part_map,
)
from ..video.album import Album
from .axial_search import find_shifts, learn_along
from .contour_search import BY_MARKERS, NARROW, Edges, Schedule, SearchRange, find_edges
from .keyframe_rows import LENS_DIFFERENCE, UNUSED, EvidenceRows
from .windows import evenly_spread

CHUNK_FRAMES = 50
SHAPE_STD_M = np.array([0.010, 0.010, 0.008, 0.008])  # of a performer's parts: thickness at both ends, place


@dataclass(frozen=True, eq=False)
class ContourEvidence:
    """Appearance and shapes by which contours are measured in any of a clip's frames."""

    album: Album  # pictures of the frames
    appearance: Appearance  # the look of performer and background
    model: ContourModel  # the contours of the performer's own parts
    schedule: Schedule = BY_MARKERS  # how far from the contours edges are looked for
    along: BandColors | None = None  # colors along each part, for shifts; None where markers tell these

    def measure(
        self, posture: Posture, frame: IndexArray, search: SearchRange = NARROW, step_s: Array | None = None
    ) -> Generator[float, None, tuple[ContourTerm, AxialTerm | None]]:
        """Measure the edges near the contours of F postures; yields the fraction done.

        With the times `step_s` between the clip's frames [s] also how parts are shifted along their axes.
        """
        edges, shifts = [], []
        for chunk in chunks(np.arange(len(frame)), CHUNK_FRAMES):
            at = posture[chunk], frame[chunk], search, self.album.pictures(frame[chunk])
            edges.append(self._edges(*at))
            if step_s is not None:
                shifts.append(self._shifts(*at))
            yield (chunk[-1] + 1) / len(frame)
        term = ContourTerm(self.model, *map(np.concatenate, zip(*edges, strict=True)))
        if step_s is None:
            return term, None
        # 0.3: Time in which such an error fades to a third. Believed as if each frame erred anew, it would
        # turn limbs toward or away from the camera.
        kept = np.exp(-step_s[frame[:-1]] / 0.3)[:, None]
        axes = LimbAxes(self.model.parts, self.model.camera)
        share, place, direction, variance = map(np.concatenate, zip(*shifts, strict=True))
        return term, AxialTerm(axes, share, place, direction, variance, kept)

    def _edges(
        self, posture: Posture, frame: IndexArray, search: SearchRange, pictures: tuple[Image, BoolArray]
    ) -> tuple[Array, Array, Array]:
        """Places, normals and variances of the edges, as `ContourTerm` has them."""
        predicted, edges = self.near(posture, frame, search, pictures)
        place = predicted.pixel + edges.distance[..., None] * predicted.normal
        place[~np.isfinite(edges.variance)] = np.nan
        variance = edges.variance + (PIXEL_STD * self.album.factor) ** 2
        return place, predicted.normal, variance

    def _shifts(
        self, posture: Posture, frame: IndexArray, search: SearchRange, pictures: tuple[Image, BoolArray]
    ) -> tuple[Array, Array, Array, Array]:
        """Shares, places, directions and variances of parts along their axes, as `AxialTerm` has them."""
        model, factor, (images, known) = self.model, self.album.factor, pictures
        assert self.along is not None
        pose = model.body.pose(posture)
        found = find_shifts(model, pose, frame, images, factor, self.appearance, self.along, search)
        _, pixel = LimbAxes(model.parts, model.camera).points(pose, frame, found.share)
        usable = np.isfinite(found.variance) & known[:, None]
        place = np.sum(pixel * found.direction, axis=-1) + found.distance
        # A part's colors lie 2 pixels off along its axis, and 3 cm: cuffs slip by 2 to 3.
        spread = (2.0 * factor) ** 2 + (0.03 * found.scale) ** 2
        variance = np.where(usable, found.variance, 1.0) + spread
        return found.share, np.where(usable, place, np.nan), found.direction, variance

    def near(
        self,
        posture: Posture,
        frame: IndexArray,
        search: SearchRange = NARROW,
        pictures: tuple[Image, BoolArray] | None = None,
    ) -> tuple[ContourPrediction, Edges]:
        """The contours of postures, and the edges near them."""
        pose = self.model.body.pose(posture)
        predicted = self.model.evaluate(pose, frame)
        image, known = pictures or self.album.pictures(frame)
        factor = self.album.factor
        edges = find_edges(self.model, predicted, pose, frame, image, factor, self.appearance, search)
        edges.distance[~known], edges.variance[~known] = 0.0, np.inf
        return predicted, edges


def learn_contours(
    body: Body,
    camera: Camera,
    album: Album,
    posture: Posture,
    keyframes: IndexArray,
    schedule: Schedule = BY_MARKERS,
) -> Generator[None, None, ContourEvidence | None]:
    """Learn the look of performer and background, and the shapes of the performer's parts.

    `keyframes`: frames whose posture is known best; a wide `schedule` says that only these are known. None
    where no background can be trusted: before a moving camera, or where most pictures are missing.
    """
    seen = np.array([index in album for index in range(posture.batch[0])])
    keyframes = keyframes[seen[keyframes]]
    if camera.is_moving or np.mean(seen) < 0.1 or len(keyframes) == 0:
        return None
    frame = np.flatnonzero(seen)
    model = ContourModel.average(body, camera)
    known = keyframes[evenly_spread(keyframes)]
    count = min(32, len(frame))
    looked = frame[np.unique(np.round((np.arange(count) + 0.5) * len(frame) / count - 0.5).astype(np.intp))]
    shown = yield from _labeled(model, album, posture[looked], looked)
    appearance = learn_appearance(*shown, len(model.parts.segments))
    if schedule.is_wide:
        labeled = yield from _labeled(model, album, posture[known], known)
        appearance = appearance.with_parts(*labeled, len(model.parts.segments)).where_steady()
    if not appearance.steady:
        return None
    fitted = yield from _fit_shapes(model, album, appearance, posture[known], known)
    along = None
    if schedule.is_wide:
        along = learn_along(model, body.pose(posture[known]), known, album.factor, *labeled)
    return ContourEvidence(album, appearance, fitted, schedule, along)


def _labeled(
    model: ContourModel, album: Album, posture: Posture, frame: IndexArray
) -> Generator[None, None, tuple[list[Image], list[NDArray[np.int8]]]]:
    """Pictures of frames, and which part of the body each pixel shows at their postures."""
    parts = model.part_outlines(model.body.pose(posture), frame)
    images = [album.picture(int(index)) for index in frame]
    size = images[0].shape[1], images[0].shape[0]
    yield
    labels = [part_map(parts, i, size, album.factor) for i in range(len(frame))]
    yield
    return images, labels


def _fit_shapes(
    model: ContourModel, album: Album, appearance: Appearance, posture: Posture, frame: IndexArray
) -> Generator[None, None, ContourModel]:
    """The model with shapes fitted to the edges at the best known postures."""
    stretches = chunks(np.arange(len(frame)), CHUNK_FRAMES)
    pictures = [album.pictures(frame[chunk]) for chunk in stretches]
    for _ in range(3):
        known, evidence = [], ContourEvidence(album, appearance, model)
        for chunk, seen in zip(stretches, pictures, strict=True):
            yield
            known.append(evidence.near(posture[chunk], frame[chunk], pictures=seen))
        model = replace(model, shape=_fitted_shape(model, known, album.factor))
    return model


def _fitted_shape(model: ContourModel, known: list[tuple[ContourPrediction, Edges]], factor: float) -> Array:
    """(O, SHAPE) corrections that best explain the edges at known postures."""
    rate = np.concatenate([predicted.shape_rate for predicted, _ in known])
    width = np.concatenate([predicted.half_width for predicted, _ in known])
    distance = np.concatenate([edges.distance for _, edges in known])
    variance = np.concatenate([edges.variance for _, edges in known])
    variance = variance + (PIXEL_STD * factor) ** 2 + (0.5 * SURFACE_SHARE * width) ** 2
    shape = np.zeros_like(model.shape)
    for part in np.unique(model.part_of):
        own = (model.part_of == part) & np.isfinite(variance)
        # Fewer edges tell no shape.
        if np.count_nonzero(own) < 20:
            continue
        rows, noise = rate[own], variance[own]
        wanted = distance[own] + rows @ model.shape[part]
        scale = np.linalg.norm(rows[:, :2], axis=-1)  # about the pixels of a meter
        # An edge lies 1.2 cm off the average part in the mean.
        spread = noise + (0.012 * scale) ** 2
        weight = student_weight(distance[own] ** 2 / spread, DEGREES, 1) / noise
        normal = rows.T @ (weight[:, None] * rows) + np.diag(SHAPE_STD_M**-2)
        shape[part] = np.linalg.solve(normal, rows.T @ (weight * wanted))
    return shape


HALVES = 2
ROWS = HALVES * len(SIDES)  # rows of a part


def contour_rows(contours: ContourEvidence, posture: Posture, frame: IndexArray) -> EvidenceRows:
    """A row for either side of both halves of each part, with the part's shape as parameters."""
    model, factor = contours.model, contours.album.factor
    predicted, edges = contours.near(posture, frame, contours.schedule.judging)
    average = replace(model, shape=np.zeros_like(model.shape))
    pose = model.body.pose(posture)
    flat = average.evaluate(pose, frame)
    camera = replace(model.camera, lens_mm=model.camera.lens_mm * float(np.exp(LENS_DIFFERENCE)))
    zoomed = replace(average, camera=camera).evaluate(pose, frame)
    by_lens = np.sum(predicted.normal * (zoomed.pixel - flat.pixel), axis=-1) / LENS_DIFFERENCE
    found = np.isfinite(edges.variance)
    # Average contours lie as far from the edges as the predicted ones and the fitted shape together.
    own_shape = np.sum(predicted.shape_rate * model.shape[model.part_of], axis=-1)
    residual = -edges.distance - own_shape
    scale = np.linalg.norm(predicted.shape_rate[..., :2], axis=-1)
    # 0.003: Error of an edge beyond the part's shape, which is fitted to the keyframes along with their own
    # errors.
    variance = edges.variance + (PIXEL_STD * factor) ** 2 + (0.003 * scale) ** 2
    weight = np.where(found, 1.0 / np.where(found, variance, 1.0), 0.0)
    groups = _groups(model)
    total = weight @ groups  # (J, G)

    def mean(values: Array) -> Array:
        """Weighted means over groups of samples (J, N, ...)."""
        summed = np.einsum("jn,jn...,ng->jg...", weight, values, groups)
        return summed / np.maximum(total, 1e-12).reshape(*total.shape, *([1] * (values.ndim - 2)))

    used = total > 0.0
    parts = len(model.parts.segments)
    own = np.zeros((*total.shape, parts, SHAPE))
    rows = np.arange(total.shape[1])
    own[:, rows, rows // ROWS] = mean(predicted.shape_rate)
    # Samples of a group err alike: they weigh as much as one.
    spread = (weight > 0.0) @ groups / np.maximum(total, 1e-12)

    return EvidenceRows(
        np.where(used, mean(residual), 0.0),
        own.reshape(*total.shape, parts * SHAPE),
        np.where(used, mean(by_lens), 0.0),
        np.where(used[..., None], mean(model.normal_jacobian(predicted, predicted.normal, pose)), 0.0),
        np.where(used, spread, UNUSED),
        np.diag(np.tile(SHAPE_STD_M, parts) ** -2),
    )


def _groups(model: ContourModel) -> Array:
    """(N, G) which samples belong to which of the rows: part by part, half by half, side by side."""
    samples = len(SHARES) * len(SIDES)
    within = np.arange(len(model.part_of)) % samples
    half, side = within // len(SIDES) * HALVES // len(SHARES), within % len(SIDES)
    group = model.part_of * ROWS + half * len(SIDES) + side
    return np.eye(len(model.parts.segments) * ROWS)[group]
