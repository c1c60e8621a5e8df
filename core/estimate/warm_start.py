"""What a change of the take leaves of an earlier estimate: where to begin anew, and from where.

A keyframe that is moved, added or removed changes the prior between its neighbors and, a little, what all
keyframes together tell. Where the latter stays within small tolerances, only the frames around the change are
estimated again, else the whole clip is; either from the prior, as if for the first time. To begin with the
earlier postures would save a twentieth, and hold on to earlier mistakes (measured: up to 60 mm).

Of 100 s with a keyframe moved or added, measured against estimating all anew: 0.1 to 0.2 mm apart on average,
99 of 100 points within 1.2 mm, a few in frames that hardly anything determines by up to 14 mm.
"""

from dataclasses import fields, replace

import numpy as np
from scipy.ndimage import distance_transform_edt

from ..arrays import Array, BoolArray
from ..footage.camera import Camera
from .calibration import PRIOR_STD, placement_values
from .clip_problem import ClipProblem
from .keyframe_evidence import KeyframeEvidence, keyframe_information
from .posing_error import posing_covariance, velocities
from .terms.regions import ObservedRegions
from .windows import Window, windows

SAME = 1e-7
"""Differences of a posture's unknowns [m, rad] that come of reading it from Blender once more."""
SAME_PLACEMENT = 0.06
"""Of what is believed of the placements before, as standard deviations: 0.3 mm on average."""
SAME_LENS = 5e-4
"""Logarithm of the focal length."""
SAME_SIZE = 0.1
"""Logarithms of the posing error's size, markers' distrust and areas; the timing error in frames."""
SAME_FOOTING_M = 2e-3
"""Of the lower ankle's usual height."""
SAME_FACTOR = 0.15
"""Logarithm of the accelerations' covariance, in whatever direction it differs most."""


def same_setting(earlier: ClipProblem, now: ClipProblem) -> bool:
    """Whether body, camera, markers, noise and frames' times are the same, whatever was seen and posed."""
    cameras = [
        [getattr(problem.camera, field.name) for field in fields(Camera)] for problem in (earlier, now)
    ]
    worn = [[one.segment for one in problem.evidence.model.placements] for problem in (earlier, now)]
    return (
        earlier.body.skeleton is now.body.skeleton
        and dict(earlier.body.actor.segments_m) == dict(now.body.actor.segments_m)
        and all(map(np.array_equal, *cameras))
        and worn[0] == worn[1]
        and earlier.noise == now.noise
        and np.array_equal(earlier.step_s, now.step_s)
    )


def held(earlier: ClipProblem, now: ClipProblem) -> ClipProblem | None:
    """The problem with the earlier one's evidence, where the difference is nothing to speak of; else None."""
    if not _same_evidence(earlier.evidence, now.evidence) or not _same_factor(earlier.factor, now.factor):
        return None
    posed = now.prior[now.keyframes]
    information = keyframe_information(
        posing_covariance(now.body, now.body.pose(posed)),
        velocities(posed, now.keyframes),
        earlier.evidence.posing_scale,
        earlier.evidence.timing_frames,
    )
    information[now.matched] = now.evidence.information[now.matched]
    evidence = replace(earlier.evidence, information=information)
    return replace(now, evidence=evidence, factor=earlier.factor)


def _same_evidence(one: KeyframeEvidence, other: KeyframeEvidence) -> bool:
    placed = placement_values(one.model.placements) - placement_values(other.model.placements)
    sizes = np.log([one.posing_scale, *one.distrust, *one.whole])
    sizes -= np.log([other.posing_scale, *other.distrust, *other.whole])
    lens = np.log(one.model.camera.lens_mm / other.model.camera.lens_mm)
    return bool(
        np.abs(placed / PRIOR_STD).max() < SAME_PLACEMENT
        and abs(lens) < SAME_LENS
        and np.abs(sizes).max() < SAME_SIZE
        and abs(one.timing_frames - other.timing_frames) < SAME_SIZE
    )


def _same_factor(one: Array, other: Array) -> bool:
    ratio = np.linalg.solve(one, other)
    return bool(np.abs(np.log(np.linalg.svd(ratio, compute_uv=False) ** 2)).max() < SAME_FACTOR)


def changed_frames(earlier: ClipProblem, now: ClipProblem) -> BoolArray:
    """(F,) frames of which anything differs but the evidence: prior, keyframe, or what was seen."""
    changed = np.asarray(np.abs(now.prior.minus(earlier.prior)).max(axis=1) > SAME)
    changed |= _seen_differently(earlier.observed, now.observed)
    changed |= (earlier.depth_std_m != now.depth_std_m) | _footed_differently(earlier, now)
    changed[np.setxor1d(earlier.keyframes, now.keyframes)] = True
    both, before, after = np.intersect1d(earlier.keyframes, now.keyframes, return_indices=True)
    information, other = earlier.evidence.information[before], now.evidence.information[after]
    scale = np.abs(other).max(axis=(1, 2))
    changed[both[np.abs(information - other).max(axis=(1, 2)) > 1e-6 * scale]] = True
    return changed


def _footed_differently(earlier: ClipProblem, now: ClipProblem) -> BoolArray:
    if earlier.footing_m is None or now.footing_m is None:
        return np.full(now.frames, earlier.footing_m is not now.footing_m)
    return np.abs(now.footing_m - earlier.footing_m) > SAME_FOOTING_M


def _seen_differently(one: ObservedRegions, other: ObservedRegions) -> BoolArray:
    changed = np.zeros(len(one.quality), dtype=bool)
    for field in fields(ObservedRegions):
        a, b = getattr(one, field.name), getattr(other, field.name)
        same = (a == b) | (np.isnan(a) & np.isnan(b))
        changed |= ~same.reshape(len(a), -1).all(axis=1)
    return changed


def revised_windows(changed: BoolArray, length: int, margin: int) -> list[Window]:
    """Windows around changed frames (F,), in order; none overlaps another in what it keeps.

    Args:
        changed: The frames.
        length: Most frames kept of a window.
        margin: Frames that a change, or the end of what is worked on, may be felt over.
    """
    count = len(changed)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], changed.astype(np.int8), [0]]))).tolist()
    kept: list[list[int]] = []
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        start, stop = max(first - margin, 0), min(last + margin, count)
        if kept and start <= kept[-1][1] + margin:
            kept[-1][1] = stop
        else:
            kept.append([start, stop])
    return [
        Window(
            max(start + part.keep_first - margin, 0),
            min(start + part.keep_last + margin, count),
            start + part.keep_first,
            start + part.keep_last,
        )
        for start, stop in kept
        for part in windows(stop - start, length, 0)
    ]


def revised_share(changed: BoolArray, margin: int) -> Array:
    """(F,) how much of each frame is of the new estimate, in its windows, and not of the earlier one.

    Both are right a while away from the change; from one to the other there must not be a jump.

    Args:
        changed: (F,) the changed frames.
        margin: As for the windows.
    """
    if not changed.any():
        return np.zeros(len(changed))
    away = distance_transform_edt(~changed) / max(margin, 1)
    left = np.clip(2.0 - 2.0 * away, 0.0, 1.0)  # all of it within half the margin, nothing at its end
    return np.asarray(left**2 * (3.0 - 2.0 * left))
