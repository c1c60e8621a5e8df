"""Where a motion of known shape and turn is, frame by frame: robust least squares of points seen.

A network's own distance is not believed; the picture's is smoothed over time.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.human import HIPS, HUMAN, LIMB_SEGMENTS, SHOULDERS
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints
from ..detect.performer import principal_keypoints
from ..markers.region_tracks import RegionTracks
from ..numerics.robust import DEGREES, multivariate_cost
from ..numerics.vectors import gaussian

POINTS = HUMAN.point_names


ROUNDS = 6  # of reweighting; the last two with the distances smoothed


@dataclass(frozen=True, eq=False)
class SeenPoints:
    """A places in each of F pictures, each a mean of principal points."""

    camera: Camera
    rotation: Array  # (F, 3, 3) the camera's axes as columns
    mean: Array  # (A, 13) weights of the principal points
    slope: Array  # (F, A, 2) x and y of the sight at unit depth, in camera axes; NaN where not seen
    confidence: Array  # (F, A) 0 where not seen
    std_m: Array  # (A,)

    @classmethod
    def of(
        cls, camera: Camera, keypoints: Keypoints, tracks: RegionTracks, segments: Sequence[str]
    ) -> "SeenPoints":
        """The performer's keypoints, and the middles of the markers' regions."""
        points = principal_keypoints(keypoints) if keypoints.names else None
        frames = tracks.frame_count
        # 0.06: the detector's error, where it has joints, and the network's own
        mean, pixel, score, std = [np.eye(len(POINTS))], [], [], [np.full(len(POINTS), 0.06)]
        pixel.append(points.pixel if points else np.full((frames, len(POINTS), 2), np.nan))
        score.append(points.score if points else np.zeros((frames, len(POINTS))))
        if len(segments):
            mean.append(np.array([_middle_of(segment) for segment in segments]))
            pixel.append(tracks.centroid)
            score.append(np.where(tracks.visible, tracks.quality, 0.0))
            # 0.09: of a marker's middle from its segment's
            std.append(np.full(len(segments), 0.09))
        pixels, scores = np.concatenate(pixel, axis=1), np.nan_to_num(np.concatenate(score, axis=1))
        frame = np.arange(frames)
        _, ray = camera.rays(pixels, frame[:, None])
        rotation = np.array(np.broadcast_to(camera.pose(frame)[0], (frames, 3, 3)))
        ray = np.einsum("fji,faj->fai", rotation, ray)
        slope = ray[..., :2] / -ray[..., 2:]
        seen = np.isfinite(slope).all(axis=-1) & (scores > 0.0)
        # What is never seen at all is no column.
        kept = seen.any(axis=0)
        confidence = np.where(seen, np.clip(scores, 0.1, 1.0), 0.0)
        return cls(
            camera,
            rotation,
            np.concatenate(mean)[kept],
            np.where(seen[..., None], slope, np.nan)[:, kept],
            confidence[:, kept],
            np.concatenate(std)[kept],
        )

    def __getitem__(self, frames: IndexArray) -> "SeenPoints":
        rotation, slope, confidence = self.rotation[frames], self.slope[frames], self.confidence[frames]
        return replace(self, rotation=rotation, slope=slope, confidence=confidence)


def _middle_of(segment: str) -> Array:
    weights = np.zeros(len(POINTS))
    stem, _, side = segment.partition(".")
    limbs = {name: [f"{near}.{side}", f"{far}.{side}"] for name, near, far in LIMB_SEGMENTS}
    ends = limbs.get(stem)
    if ends is None:
        joint = {"hand": "wrist", "foot": "ankle"}.get(stem)
        ends = [f"{joint}.{side}"] if joint else ["head"] if stem == "head" else None
    index = [POINTS.index(end) for end in ends] if ends else [*HIPS, *SHOULDERS]
    weights[index] = 1.0 / len(index)
    return weights


@dataclass(frozen=True, eq=False)
class Placed:
    """Where a motion is in each of F frames, given how it is turned."""

    place: Array  # (..., F, 3) of its hips, in camera axes [m]
    residual_m: Array  # (..., F, A, 2) across the view [m]; NaN where not seen
    cost: Array  # (..., F) mean of a seen point's; NaN where nothing is compared


def place(points: Array, seen: SeenPoints, smooth_frames: float = 0.0) -> Placed:
    """Place a motion in each frame by what is seen there.

    `points` (..., F, 13, 3): about the hips, in camera axes [m]; NaN where absent. `smooth_frames`: time over
    which its distance is smoothed, 0 for none.
    """
    relative = seen.mean @ np.where(np.isfinite(points), points, 0.0)  # (..., F, A, 3)
    absent = ~np.isfinite(points).all(axis=(-1, -2))
    slope = np.where(seen.confidence[..., None] > 0.0, seen.slope, 0.0)
    base = seen.confidence / seen.std_m**2 * ~absent[..., None]
    weight, distance = base, None
    found = np.zeros((*points.shape[:-2], 3))
    for number in range(ROUNDS):
        if number == ROUNDS - 2 and smooth_frames > 0.0:
            distance = _smoothed(found[..., 2], absent | (base.sum(axis=-1) == 0.0), smooth_frames)
        found = _least_squares(relative, slope, weight, distance)
        depth = relative[..., 2] + found[..., None, 2]
        residual = relative[..., :2] + found[..., None, :2] + slope * depth[..., None]
        squared = (residual**2).sum(axis=-1) / seen.std_m**2 * seen.confidence
        weight = base * (DEGREES + 2.0) / (DEGREES + squared)
    used = base > 0.0
    count = used.sum(axis=-1)
    each = np.where(used, multivariate_cost(squared, DEGREES, 2), 0.0)
    cost = np.where(count >= 2, each.sum(axis=-1) / np.maximum(count, 1), np.nan)
    return Placed(found, np.where(used[..., None], residual, np.nan), cost)


def _least_squares(relative: Array, slope: Array, weight: Array, distance: Array | None) -> Array:
    """Places (..., F, 3) with (T + r)_xy + slope (T + r)_z = 0; `distance` (..., F): known T_z."""
    wanted = -(relative[..., :2] + slope * relative[..., 2:])  # (..., F, A, 2)
    total = weight.sum(axis=-1)[..., None]
    if distance is not None:
        short = wanted - slope * distance[..., None, None]
        across = (weight[..., None] * short).sum(axis=-2) / np.maximum(total, 1e-9)
        return np.concatenate([across, distance[..., None]], axis=-1)
    total = np.maximum(total, 1e-9)
    mean = (weight[..., None] * slope).sum(axis=-2) / total
    goal = (weight[..., None] * wanted).sum(axis=-2) / total
    off, ahead = slope - mean[..., None, :], wanted - goal[..., None, :]
    top = (weight[..., None] * off * ahead).sum(axis=(-1, -2))
    under = (weight[..., None] * off**2).sum(axis=(-1, -2))
    # In front of the camera, and no farther than a performer can be told from a dot.
    # 0.5: distance of the hips
    # 100: farthest distance of the hips [m]
    depth = np.clip(top / np.maximum(under, 1e-9), -100.0, -0.5)
    return np.concatenate([goal - mean * depth[..., None], depth[..., None]], axis=-1)


def _smoothed(depth: Array, unknown: BoolArray, frames: float) -> Array:
    """Distances (F,) smoothed in their logarithm over frames that tell one."""
    logarithm = np.where(unknown, 0.0, np.log(-np.minimum(depth, -1e-3)))
    weight = np.where(unknown, 1e-6, 1.0)
    middle = np.median(logarithm[~unknown]) if (~unknown).any() else 0.0
    logarithm = np.where(unknown, middle, logarithm)
    smooth = logarithm
    for _ in range(3):
        smooth = gaussian(weight * logarithm, frames) / np.maximum(gaussian(weight, frames), 1e-9)
        # 0.05: usual error of a frame's own distance, as a share
        doubt = ((logarithm - smooth) / 0.05) ** 2
        weight = np.where(unknown, 1e-6, 1.0 / (1.0 + doubt / DEGREES))
    return np.asarray(-np.exp(smooth))
