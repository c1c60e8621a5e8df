"""Errors of keyframes: posed by a person, or matched; and of postures that nothing observes.

A person who poses a skeleton over footage puts every joint a little off, and the whole figure too; an error
upstream is made good downstream, so joints' places err independently, not their angles. And the posture may
be that of a moment before or after the frame it was set at. These shapes are assumed, their sizes are not.

A library's postures are another performer's, so joints differ, and what hangs on them differs along with
them. Where the markers are seen tells the place across the line of sight, and little of that along it.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.kinematics import Body, Pose
from ..body.posture import Posture
from ..body.skeleton import Skeleton
from ..camera.camera import Camera
from ..terms.depths import DEPTH_STD_M

# --- Posed


POINT_STD_M = 0.014  # error of each point along each axis [m]
POSED_PLACE_STD_M = 0.009  # error that all points share along each axis [m]
FREE_STD_RAD = 0.5  # error of rotations that no point determines, about a limb's own axis [rad]


def posing_covariance(body: Body, pose: Pose) -> Array:
    """A person's usual posing error at given poses, as covariance (K, D, D) of the posture's tangent."""
    count = body.skeleton.dof_count
    jacobian = body.points_jacobian(pose).reshape(*pose.posture.batch, -1, count) / POINT_STD_M
    information = np.swapaxes(jacobian, -1, -2) @ jacobian + np.eye(count) * FREE_STD_RAD**-2
    covariance = np.linalg.solve(information, np.broadcast_to(np.eye(count), information.shape))
    place = np.arange(3)
    covariance[..., place, place] += POSED_PLACE_STD_M**2
    return np.asarray(0.5 * (covariance + np.swapaxes(covariance, -1, -2)))


def velocities(keyframes: Posture, frame: IndexArray) -> Array:
    """Velocities of K keyframes' postures, (K, D) of the tangent per frame: of the parabola through three."""
    if len(frame) < 2:
        return np.zeros((len(frame), keyframes.skeleton.dof_count))
    gap = np.diff(frame)[:, None].astype(np.float64)
    after = keyframes[1:].minus(keyframes[:-1]) / gap
    velocity = np.concatenate([after, -keyframes[-2:-1].minus(keyframes[-1:]) / gap[-1:]])
    before = -keyframes[:-2].minus(keyframes[1:-1]) / gap[:-1]
    velocity[1:-1] = (gap[1:] * before + gap[:-1] * after[1:]) / (gap[1:] + gap[:-1])
    return velocity


# --- Put right in the picture


SET_STD_M = 0.02  # how near to a joint a person sets a point in the picture [m]
AVERAGE_STD_M = 0.025  # how far average lengths put points off, which differ by 4 to 5 percent between people


def picture_std_m(body: Body) -> float:
    """How far across the line of sight points are from where a person has set them in the picture [m]."""
    return float(np.hypot(SET_STD_M, AVERAGE_STD_M * body.actor.is_average))


def picture_information(body: Body, camera: Camera, posture: Posture, frame: IndexArray) -> Array:
    """(K, D, D) what postures put right in the picture alone tell of the posture's tangent."""
    pose = body.pose(posture)
    sight = camera.sight(body.points(pose), frame[:, None])
    across = np.eye(3) - sight[..., :, None] * sight[..., None, :]
    count = body.skeleton.dof_count
    rows = (across @ body.points_jacobian(pose)).reshape(len(frame), -1, count) / picture_std_m(body)
    return np.asarray(np.swapaxes(rows, -1, -2) @ rows)


# --- Matched


JOINT_STD_DEG = {
    "pelvis": 9.0,
    "waist": 10.0,
    "neck": 15.0,
    "girdle": 8.0,
    "shoulder": 18.0,
    "elbow": 22.0,
    "forearm": 35.0,
    "hip": 12.0,
    "knee": 15.0,
    "shin": 10.0,
}  # usual difference of a joint, about each of its axes, between performers at the same moment of a motion
PLACE_STD_M, PLACE_DEPTH_STD_M = 0.06, 0.20  # usual error of the place across and along the line of sight [m]
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
POINT_DEPTH_STD_M = 2.0
"""Noise of the points' depths as observations of their own (paper, eq. 9) near a matched posture [m]: so
large that they count for nothing, since place and joints have errors of their own that determine them."""


def joint_std_rad(skeleton: Skeleton) -> Array:
    """(D,) usual difference of each degree of freedom [rad]; zero for the place."""
    names = skeleton.dof_names
    degrees = [0.0 if "location" in name else JOINT_STD_DEG[name.split(".")[0]] for name in names]
    return np.radians(degrees)


def match_covariance(posture: Posture, camera: Camera, frame: IndexArray) -> Array:
    """Usual error of K matched keyframes, as covariance (K, D, D) of the posture's tangent."""
    index = np.arange(posture.skeleton.dof_count)
    covariance = np.zeros((len(frame), len(index), len(index)))
    covariance[:, index, index] = joint_std_rad(posture.skeleton) ** 2
    sight = camera.sight(posture.translation, frame)
    along = sight[:, :, None] * sight[:, None, :]
    covariance[:, :3, :3] = PLACE_STD_M**2 * (np.eye(3) - along) + PLACE_DEPTH_STD_M**2 * along
    return covariance


