"""How far a result may be off where neither footage nor keyframes determine it: points found, and unobserved.

Where the markers are seen tells the place across the line of sight, and little of that along it. Of a found
posture's depths the estimate knows how performers usually differ; a network's guess tells how this one does.
"""

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.human import HIPS, HUMAN
from ..body.skeleton import Skeleton
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints

# --- Found keyframes


# Error of points across and along the line of sight beyond the estimate's own covariance [m], near a found
# keyframe that is certain and near one that is certainly wrong. A limb that leans toward the camera looks
# like one that leans away from it, a body turned to one side nearly like one turned to the other: what was
# found there is right or wrong, which a covariance about it does not show. In 25 recordings with truth where
# nothing was posed, errors along the line of sight were 13 cm where the confidence was below 0.7, 9 cm at
# 0.85 and 8 cm above 0.9; across it 5, 4 and 2 cm.
SURE_STD_M, UNSURE_STD_M = np.array([0.02, 0.07]), np.array([0.07, 0.16])
SIZE_STD = 0.05  # of a distance by the performer's size, as a share: lengths are average ones
# Error of how high ankles stand over the floor: shoes, and where a detector has them. All frames share it.
GROUND_STD_M = 0.04


def place_depth_std_m(
    points: Array,
    ankles: Array | None,
    camera: Camera,
    over_floor_m: float = 0.0,
    frame: IndexArray | None = None,
) -> Array:
    """(F,) error of a whole composed performer's place along the line of sight [m], which all frames share.

    Sizes tell a distance, and so does the floor, the better the more the camera looks down on it. Where they
    contradict each other the error is as large as the step that the floor would have the performer take.

    `points` (F, P, 3) in the world and `ankles` (F,), heights of the lower one [m], None where unseen;
    `over_floor_m`: how high the feet stand over a known floor; `frame` (F,) indices in the clip, 0 on where
    None.
    """
    frame = np.arange(len(points)) if frame is None else frame
    middle = points.mean(axis=1)
    sight = camera.sight(middle, frame)
    location = np.array([camera.pose(int(index))[1] for index in frame])
    distance = np.linalg.norm(middle - location, axis=-1)
    level = np.hypot(sight[:, 0], sight[:, 1]) * distance
    below = np.zeros(len(points)) if ankles is None else np.abs(location[:, 2] - ankles)
    slope = below / np.maximum(level, 1e-3)  # of the sight of the feet
    by_size, by_floor = 1.0 / (SIZE_STD * distance), slope / GROUND_STD_M
    variance = 1.0 / (by_size**2 + by_floor**2)
    step = variance * by_floor * over_floor_m / GROUND_STD_M
    return np.asarray(np.hypot(np.sqrt(variance), step))


def found_std_m(confidence: Array, guessed_std_m: float | None = None) -> Array:
    """Errors (..., 2) [m] across and along the line of sight of points that were found so surely (...).

    Along it those of sure ones are what a network's guess tells, where there is one.
    """
    sure = confidence[..., None]
    sure_std_m = SURE_STD_M if guessed_std_m is None else np.array([SURE_STD_M[0], guessed_std_m])
    return np.asarray(np.sqrt(sure * sure_std_m**2 + (1.0 - sure) * UNSURE_STD_M**2))


def guessed_depth_std_m(points: Array, camera: Camera, keypoints: Keypoints) -> float | None:
    """Error of depths of points (F, P, 3) [m] by a network's guess of them; None without one.

    Neither knows how far off the other is: each has half of the squared difference. It is that of the whole
    clip, since both err for long.
    """
    rows = [row for row, name in enumerate(keypoints.names) if name in HUMAN.point_names]
    own = [HUMAN.point_names.index(keypoints.names[row]) for row in rows]
    depth = camera.depth(points, np.arange(len(points))[:, None])
    found = depth[:, own] - depth[:, HIPS].mean(axis=1, keepdims=True)
    off = found - keypoints.hint_m[:, rows, 2]  # of which the hips are the origin, too
    return float(np.sqrt(0.5 * np.nanmean(off**2))) if np.isfinite(off).any() else None


