"""What a clip shows of the performer, to compare postures with: A points of it, markers and keypoints.

A marker's region counts with its centroid and its extent, a keypoint with its place and, where a network has
guessed it, its depth behind the hips.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import Array, BoolArray, IndexArray, SingleArray
from ..body.body_volume import PieceStack
from ..body.human import HUMAN
from ..body.kinematics import Body
from ..body.posture import Posture
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints, mirrored_point
from ..detect.performer import principal_keypoints
from ..markers.region_tracks import RegionTracks
from ..terms.region_model import MarkerPlacement

CENTROID_STD_M = {"trunk": 0.05, "pelvis": 0.04, "chest": 0.06, "head": 0.07, "girdle": 0.06}
"""Deviation of a marker between performers at the same moment of a motion, the hips aligned."""
LIMB_STD_M = {"upper_arm": 0.07, "forearm": 0.11, "hand": 0.14, "thigh": 0.05, "shin": 0.09, "foot": 0.12}
POINT_STD_M = {
    "head": 0.07,
    "shoulder": 0.06,
    "elbow": 0.09,
    "wrist": 0.13,
    "hip": 0.03,
    "knee": 0.07,
    "ankle": 0.11,
}
"""The same of points: halfway between those of the segments that meet there."""
BESIDE_M = {
    "head": ("neck", (0.0, -0.021, -0.027)),
    "shoulder": ("waist", (-0.018, 0.0, 0.017)),
    "elbow": ("shoulder", (-0.015, -0.014, 0.0)),
    "hip": ("pelvis", (0.0, -0.038, 0.0)),
    "knee": ("hip", (0.0, 0.0, 0.013)),
    "ankle": ("knee", (0.0, 0.0, 0.021)),
}
"""Where detectors have joints' points, in the frame of what carries them, outward, back and up [m]: means of
eight takes with their truth, halves of which agree to 1 cm. Hips are on the skin, and ankles above them."""
TRUNK_JOINTS = ("pelvis", "waist", "neck")
LEAST_QUALITY = 0.05
BRIDGED_S = 1.0
"""Longest time without anything seen over which points are taken to go straight on: about a step."""
BRIDGED_QUALITY = 0.5  # of the points at its ends


@dataclass(frozen=True, eq=False)
class MatchEvidence:
    """Regions of M markers and K keypoints in F frames; A = M + K, markers first."""

    tracks: RegionTracks
    segments: tuple[str, ...]  # (M,) the segment of each marker
    keypoints: Keypoints  # (F, K) those of principal points

    @classmethod
    def of(cls, tracks: RegionTracks, segments: tuple[str, ...], keypoints: Keypoints) -> "MatchEvidence":
        """Evidence of markers and of keypoints in any layout."""
        found = _without_leaps(principal_keypoints(keypoints), tracks.time_s)
        known = np.flatnonzero(found.seen.any(axis=0))
        return cls(tracks, segments, _bridged(_selected(found, known), tracks))

    @property
    def marker_count(self) -> int:
        """M."""
        return len(self.segments)

    @cached_property
    def points(self) -> IndexArray:
        """(K,) which of the principal points each keypoint shows."""
        return np.array([HUMAN.point_names.index(name) for name in self.keypoints.names], dtype=np.intp)

    @cached_property
    def pixel(self) -> Array:
        """(F, A, 2) where each is seen [px]; NaN where it is not."""
        return np.concatenate([self.tracks.centroid, self.keypoints.pixel], axis=1)

    @cached_property
    def quality(self) -> Array:
        """(F, A) 0 to 1."""
        return np.concatenate([self.tracks.quality, self.keypoints.score], axis=1)

    @cached_property
    def visible(self) -> BoolArray:
        """(F, A) whether each is seen well enough to count."""
        seen = np.concatenate([self.tracks.visible, self.keypoints.seen], axis=1)
        return np.asarray(seen & (self.quality > LEAST_QUALITY))

    @cached_property
    def deviation_m(self) -> Array:
        """(A,) usual distance between performers at the same moment of a motion, the hips aligned [m]."""
        of_points = [
            # Where detectors put a point beside the joint, and how far they miss it.
            np.hypot(POINT_STD_M[name.split(".")[0]], 0.04)
            for name in self.keypoints.names
        ]
        return np.array([*(_marker_deviation(segment) for segment in self.segments), *of_points])

    @cached_property
    def depth_deviation_m(self) -> Array:
        """(K,) the same of the keypoints' depths as a network guesses them [m]."""
        own = [POINT_STD_M[name.split(".")[0]] for name in self.keypoints.names]
        return np.hypot(own, 0.12)  # error of a network's depths: 6 to 18 cm, alike for many frames

    @cached_property
    def share(self) -> float:
        """Weight of each of the A: many points of one body differ from a library's together."""
        if not len(self.points):
            return 1.0
        # Number of keypoints that say different things of a posture: upper and lower parts of the limbs.
        return min(1.0, 8.0 / (self.marker_count + len(self.points)))

    def exchanged(self) -> "MatchEvidence":
        """The evidence with left and right of the keypoints exchanged."""
        known = self.keypoints
        absent = len(known.names)
        other = [
            known.names.index(name) if name in known.names else absent
            for name in map(mirrored_point, known.names)
        ]

        def mirrored(values: Array, missing: float) -> Array:
            nothing = np.full((len(values), 1, *values.shape[2:]), missing)
            return np.concatenate([values, nothing], axis=1)[:, other]

        changed = replace(
            known,
            pixel=mirrored(known.pixel, np.nan),
            score=mirrored(known.score, 0.0),
            hint_m=mirrored(known.hint_m, np.nan),
        )
        return replace(self, keypoints=changed)


