"""What one frame shows of the performer: its regions and keypoints, with the models they are compared by."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import IndexArray
from ..body.kinematics import Body
from ..estimate.keyframe_evidence import KeyframeEvidence
from ..estimate.single_frame import exchanged
from ..estimate.terms.keypoints import ObservedKeypoints
from ..estimate.terms.regions import ObservedRegions
from ..footage.camera import Camera
from ..footage.keypoints.keypoints import Keypoints
from ..footage.region_tracks import RegionTracks
from .match_evidence import MatchEvidence


@dataclass(frozen=True, eq=False)
class FrameShown:
    """One frame's evidence."""

    evidence: KeyframeEvidence
    """The models of markers and keypoints, as calibrated on keyframes or of average proportions."""
    frame: int
    """The frame's index, which a moving camera's pose depends on."""
    tracks: RegionTracks
    """The markers' regions in this frame alone."""
    keypoints: Keypoints
    """The performer's keypoints in this frame alone."""
    points: ObservedKeypoints
    """The same (1, N), with their confidence relative to the clip's."""

    @property
    def body(self) -> Body:
        """The take's body."""
        return self.evidence.model.body

    @property
    def is_empty(self) -> bool:
        """Whether nothing of the performer is seen."""
        return not (self.tracks.visible.any() or self.points.seen.any())

    @cached_property
    def segments(self) -> tuple[str, ...]:
        """The segment that each marker is bound to."""
        return tuple(placement.segment for placement in self.evidence.model.placements)

    @cached_property
    def camera(self) -> Camera:
        """The camera as it is in this frame."""
        camera = self.evidence.model.camera
        if not camera.is_moving:
            return camera
        return replace(camera, matrix_world=camera.matrix_world[self.frame])

    @cached_property
    def compared(self) -> MatchEvidence:
        """The same as screening compares it."""
        return MatchEvidence.of(self.tracks, self.segments, self.keypoints)

    @cached_property
    def regions(self) -> ObservedRegions:
        """The regions (1, M) with their axes."""
        return ObservedRegions.from_tracks(self.tracks)

    def points_of(self, is_exchanged: bool) -> ObservedKeypoints | None:
        """The keypoints, with left and right exchanged if so; None without any."""
        known = self.evidence.keypoints
        if not known.model.names:
            return None
        return exchanged(self.points, known.model.names, known.sources) if is_exchanged else self.points

    def frames(self, count: int) -> IndexArray:
        """(count,) the frame's index, for as many states of it."""
        return np.full(count, self.frame, dtype=np.intp)

    def without(self, marker: int) -> "FrameShown":
        """The same with a marker hidden."""
        hidden: dict[str, Any] = {}
        for name in ("centroid", "second_moment", "area", "quality"):
            values = np.array(getattr(self.tracks, name))
            values[:, marker] = 0.0 if name == "quality" else np.nan
            hidden[name] = values
        return replace(self, tracks=replace(self.tracks, **hidden))
