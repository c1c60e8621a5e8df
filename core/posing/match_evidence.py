"""What a clip shows of the performer, to compare postures with: A points of it, markers and keypoints.

A marker's region counts with its centroid and its extent, a keypoint with its place and, where a network has
guessed it, its depth behind the hips.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.human import HUMAN
from ..footage.keypoints.body_points import mirrored_point
from ..footage.keypoints.keypoints import Keypoints
from ..footage.keypoints.principal_keypoints import principal_keypoints
from ..footage.region_tracks import RegionTracks

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
KEYPOINT_ERROR_M = 0.04
"""Where detectors put a point beside the joint, and how far they miss it."""
HINT_ERROR_M = 0.12
"""Error of a network's depths: 6 to 18 cm, alike for many frames."""
INDEPENDENT_KEYPOINTS = 8.0
"""Number of keypoints that say different things of a posture: upper and lower parts of the limbs."""
LEAST_QUALITY = 0.05


@dataclass(frozen=True, eq=False)
class MatchEvidence:
    """Regions of M markers and K keypoints in F frames; A = M + K, markers first."""

    tracks: RegionTracks
    segments: tuple[str, ...]
    """(M,) the segment of each marker."""
    keypoints: Keypoints
    """(F, K) those of principal points."""

    @classmethod
    def of(cls, tracks: RegionTracks, segments: tuple[str, ...], keypoints: Keypoints) -> "MatchEvidence":
        """Evidence of markers and of keypoints in any layout."""
        found = principal_keypoints(keypoints)
        known = np.flatnonzero(found.seen.any(axis=0))
        return cls(tracks, segments, _selected(found, known))

    @property
    def marker_count(self) -> int:
        """Number of markers M."""
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
            np.hypot(POINT_STD_M[name.split(".")[0]], KEYPOINT_ERROR_M) for name in self.keypoints.names
        ]
        return np.array([*(_marker_deviation(segment) for segment in self.segments), *of_points])

    @cached_property
    def depth_deviation_m(self) -> Array:
        """(K,) the same of the keypoints' depths as a network guesses them [m]."""
        own = [POINT_STD_M[name.split(".")[0]] for name in self.keypoints.names]
        return np.hypot(own, HINT_ERROR_M)

    @cached_property
    def share(self) -> float:
        """Weight of each of the A: many points of one body differ from a library's together."""
        if not len(self.points):
            return 1.0
        return min(1.0, INDEPENDENT_KEYPOINTS / (self.marker_count + len(self.points)))

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