def _without_leaps(keypoints: Keypoints, time_s: Array) -> Keypoints:
    """The keypoints but for those far from where they are just before and after, as detectors err."""
    pixel, score = keypoints.pixel.copy(), keypoints.score.copy()
    for frame in np.flatnonzero(keypoints.seen.any(axis=1)):
        around = keypoints.pixel[np.abs(time_s - time_s[frame]) < 0.15]
        known = np.flatnonzero(np.isfinite(around).all(axis=-1).any(axis=0))
        usual = np.nanmedian(around[:, known], axis=0)
        off = np.linalg.norm(keypoints.pixel[frame, known] - usual, axis=-1)
        leaps = known[off > 0.3 * np.linalg.norm(np.ptp(usual, axis=0))]  # of the body's size
        pixel[frame, leaps], score[frame, leaps] = np.nan, 0.0
    return replace(keypoints, pixel=pixel, score=score)


def _bridged(keypoints: Keypoints, tracks: RegionTracks) -> Keypoints:
    """The keypoints, in short stretches in which nothing at all is seen on the straight way in between.

    At the clip's ends they stay where they are.

    A detector that looks at some frames only says nothing of the others, where any posture anywhere would do.
    """
    seen, time_s = keypoints.seen, tracks.time_s
    empty = ~(seen.any(axis=1) | tracks.visible.any(axis=1))
    if not empty.any() or not seen.any():
        return keypoints
    pixel, score = keypoints.pixel.copy(), keypoints.score.copy()
    frames = np.flatnonzero(empty)
    for point in range(len(keypoints.names)):
        known = np.flatnonzero(seen[:, point])
        if not len(known):
            continue
        place = np.searchsorted(known, frames)
        before, after = known[np.maximum(place - 1, 0)], known[np.minimum(place, len(known) - 1)]
        apart_s = np.where(
            before < after, time_s[after] - time_s[before], np.abs(time_s[frames] - time_s[after])
        )
        near = apart_s <= np.where(before < after, BRIDGED_S, 0.5 * BRIDGED_S)
        at, before, after = frames[near], before[near], after[near]
        for axis in range(2):
            pixel[at, point, axis] = np.interp(time_s[at], time_s[known], keypoints.pixel[known, point, axis])
        score[at, point] = BRIDGED_QUALITY * np.minimum(score[before, point], score[after, point])
    return replace(keypoints, pixel=pixel, score=score)


def _selected(keypoints: Keypoints, index: IndexArray) -> Keypoints:
    return Keypoints(
        tuple(keypoints.names[i] for i in index),
        tuple(keypoints.sources[i] for i in index),
        keypoints.pixel[:, index],
        keypoints.score[:, index],
        keypoints.hint_m[:, index],
    )


def _marker_deviation(segment: str) -> float:
    name = segment.split(".")[0]
    return CENTROID_STD_M.get(name) or LIMB_STD_M.get(name, 0.1)


# --- What one frame shows, as postures are compared with it


DEGREES_OF_FREEDOM = 4.0  # of Student's t distribution
EXCHANGED_COST = np.float32(3.0)  # cost of taking a detector's left for right in a frame: one in twenty
ENTRIES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))  # of a symmetric matrix, as in `second_moment`
ACROSS, ALONG = 1.0 / 3.0, 1.0 / 12.0  # second moments of a flat silhouette, in radii² and lengths²