def depth_std_m(index: IndexArray, matched: BoolArray, frames: int) -> Array:
    """(F,) noise of the prior's depths over a clip [m], between that of posed and of matched keyframes.

    `index` (K,): the keyframes' frames, in order; `matched` (K,): which of them are matched.
    """
    share = np.interp(np.arange(frames), index, matched.astype(np.float64))
    return np.asarray(DEPTH_STD_M * (POINT_DEPTH_STD_M / DEPTH_STD_M) ** share)


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


def found_std_m(confidence: Array) -> Array:
    """Errors (..., 2) [m] across and along the line of sight of points that were found so surely (...)."""
    sure = confidence[..., None]
    return np.asarray(np.sqrt(sure * SURE_STD_M**2 + (1.0 - sure) * UNSURE_STD_M**2))


def undetermined_covariance(
    points: Array,
    camera: Camera,
    index: IndexArray,
    match_scale: Array,
    confidence: Array,
    place_std_m: Array | float = 0.0,
) -> Array:
    """Covariance (F, P, 3, 3) [m²] of points (F, P, 3) that found keyframes leave undetermined.

    Of K keyframes: `index` in the clip, in order; `match_scale`, size of the error relative to a usual one, 0
    for posed ones; `confidence`, probability that each is about right. `place_std_m` (F,): error of the whole
    performer's place along the line of sight, if more than usual.
    """
    frame = np.arange(len(points))
    sight = camera.sight(points, frame[:, None])
    along = sight[..., :, None] * sight[..., None, :]
    std_m = match_scale[:, None] * found_std_m(confidence)
    across_m, along_m = (np.interp(frame, index, own) for own in std_m.T)
    along_m = np.hypot(along_m, np.interp(frame, index, match_scale) * place_std_m)
    variance = np.square([across_m, along_m])[:, :, None, None, None]
    return np.asarray(variance[0] * (np.eye(3) - along) + variance[1] * along)


# --- Unobserved


@dataclass(frozen=True)
class UnobservedOptions:
    """How postures become uncertain where nothing observes them."""

    grace_s: float = 0.25  # time for which the estimate's own covariance holds
    # time constant at which a limb approaches the variance of anywhere in reach
    time_constant_s: float = 0.35
    trunk_std_rad: float = 0.15  # standard deviation of joints anywhere in reach [rad]
    limb_std_rad: float = 0.5
    # Growth of the place's standard deviation along each axis: the performer may stand or walk.
    walking_speed_m_per_s: float = 0.5
    farthest_m: float = 2.0


UNOBSERVED = UnobservedOptions()


def unobserved_variance(
    skeleton: Skeleton, segments: tuple[str, ...], visible: BoolArray, keyframes: IndexArray, time_s: Array
) -> Array:
    """(F, D) variance of postures beyond their covariance, where nothing observes them [m², rad²].

    `segments` (M,): the segment of each marker, or the joint of each keypoint; an unknown name counts for the
    trunk; `visible` (F, M); `keyframes` (K,): frames whose posture is known.
    """
    trunk, *limbs = skeleton.limbs
    joint = {one.name: index for index, one in enumerate(skeleton.joints)}
    joint |= {segment.name: segment.joint for segment in skeleton.segments}
    first = {name: skeleton.dof_starts[index] for name, index in joint.items()}
    std = np.zeros((len(time_s), skeleton.dof_count))
    posed = np.zeros(len(time_s), dtype=bool)
    posed[keyframes] = True
    for part in (trunk, *limbs):
        own = [i for i, name in enumerate(segments) if first.get(name, int(trunk[0])) in part]
        # Anything visible also locates the trunk.
        observed = posed | (visible if part is trunk else visible[:, own]).any(axis=1)
        unknown = _unobserved_time_s(observed, time_s)
        reach = UNOBSERVED.trunk_std_rad if part is trunk else UNOBSERVED.limb_std_rad
        std[:, part] = (-np.expm1(-unknown / UNOBSERVED.time_constant_s) * reach)[:, None]
        if part is trunk:
            walked = UNOBSERVED.walking_speed_m_per_s * unknown
            std[:, :3] = np.minimum(walked, UNOBSERVED.farthest_m)[:, None]
    return std**2


def _unobserved_time_s(observed: BoolArray, time_s: Array) -> Array:
    """(F,) time from the nearest observed frame beyond the grace [s]."""
    if not observed.any():
        return np.full(len(time_s), UNOBSERVED.farthest_m / UNOBSERVED.walking_speed_m_per_s)
    known = time_s[observed]
    after = np.searchsorted(known, time_s)
    gap = np.minimum(
        np.abs(time_s - known[np.minimum(after, len(known) - 1)]),
        np.abs(time_s - known[np.maximum(after - 1, 0)]),
    )
    return np.asarray(np.maximum(gap - UNOBSERVED.grace_s, 0.0))
