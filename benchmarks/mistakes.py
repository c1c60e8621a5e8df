"""Trials with one error each: timing, lens, segment lengths, hidden markers, speed."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from keyframing import exact_postures, keyed
from numpy.typing import ArrayLike
from takes import load_project
from trials import Trial

load_project()

from keymark.core.arrays import Array, IndexArray  # noqa: E402
from keymark.core.body.actor import Actor  # noqa: E402
from keymark.core.body.human import HUMAN  # noqa: E402
from keymark.core.body.kinematics import Body  # noqa: E402
from keymark.core.body.posture import Posture  # noqa: E402
from keymark.core.body.posture_fit import fit_posture  # noqa: E402
from keymark.core.camera.camera import Camera  # noqa: E402
from keymark.core.markers.reading import Reading  # noqa: E402
from keymark.core.markers.region_tracks import RegionTracks  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402


def mistimed(trial: Trial, shifts: ArrayLike) -> Trial:
    """The trial with each keyframe's posture `shifts` (K,) frames late; the same frames are scored."""
    keyframes = trial.take.keyframes
    index = shifted([keyframe.index for keyframe in keyframes], shifts, len(trial.truth))
    late = [Keyframe(int(at), keyframe.posture) for at, keyframe in zip(index, keyframes, strict=True)]
    return replace(trial, take=replace(trial.take, keyframes=tuple(late)))


def shifted(index: ArrayLike, shifts: ArrayLike, frame_count: int) -> IndexArray:
    """Rising frames moved by shifts, within the clip and without changing their order."""
    at = np.asarray(index, dtype=np.intp) + np.asarray(shifts, dtype=np.intp)
    order = np.arange(len(at))
    # Strictly rising frames less their index may repeat but never fall.
    apart = np.maximum.accumulate(np.maximum(at, 0) - order)
    return np.minimum(apart, frame_count - len(at)) + order


def with_lens(trial: Trial, factor: float) -> Trial:
    """The trial with a focal length `factor` times as long and unchanged camera pose and keyframes."""
    camera = replace(trial.take.camera, lens_mm=factor * trial.take.camera.lens_mm)
    return replace(trial, take=replace(trial.take, camera=camera))


def posed_through_lens(trial: Trial, factor: float) -> Trial:
    """The trial with a focal length `factor` times as long and keyframes posed over its picture.

    Such keyframes put the performer `factor` times as far away, where the size in the picture is right. No
    method can detect this, so the truth moves with the keyframes.
    """
    body, camera = trial.take.body, trial.take.camera
    posed = Posture.stack([keyframe.posture for keyframe in trial.take.keyframes])
    index = np.array(trial.take.keyframe_indices)
    away = _deeper(camera, body.points(body.pose(posed)), index, factor)
    moved = replace(posed, translation=posed.translation + away)
    keyframes = tuple(Keyframe(int(at), moved[row]) for row, at in enumerate(index))
    truth = trial.truth + _deeper(camera, trial.truth, np.arange(len(trial.truth)), factor)[:, None]
    other = with_lens(trial, factor)
    return replace(other, take=replace(other.take, keyframes=keyframes), truth=truth)


def _deeper(camera: Camera, points: Array, frame: IndexArray, factor: float) -> Array:
    """Steps (N, 3) [m] along the viewing axis that put the hips of N postures `factor` times as deep."""
    hips = [HUMAN.point_names.index(name) for name in ("hip.L", "hip.R")]
    middle = points[:, hips].mean(axis=1)
    ahead = np.broadcast_to(-camera.pose(frame)[0][..., 2], middle.shape)
    return (factor - 1.0) * camera.depth(middle, frame)[:, None] * ahead


def with_segments(trial: Trial, factors: Mapping[str, float]) -> Trial:
    """The trial with segments `factors` times as long, and keyframes fitted to the same thirteen points."""
    body = trial.take.body
    lengths = {name: factors.get(name, 1.0) * length for name, length in body.actor.segments_m.items()}
    other = Body(Actor(lengths))
    posed = Posture.stack([keyframe.posture for keyframe in trial.take.keyframes])
    fitted = fit_posture(other, body.points(body.pose(posed))).posture
    keyframes = tuple(
        Keyframe(keyframe.index, fitted[row]) for row, keyframe in enumerate(trial.take.keyframes)
    )
    return replace(trial, take=replace(trial.take, body=other, keyframes=keyframes))


def hidden(trial: Trial, marker: int, frames: slice) -> Trial:
    """The trial with one marker hidden in some frames."""
    tracks = trial.tracks
    values = {name: np.array(getattr(tracks, name)) for name in ("centroid", "second_moment", "area")}
    for array in values.values():
        array[frames, marker] = np.nan
    quality, clipped = np.array(tracks.quality), np.array(tracks.clipped)
    quality[frames, marker], clipped[frames, marker] = 0.0, False
    tracks = replace(tracks, **values, quality=quality, clipped=clipped)
    return replace(trial, reading=replace(trial.reading, tracks=tracks))


def doubled_speed(trial: Trial, every_keyframe: int = 1) -> Trial:
    """The trial with every second frame only, and all or every second of its keyframes."""
    index = sorted({frame // 2 for frame in trial.take.keyframe_indices})
    kept = [*index[:-1:every_keyframe], index[-1]]
    camera = trial.take.camera
    if camera.is_moving:
        camera = replace(camera, matrix_world=camera.matrix_world[::2])
    tracks = _every_second(trial.tracks)
    take = replace(trial.take, camera=camera, frame_count=tracks.frame_count)
    album = trial.reading.album
    reading = Reading(tracks, None if album is None else album.every(2))
    half = replace(trial, take=take, reading=reading, truth=trial.truth[::2])
    return keyed(half, exact_postures(trial)[::2], kept)


def _every_second(tracks: RegionTracks) -> RegionTracks:
    rows = {
        name: getattr(tracks, name)[::2]
        for name in ("centroid", "second_moment", "area", "quality", "clipped")
    }
    return replace(tracks, **rows, time_s=tracks.time_s[: len(rows["area"])])
