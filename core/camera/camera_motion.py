"""A camera that was said to stand still, as its background shows it: hand-held, panned, zoomed or carried.

Corners of the background are followed from an anchor frame (Lucas & Kanade 1981, pyramids as Bouguet 2000
describes them) and held against a camera that only turns and zooms about its place, which maps pictures of
any scene by a homography K Z R K⁻¹ (Hartley & Zisserman 2004, §8.4). Where too few corners agree with one the
camera has moved from its place.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, BoolArray, Image, IndexArray
from ..body.rotations import exponential
from ..video.album import Album

MOST_CORNERS, FEWEST_CORNERS = 300, 12
AGREEING_PX = 1.5
"""Distance of a corner from where the homography has it, within which it agrees [px of the album]."""
TURNING = 0.7
"""Share of corners that agree, in nine frames of ten, where the camera only turns and zooms."""
LOST = 0.5
"""Share of an anchor's corners below which the next frame becomes the anchor."""
MARGIN = 0.15
"""Around what is seen of the performer, in its larger side: what of him moves beyond his joints."""
STEP = 1e-6
"""Of the turn [rad] and the zoom's logarithm, for differences."""
WINDOW: dict[str, Any] = {"winSize": (21, 21), "maxLevel": 3, "flags": cv2.OPTFLOW_USE_INITIAL_FLOW}
NOTICED = 0.006
"""Movement of the picture, as a share of its width, from which on a camera counts as moving: 2 px in 320.
Compression and noise move corners by a tenth of that; at four meters it puts a performer off by 2 cm."""
ZOOMING = 0.08
"""Change of size from which on it zooms: more than an autofocus that breathes, or some degrees of a turn."""


@dataclass(frozen=True, eq=False)
class CameraMotion:
    """How a camera's pictures moved in F frames."""

    frames: IndexArray  # (F,) their indices in the clip
    homography: Array  # (F, 3, 3) takes pixels of the reference view to those of each frame
    agreeing: Array  # (F,) share of the background's corners that agree with it
    moved_px: float  # how far the picture's corners travel from the reference view: the largest [px]
    zoom: float  # largest size over the smallest
    noticed: bool  # whether that is more than a camera that stands still shows

    @property
    def turns(self) -> bool:
        """Whether the camera only turns and zooms."""
        return float(np.percentile(self.agreeing, 10.0)) >= TURNING


def camera_motion(
    album: Album, frames: IndexArray, places: Array, intrinsic: Array, size: tuple[int, int]
) -> CameraMotion | None:
    """How the background moves in some frames; None where it shows too few corners.

    Args:
        album: Pictures of the clip.
        frames: (F,) indices of the frames, rising.
        places: (all frames, N, 2) what is seen of the performer [px]; NaN where it is not.
        intrinsic: (3, 3) the camera's matrix K, from directions to pixels of the clip.
        size: Width and height of the clip's pictures [px].
    """
    frames = np.array([frame for frame in frames if int(frame) in album], dtype=np.intp)
    if len(frames) < 2:
        return None
    scale = np.diag([album.factor, album.factor, 1.0])
    matrix = np.linalg.inv(scale) @ intrinsic
    found = [*_followed(album, frames, places / album.factor, matrix)]
    if len(found) < len(frames):
        return None
    homography = np.stack([scale @ own @ np.linalg.inv(scale) for own, _ in found])
    width, height = size
    corners = np.array([[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]])
    seen = np.stack([moved(own, corners) for own in homography])
    sizes = np.sqrt([cv2.contourArea(own.astype(np.float32)) for own in seen])
    zoom = float(sizes.max() / sizes.min())
    # A stated pose is the mean one of a hand that shakes, and the lens that of the clip's beginning.
    usual = seen[0] if zoom > 1.0 + ZOOMING else seen.mean(axis=0)
    origin = cv2.getPerspectiveTransform(usual.astype(np.float32), corners.astype(np.float32))
    homography = homography @ origin
    away = np.stack([moved(own, corners) for own in homography]) - corners
    moved_px = float(np.percentile(np.linalg.norm(away, axis=-1).mean(axis=1), 95.0))
    return CameraMotion(
        frames,
        homography,
        np.array([share for _, share in found]),
        moved_px,
        zoom,
        moved_px > NOTICED * width,
    )


def moved(homography: Array, points: Array) -> Array:
    """Points (..., 2) mapped by a homography (3, 3) or several (..., 3, 3)."""
    whole = np.concatenate([points, np.ones((*points.shape[:-1], 1))], axis=-1)
    mapped = np.einsum("...ij,...j->...i", homography, whole)
    return np.asarray(mapped[..., :2] / mapped[..., 2:])