@dataclass(frozen=True, eq=False)
class FrameLikelihood:
    """One frame: A points, M of them markers, and G guessed depths, one a keypoint or none."""

    weight: Array  # (A,) one over the standard deviation of each place [1/m]; 0 where not visible
    backward: Array  # (3,) the camera's backward axis in the world
    location: Array  # (3,) the camera's place [m]
    image_axes: Array  # (A, 2, 3) world directions of a marker's image to the right and upwards
    extent: Array  # (M, 3) square root of the observed second moments per meter of depth, xx, xy, yy
    sight: Array  # (3,) line of sight to the performer, along which depths are guessed
    depth_m: Array  # (G,) guessed depth of each keypoint behind the hips [m]; 0 where there is none
    depth_weight: Array  # (G,) one over its standard deviation [1/m]; 0 where there is none
    pixel_size: float  # size of a pixel per meter of depth
    visible: BoolArray  # (A,) points found in the frame
    unclipped: BoolArray  # (M,) markers found whose region is not cut off by the picture's edge
    share: float  # weight of each point's cost, since they do not differ independently


def frame_likelihoods(
    camera: Camera, evidence: MatchEvidence, frames: IndexArray, scale: float = 1.0
) -> list[FrameLikelihood]:
    """What some frames show.

    `scale` is the deviation of the postures that are compared, relative to another performer's.
    """
    return [_frame_likelihood(camera, evidence, int(frame), scale) for frame in frames]


def _frame_likelihood(camera: Camera, evidence: MatchEvidence, frame: int, scale: float) -> FrameLikelihood:
    tracks, quality = evidence.tracks, evidence.quality[frame]
    visible = evidence.visible[frame]
    rotation, location = camera.pose(frame)
    right, up, backward = rotation.T
    pixels = np.where(visible[:, None], evidence.pixel[frame], camera.principal_point)
    _, ray = camera.rays(pixels, frame)
    away = -ray @ backward
    x, y = ray @ right / away, ray @ up / away
    lost = ~np.isfinite(x + y)
    visible, x, y = visible & ~lost, np.where(lost, 0.0, x), np.where(lost, 0.0, y)
    trust = np.sqrt(np.clip(quality, LEAST_QUALITY, 1.0))
    depth = evidence.keypoints.hint_m[frame, :, 2] if evidence.keypoints.has_hints else np.zeros(0)
    known = np.isfinite(depth) & visible[evidence.marker_count :][: len(depth)]
    pixel_size = 1.0 / camera.focal_px
    moments = tracks.second_moment[frame] * pixel_size**2
    unclipped = visible[: evidence.marker_count] & ~tracks.clipped[frame]
    # Image rows run down, the camera's axis up.
    extent = square_root(moments[:, 0, 0], -moments[:, 0, 1], moments[:, 1, 1])
    return FrameLikelihood(
        np.where(visible, trust / (scale * evidence.deviation_m), 0.0),
        backward,
        location,
        np.stack([right + x[:, None] * backward, up + y[:, None] * backward], axis=1),
        np.where(unclipped[:, None], np.stack(extent, axis=-1), 0.0),
        _line_of_sight(ray[visible], backward),
        np.where(known, depth, 0.0),
        np.where(known, 1.0 / evidence.depth_deviation_m[: len(depth)], 0.0),
        pixel_size,
        visible,
        unclipped,
        evidence.share,
    )


def _line_of_sight(ray: Array, backward: Array) -> Array:
    """(3,) unit mean of some rays; straight ahead without any."""
    if not len(ray):
        return -backward
    mean = ray.mean(axis=0)
    return np.asarray(mean / np.linalg.norm(mean))


def extent_cost(
    seen: FrameLikelihood, marker: int, entries: Sequence[Any], depth: SingleArray
) -> SingleArray:
    """Cost of predicted second moments xx, xy, yy of a marker [m²] at some depths [m]."""
    predicted = square_root(*entries)
    depth = np.maximum(depth, np.float32(0.1))
    # Deviation of a marker's extent: clothes, the color's ends, a limb turned by a few degrees.
    variance = np.float32(0.025**2) + (np.float32(seen.pixel_size) * depth) ** 2
    observed = seen.extent[marker].astype(np.float32)
    squared = sum(
        (predicted[k] - observed[k] * depth) ** 2 * np.float32(2.0 if k == 1 else 1.0) for k in range(3)
    )
    return student_cost(np.asarray(squared / variance), 3)


def square_root(xx: Array, xy: Array, yy: Array) -> tuple[Array, Array, Array]:
    """Square root of symmetric 2 x 2 matrices, given and returned by entries."""
    root = np.sqrt(np.maximum(xx * yy - xy * xy, 0.0))
    scale = 1.0 / np.sqrt(np.maximum(xx + yy + 2.0 * root, 1e-12))
    return (xx + root) * scale, xy * scale, (yy + root) * scale


