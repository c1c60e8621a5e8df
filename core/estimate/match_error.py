"""How far matched keyframes are off: another performer's way of moving, in another place.

A library's postures are another performer's, so joints differ, and what hangs on them differs along with
them; a person who poses a keyframe errs in the joints' places instead (`posing_error`). The place across the
line of sight follows from where the markers are seen, the one along it from little.
"""

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.posture import Posture
from ..body.skeleton import Skeleton
from ..footage.camera import Camera
from ..observation.depths import DEPTH_STD_M

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
}
"""Usual difference of a joint, about each of its axes, between performers at the same moment of a motion."""
PLACE_STD_M, PLACE_DEPTH_STD_M = 0.06, 0.20
"""Usual error of the place across and along the line of sight [m]."""
UNDECIDED_DEPTH_M = 0.10
"""How far points may lie off along the line of sight beyond what the estimate knows of itself [m].

A limb that leans toward the camera looks like one that leans away from it, a body turned to one side nearly
like one turned to the other: what a library decides there is right or wrong, and no covariance about what was
decided tells. About what takes with truth show where nothing was posed."""
POINT_DEPTH_STD_M = 2.0
"""What the depths of the points count as observations of their own (paper, eq. 9) near a matched posture [m]:
next to nothing, since place and joints, which are believed as far as they deserve, tell them."""


def joint_std_rad(skeleton: Skeleton) -> Array:
    """(D,) usual difference of each degree of freedom [rad]; zero for the place."""
    names = skeleton.dof_names
    degrees = [0.0 if "location" in name else JOINT_STD_DEG[name.split(".")[0]] for name in names]
    return np.radians(degrees)


def match_covariance(posture: Posture, camera: Camera, frame: IndexArray) -> Array:
    """The usual error of K matched keyframes, as covariance (K, D, D) of the posture's tangent."""
    index = np.arange(posture.skeleton.dof_count)
    covariance = np.zeros((len(frame), len(index), len(index)))
    covariance[:, index, index] = joint_std_rad(posture.skeleton) ** 2
    sight = camera.sight(posture.translation, frame)
    along = sight[:, :, None] * sight[:, None, :]
    covariance[:, :3, :3] = PLACE_STD_M**2 * (np.eye(3) - along) + PLACE_DEPTH_STD_M**2 * along
    return covariance


def depth_std_m(index: IndexArray, matched: BoolArray, frames: int) -> Array:
    """(F,) noise of the prior's depths over a clip [m], between that of posed and of matched keyframes.

    Args:
        index: (K,) the keyframes' places in the clip, in order.
        matched: (K,) which of them nobody posed.
        frames: Frames of the clip, F.
    """
    share = np.interp(np.arange(frames), index, matched.astype(np.float64))
    return np.asarray(DEPTH_STD_M * (POINT_DEPTH_STD_M / DEPTH_STD_M) ** share)


def undecided_covariance(points: Array, camera: Camera, index: IndexArray, doubt: Array) -> Array:
    """What matched keyframes leave open of points (F, P, 3), as covariance (F, P, 3, 3) [m²].

    Args:
        points: Places in the world [m].
        camera: The camera.
        index: (K,) the keyframes' places in the clip, in order.
        doubt: (K,) how far matched ones are off, in usual differences; 0 for posed ones.
    """
    frame = np.arange(len(points))
    sight = camera.sight(points, frame[:, None])
    std_m = UNDECIDED_DEPTH_M * np.interp(frame, index, doubt)
    return np.asarray(std_m[:, None, None, None] ** 2 * sight[..., :, None] * sight[..., None, :])
