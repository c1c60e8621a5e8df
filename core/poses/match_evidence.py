"""What a clip shows of the performer, to compare postures with: A points of it, markers and keypoints.

A marker's region counts with its centroid and its extent, a keypoint with its place and, where a network has
guessed it, its depth behind the hips.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import Array, BoolArray
from ..body.body_volume import PieceStack
from ..body.kinematics import Body
from ..body.posture import Posture
from ..detect.keypoints import Keypoints
from ..detect.performer import principal_keypoints
from ..markers.region_tracks import RegionTracks
from ..terms.region_model import MarkerPlacement

MARKER_STD_M = {
    "trunk": 0.05,
    "pelvis": 0.04,
    "chest": 0.06,
    "head": 0.07,
    "girdle": 0.06,
    "upper_arm": 0.07,
    "forearm": 0.11,
    "hand": 0.14,
    "thigh": 0.05,
    "shin": 0.09,
    "foot": 0.12,
}
"""Deviation of a marker between performers at the same moment of a motion, the hips aligned, by segment."""
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


@dataclass(frozen=True, eq=False)
class MatchEvidence:
    """Regions of M markers and K keypoints in F frames; A = M + K, markers first."""

    tracks: RegionTracks
    segments: tuple[str, ...]  # (M,) the segment of each marker
    keypoints: Keypoints  # (F, K) all principal points, or none where none is ever seen

    @classmethod
    def of(cls, tracks: RegionTracks, segments: tuple[str, ...], keypoints: Keypoints) -> "MatchEvidence":
        """Evidence of markers and of keypoints in any layout."""
        found = _without_leaps(principal_keypoints(keypoints), tracks.time_s)
        if not found.seen.any():
            found = Keypoints.none(tracks.frame_count)
        return cls(tracks, segments, _bridged(found, tracks))

    @property
    def names(self) -> tuple[str, ...]:
        """(A,) the segment of each marker, the point of each keypoint."""
        return (*self.segments, *self.keypoints.names)

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
        of_markers = [MARKER_STD_M.get(segment.split(".")[0], 0.1) for segment in self.segments]
        # Where detectors put a point beside the joint, and how far they miss it.
        of_points = [np.hypot(POINT_STD_M[name.split(".")[0]], 0.04) for name in self.keypoints.names]
        return np.array([*of_markers, *of_points])

    @cached_property
    def depth_deviation_m(self) -> Array:
        """(K,) the same of the keypoints' depths as a network guesses them [m]."""
        own = [POINT_STD_M[name.split(".")[0]] for name in self.keypoints.names]
        return np.hypot(own, 0.12)  # error of a network's depths: 6 to 18 cm, alike for many frames

    @cached_property
    def share(self) -> float:
        """Weight of each of the A: many points of one body differ from a library's together."""
        seen = int(self.keypoints.seen.any(axis=0).sum())
        # Number of keypoints that say different things of a posture: upper and lower parts of the limbs.
        return min(1.0, 8.0 / (len(self.segments) + seen)) if seen else 1.0

    def frames(self, own: slice) -> "MatchEvidence":
        """The evidence of some frames."""
        return MatchEvidence(self.tracks.frames(own), self.segments, self.keypoints.frames(own))

    def exchanged(self) -> "MatchEvidence":
        """The evidence with left and right of the keypoints exchanged."""
        return replace(self, keypoints=self.keypoints.exchanged())


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
        score[at, point] = 0.5 * np.minimum(score[before, point], score[after, point])
    return replace(keypoints, pixel=pixel, score=score)


# --- What postures show


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
        # Second moments of a flat silhouette: a twelfth of squared lengths along, a third of radii across.
        own = _outer(axis) / 12.0
        for side, direction in enumerate((pieces.lateral, pieces.sagittal)):
            own += width[:, side, None, None] ** 2 / 3.0 * _outer(pieces.turn(pose, direction))
        own += _outer(center - centroid[:, marker, None])
        second_moment[:, marker] = np.einsum("nq,nqij->nij", share, own)
    centroid -= posture.translation[:, None]
    points = np.asarray(body.points(pose) - posture.translation[:, None])
    shown = points[:, : len(evidence.keypoints.names)].copy()
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
