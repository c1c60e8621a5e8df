"""What poses are found from: a clip's evidence with its posed keyframes, or a stretch of it."""

from dataclasses import dataclass, fields, replace

import numpy as np

from ..body.posture import Posture
from ..footage.camera import Camera
from ..footage.keypoints.keypoints import Keypoints
from ..footage.region_tracks import RegionTracks
from ..matching.match_evidence import MatchEvidence
from ..matching.match_input import MatchInput
from ..matching.posed_constraints import PosedConstraints


@dataclass(frozen=True, eq=False)
class PosingInput:
    """A clip, or some frames of it in a row."""

    given: MatchInput
    """Evidence, frames proposed for keyframes and posed ones, counted from the first of these frames."""
    keypoints: Keypoints
    """All the performer's keypoints, in the detector's layout."""
    first: int = 0
    """Index of the first of these frames in the clip."""


def stretch_of(whole: PosingInput, first: int, last: int) -> PosingInput:
    """The frames from a first to a last one, both included."""
    own, given = slice(first, last + 1), whole.given
    evidence = given.evidence
    posed = [
        (int(frame), posture)
        for frame, posture in zip(given.constraints.frames, given.constraints.postures, strict=True)
        if first <= frame <= last
    ]
    held = [frame for frame, _ in posed]
    inside = [frame for frame in map(int, given.keyframes) if first <= frame <= last and frame not in held]
    constraints = PosedConstraints(
        given.body,
        np.array([frame - first for frame, _ in posed], dtype=np.intp),
        tuple(posture for _, posture in posed),
    )
    part = replace(
        given,
        camera=_camera(given.camera, own),
        evidence=MatchEvidence(
            _tracks(evidence.tracks, own), evidence.segments, _keypoints(evidence.keypoints, own)
        ),
        keyframes=np.array(inside, dtype=np.intp) - first,
        constraints=constraints,
    )
    return PosingInput(part, _keypoints(whole.keypoints, own), whole.first + first)


def placed_in_clip(part: Posture, whole: Posture, first: int) -> Posture:
    """Postures of a whole clip with those of a stretch in their place."""
    last = first + part.batch[0]
    return Posture.concatenate([whole[:first], part, whole[last:]])


def _camera(camera: Camera, own: slice) -> Camera:
    return replace(camera, matrix_world=camera.matrix_world[own]) if camera.is_moving else camera


def _tracks(tracks: RegionTracks, own: slice) -> RegionTracks:
    rows = {
        field.name: getattr(tracks, field.name)[own]
        for field in fields(tracks)
        if isinstance(getattr(tracks, field.name), np.ndarray)
    }
    return replace(tracks, **rows)


def _keypoints(keypoints: Keypoints, own: slice) -> Keypoints:
    return replace(
        keypoints, pixel=keypoints.pixel[own], score=keypoints.score[own], hint_m=keypoints.hint_m[own]
    )