def products(first: SingleArray, second: SingleArray) -> SingleArray:
    """(..., 6) coefficients of a symmetric matrix's entries in uᵀ S v, see `ENTRIES`."""
    u, v = np.moveaxis(first, -1, 0), np.moveaxis(second, -1, 0)
    mixed = [u[i] * v[j] + u[j] * v[i] for i, j in ENTRIES[3:]]
    return np.stack([u[0] * v[0], u[1] * v[1], u[2] * v[2], *mixed], axis=-1)


def student_cost(squared: SingleArray, dimensions: int, degrees: float = DEGREES_OF_FREEDOM) -> SingleArray:
    """Negative log likelihood under Student's t of squared distances, up to a constant."""
    off = squared / np.float32(degrees)
    off += np.float32(1.0)
    # NumPy's log1p takes seven times as long, and differs by 1e-6.
    return np.asarray(np.float32(0.5 * (degrees + dimensions)) * np.log(off))


def squared_distances(first: SingleArray, second: SingleArray) -> SingleArray:
    """(J, K) mean squared distances of points (J, Q, 3) and (K, Q, 3)."""
    count = first.shape[1]
    a, b = first.reshape(len(first), -1), second.reshape(len(second), -1)
    squared = (a * a).sum(axis=1)[:, None] + (b * b).sum(axis=1) - np.float32(2.0) * (a @ b.T)
    return np.maximum(squared, np.float32(0.0)) / np.float32(count)


def lowest(cost: SingleArray, count: int, margin: float) -> IndexArray:
    """Indices of the lowest costs within a margin of the least, at most `count`, in order of index."""
    kept = np.flatnonzero(cost <= cost.min() + np.float32(margin))
    if len(kept) > count:
        kept = np.sort(kept[np.argpartition(cost[kept], count)[:count]])
    return kept


@dataclass(frozen=True, eq=False)
class MarkerMoments:
    """Moments of M markers and places of K keypoints, A = M + K, in N postures, in the world's axes.

    A limb's image has nearly the moments of their projection, which is linear in them.
    """

    centroid: Array  # (N, A, 3) of markers' volumes, then keypoints, from the hips' midpoint [m]
    second_moment: Array  # (N, M, 3, 3) the markers' second central moments [m²]
    points: Array  # (N, P, 3) the body's points relative to the hips' midpoint [m]


def marker_moments(body: Body, evidence: MatchEvidence, posture: Posture) -> MarkerMoments:
    """Moments of the markers and places of the keypoints of some evidence, in N postures."""
    segments = evidence.segments
    pose = body.pose(posture)
    centroid = np.empty((len(posture.translation), len(segments), 3))
    second_moment = np.empty((*centroid.shape, 3))
    for marker, segment in enumerate(segments):
        pieces = PieceStack.of(MarkerPlacement.usual(segment).pieces(body))
        start, end = pieces.place(pose, pieces.start), pieces.place(pose, pieces.end)  # (N, Q, 3)
        axis = end - start
        width = pieces.half_widths.mean(axis=1)  # (Q, 2)
        share = np.linalg.norm(axis, axis=-1) * width.mean(axis=1)
        share = share / share.sum(axis=1, keepdims=True)
        center = 0.5 * (start + end)
        centroid[:, marker] = np.einsum("nq,nqi->ni", share, center)
        own = ALONG * _outer(axis)
        for side, direction in enumerate((pieces.lateral, pieces.sagittal)):
            own += ACROSS * width[:, side, None, None] ** 2 * _outer(pieces.turn(pose, direction))
        own += _outer(center - centroid[:, marker, None])
        second_moment[:, marker] = np.einsum("nq,nqij->nij", share, own)
    centroid -= posture.translation[:, None]
    points = np.asarray(body.points(pose) - posture.translation[:, None])
    shown = points[:, evidence.points]
    for column, name in enumerate(evidence.keypoints.names):
        stem, _, on_side = name.partition(".")
        if stem in BESIDE_M:
            carrier, (outward, back, up) = BESIDE_M[stem]
            joint = body.skeleton.joint_index(carrier if carrier in TRUNK_JOINTS else f"{carrier}.{on_side}")
            beside = np.array([-outward if on_side == "R" else outward, back, up])
            shown[:, column] += pose.rotation[:, joint] @ beside
    return MarkerMoments(np.concatenate([centroid, shown], axis=1), second_moment, points)


def _outer(vector: Array) -> Array:
    return np.asarray(vector[..., :, None] * vector[..., None, :])