def across_sight(covariance: Array, points: Array, camera: Camera, share: Array) -> Array:
    """Covariance (F, P, 3, 3) of points (F, P, 3) with a share (F,) of their error in depth taken away."""
    sight = camera.sight(points, np.arange(len(points))[:, None])
    left = np.eye(3) - share[:, None, None, None] * sight[..., :, None] * sight[..., None, :]
    return np.asarray(left @ covariance @ left)


def undetermined_covariance(
    points: Array,
    camera: Camera,
    index: IndexArray,
    doubt: Array,
    confidence: Array,
    place_std_m: Array | float = 0.0,
    guessed_std_m: float | None = None,
) -> Array:
    """Covariance (F, P, 3, 3) [m²] of points (F, P, 3) that found keyframes leave undetermined.

    Of K keyframes: `index` in the clip, in order; `doubt`, size of the error relative to a usual one, 0
    for posed ones; `confidence`, probability that each is about right. `place_std_m` (F,): error of the whole
    performer's place along the line of sight, if more than usual; `guessed_std_m` as `guessed_depth_std_m`.
    """
    frame = np.arange(len(points))
    sight = camera.sight(points, frame[:, None])
    along = sight[..., :, None] * sight[..., None, :]
    std_m = doubt[:, None] * found_std_m(confidence, guessed_std_m)
    across_m, along_m = (np.interp(frame, index, own) for own in std_m.T)
    along_m = np.hypot(along_m, np.interp(frame, index, doubt) * place_std_m)
    variance = np.square([across_m, along_m])[:, :, None, None, None]
    return np.asarray(variance[0] * (np.eye(3) - along) + variance[1] * along)


# --- Unobserved


GRACE_S = 0.25  # time for which the estimate's own covariance holds
LIMB_STD_RAD = 0.5  # of joints anywhere in reach
# Growth of the place's standard deviation along each axis: the performer may stand or walk.
WALKING_M_PER_S, FARTHEST_M = 0.5, 2.0


def unobserved_variance(
    skeleton: Skeleton, segments: tuple[str, ...], visible: BoolArray, keyframes: IndexArray, time_s: Array
) -> Array:
    """(F, D) variance of postures beyond their covariance, where nothing observes them [m², rad²].

    `segments` (M,): the segment of each marker, or the joint that carries each keypoint; an unknown name
    counts for the trunk; `visible` (F, M); `keyframes` (K,): frames whose posture is known. A knee tells of
    the thigh, and nothing of the shin.
    """
    trunk = skeleton.limbs[0]
    joint = {one.name: index for index, one in enumerate(skeleton.joints)}
    joint |= {segment.name: segment.joint for segment in skeleton.segments}
    moving = np.array([skeleton.moved_by[joint.get(name, 0)] for name in segments], dtype=np.float64)
    observed = visible @ moving.reshape(-1, skeleton.dof_count) > 0.0
    observed[:, trunk] = visible.any(axis=1)[:, None]  # anything visible also locates the trunk
    observed[keyframes] = True
    unknown = np.stack([_unobserved_time_s(column, time_s) for column in observed.T], axis=-1)
    # 0.35: time constant at which a limb approaches the variance of anywhere in reach
    std = -np.expm1(-unknown / 0.35) * LIMB_STD_RAD
    std[:, trunk] *= 0.3  # a trunk bends by less
    std[:, :3] = np.minimum(WALKING_M_PER_S * unknown[:, :3], FARTHEST_M)
    return std**2


def _unobserved_time_s(observed: BoolArray, time_s: Array) -> Array:
    """(F,) time from the nearest observed frame beyond the grace [s]."""
    if not observed.any():
        return np.full(len(time_s), FARTHEST_M / WALKING_M_PER_S)
    known = time_s[observed]
    after = np.searchsorted(known, time_s)
    gap = np.minimum(
        np.abs(time_s - known[np.minimum(after, len(known) - 1)]),
        np.abs(time_s - known[np.maximum(after - 1, 0)]),
    )
    return np.asarray(np.maximum(gap - GRACE_S, 0.0))
