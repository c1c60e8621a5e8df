"""Which matched keyframes say more than the posed ones do: between two posed keyframes a library may do harm.

Both ways of filling the time between posed keyframes show how far they are off. The library is held against
each posed keyframe, after the others have told how the performer differs from it (leave-one-out; Rasmussen
& Williams 2006, *Gaussian Processes for Machine Learning*, eq. 5.12): along the line of sight, where the
footage cannot make it good. The posed keyframes' interpolation is held against the regions seen: what it
misses across the line of sight it misses along it too. The library is left out where it does worse.
"""

import numpy as np

from ..arrays import Array, chunks
from ..body.posture import Posture
from ..footage.region_tracks import RegionTracks
from ..observation.regions import RegionModel
from ..prior.interpolation import interpolate
from ..prior.keyframes import Keyframe
from ..prior.performer_offset import leave_one_out_residuals

FEWEST_POSED = 2
"""Fewer posed keyframes than these have nothing between them."""
POOR_M = 0.12
"""A library that is off by more than this, along the line of sight, holds another motion."""
WORSE = 1.3
"""So much worse than the posed keyframes' interpolation it may be, for it knows how the motion goes on."""
LEAST_WEIGHT = 0.5
"""With less than half a posed keyframe to judge it by, a library is not found poor."""
LEAST_TRUSTED = 0.3
"""Regions hidden or doubted further than this do not count."""
FRAMES_AT_ONCE = 500


def worthwhile(
    keyframes: tuple[Keyframe, ...], model: RegionModel, tracks: RegionTracks, fps: float
) -> tuple[Keyframe, ...]:
    """The posed keyframes, and those of the matched ones that tell more than these.

    Args:
        keyframes: Posed and matched ones, in order of frame.
        model: The region model with average placements.
        tracks: The regions seen.
        fps: Frames per second.
    """
    posed = tuple(keyframe for keyframe in keyframes if keyframe.matched is None)
    if len(posed) < FEWEST_POSED or len(posed) == len(keyframes):
        return keyframes
    library_m = _library_error_m(keyframes, posed, model, fps)
    missed = _missed_squared_m(posed, model, tracks)
    kept = []
    for keyframe in keyframes:
        before = [other.index for other in posed if other.index <= keyframe.index]
        after = [other.index for other in posed if other.index >= keyframe.index]
        if keyframe.matched is None or not before or not after:
            kept.append(keyframe)
            continue
        between = missed[before[-1] : after[0] + 1]
        seen = between[np.isfinite(between)]
        posed_m = float(np.sqrt(seen.mean())) if len(seen) else np.inf
        if library_m <= min(POOR_M, WORSE * posed_m):
            kept.append(keyframe)
    return tuple(kept)


def _library_error_m(
    keyframes: tuple[Keyframe, ...], posed: tuple[Keyframe, ...], model: RegionModel, fps: float
) -> float:
    """How far the library is off at posed keyframes along the line of sight, their own word left out [m]."""
    body = model.body
    posture = Posture.stack([keyframe.posture for keyframe in posed])
    points = body.points(body.pose(posture))
    difference, weight = leave_one_out_residuals(keyframes, fps)
    foretold = body.points(body.pose(posture.plus(-difference)))
    sight = model.camera.sight(points, np.array([[keyframe.index] for keyframe in posed]))
    squared = np.mean(np.sum((foretold - points) * sight, axis=-1) ** 2, axis=-1)  # (P,)
    return float(np.sqrt(np.sum(weight * squared) / max(float(weight.sum()), LEAST_WEIGHT)))


def _missed_squared_m(posed: tuple[Keyframe, ...], model: RegionModel, tracks: RegionTracks) -> Array:
    """(F, 2 M) squares of how far the interpolated keyframes miss the regions [m²]; NaN where unseen.

    What they miss at the posed keyframes is how the markers sit, and is taken off.
    """
    camera, frames = model.camera, tracks.frame_count
    prior = interpolate(posed, frames)
    offset = np.empty((frames, len(model.placements), 2))
    for frame in chunks(np.arange(frames), FRAMES_AT_ONCE):
        predicted = model.evaluate(model.body.pose(prior[frame]), frame)
        trusted = (predicted.visible > LEAST_TRUSTED) & (tracks.quality[frame] > LEAST_TRUSTED)
        meters = camera.depth(prior[frame].translation, frame) / camera.focal_px
        apart = (predicted.centroid - tracks.centroid[frame]) * meters[:, None, None]
        offset[frame] = np.where(trusted[..., None], apart, np.nan)
    flat = offset.reshape(frames, -1)
    index = np.array([keyframe.index for keyframe in posed])
    usual = np.nan_to_num(flat[index])
    sits = [np.interp(np.arange(frames), index, column) for column in usual.T]
    return np.asarray((flat - np.stack(sits, axis=-1)) ** 2)