def _followed(
    album: Album, frames: IndexArray, places: Array, matrix: Array
) -> Iterator[tuple[Array, float]]:
    """For each frame the homography from the first and the share of corners that agree, as far as known."""
    gray = _gray(album, int(frames[0]))
    anchor, base = gray, np.eye(3)
    corners = _corners(gray, places[frames[0]])
    last = np.eye(3)  # from the anchor to the frame before
    yield np.eye(3), 1.0
    for frame in frames[1:]:
        if len(corners) < FEWEST_CORNERS:
            return
        gray = _gray(album, int(frame))
        start = moved(last, corners.astype(np.float64)).astype(np.float32)
        found, there, _ = cv2.calcOpticalFlowPyrLK(
            anchor, gray, corners[:, None], start[:, None].copy(), **WINDOW
        )
        ends = np.asarray(found, dtype=np.float32)
        kept, box = there[:, 0] > 0, _box(places[frame])
        if box is not None:
            kept &= ~((ends[:, 0] > box[:2]) & (ends[:, 0] < box[2:])).all(axis=-1)
        if kept.sum() < FEWEST_CORNERS:
            return
        own, agree = _turned(corners[kept], ends[kept, 0], matrix)
        yield own @ base, float(agree.mean())
        last = own
        if (kept.sum() * agree.mean()) < LOST * len(corners):
            anchor, base, last = gray, own @ base, np.eye(3)
            corners = _corners(gray, places[frame])


def _gray(album: Album, frame: int) -> Image:
    return np.asarray(cv2.cvtColor(album.picture(frame), cv2.COLOR_BGR2GRAY), dtype=np.uint8)


def _box(places: Array) -> Array | None:
    """Left, top, right and bottom around what is seen of the performer; None where nothing is."""
    known = places[np.isfinite(places).all(axis=-1)]
    if not len(known):
        return None
    low, high = known.min(axis=0), known.max(axis=0)
    margin = MARGIN * float((high - low).max())
    return np.concatenate([low - margin, high + margin])


def _corners(gray: Image, places: Array) -> NDArray[np.float32]:
    """(N, 2) corners of the background [px of the album]."""
    mask = np.full(gray.shape, 255, dtype=np.uint8)
    box = _box(places)
    if box is not None:
        left, top, right, bottom = np.clip(box, 0, 1e6).astype(int)
        mask[top:bottom, left:right] = 0
    found = cv2.goodFeaturesToTrack(gray, MOST_CORNERS, 0.01, 5, mask=mask)
    return np.zeros((0, 2), dtype=np.float32) if found is None else np.asarray(found[:, 0], dtype=np.float32)


def _turned(begun: NDArray[np.float32], ended: NDArray[np.float32], matrix: Array) -> tuple[Array, BoolArray]:
    """The homography of a camera that turns and zooms, and which corners agree with it.

    Begins with the similarity most agree with, then Gauss-Newton on the turn and the zoom's logarithm.
    """
    first, _ = cv2.estimateAffinePartial2D(begun, ended, ransacReprojThreshold=2.0 * AGREEING_PX)
    rough = np.eye(3) if first is None else np.vstack([first, [0.0, 0.0, 1.0]])
    near = np.linalg.norm(moved(rough, begun.astype(np.float64)) - ended, axis=-1)
    inverse, values = np.linalg.inv(matrix), np.zeros(4)
    center = moved(inverse, moved(rough, matrix[:2, 2][None]))[0]
    values[:] = [-center[1], center[0], 0.0, 0.5 * np.log(np.abs(np.linalg.det(rough[:2, :2])))]

    def mapped(values: Array) -> Array:
        own = np.diag([np.exp(values[3]), np.exp(values[3]), 1.0])
        return np.asarray(matrix @ own @ exponential(values[:3]) @ inverse)

    points, agree = begun.astype(np.float64), near < 4.0 * AGREEING_PX
    for _ in range(6):
        residual = moved(mapped(values), points) - ended
        nearby = [moved(mapped(values + STEP * axis), points) - ended for axis in np.eye(4)]
        jacobian = np.stack([(one - residual) / STEP for one in nearby], axis=-1)
        own = agree if agree.sum() >= FEWEST_CORNERS else np.ones(len(points), dtype=np.bool_)
        rows, right = jacobian[own].reshape(-1, 4), residual[own].reshape(-1)
        values = values - np.linalg.lstsq(rows, right, rcond=None)[0]
        agree = np.linalg.norm(moved(mapped(values), points) - ended, axis=-1) < AGREEING_PX
    return mapped(values), agree
