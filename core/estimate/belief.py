"""What is believed of a motion before the footage is asked: postures through keyframes, and how these err.

A keyframe is a posture with a covariance. A person who poses a skeleton over footage puts every joint a
little off, and the whole figure too; an error upstream is made good downstream, so joints' places err
independently, not their angles. One put right in the picture alone is tight across the line of sight. A found
posture is another performer's, so joints differ, and what hangs on them differs along with them; one of a
reference motion errs as that does. These shapes are assumed, the size of a person's error is not.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.kinematics import Body, Pose
from ..body.posture import Posture
from ..body.skeleton import Skeleton
from ..camera.camera import Camera
from ..terms.depths import DEPTH_STD_M
from ..terms.reference import ExpectedPoints

FEWEST_POSED = 2  # fewer posed keyframes calibrate nothing


@dataclass(frozen=True, eq=False)
class Belief:
    """F postures that pass through K keyframes, and what else is believed of them."""

    prior: Posture  # F postures
    frame: IndexArray  # (K,) the keyframes, at least one, in order
    doubt: Array
    """(K,) size of a found keyframe's error, in usual differences between performers; 0 where a person
    vouches for its place in space."""
    pictured: BoolArray  # (K,) which of the found ones a person has put right in the picture
    ankle_m: Array | None = None  # (F,) usual height of the lower ankle [m]; None where posed ones tell it
    feet_seen: tuple[bool, bool] = (True, True)  # left and right; one that never is says nothing of the place
    reference: ExpectedPoints | None = None  # where a motion from elsewhere has the points; None without one

    @property
    def postures(self) -> Posture:
        """The K keyframes' postures."""
        return self.prior[self.frame]

    @property
    def posed(self) -> BoolArray:
        """(K,) which of them a person has posed in space."""
        return self.doubt == 0.0

    @property
    def calibrating(self) -> BoolArray:
        """(K,) by which the footage is calibrated: those posed, and those put right in the picture.

        Of the latter two count as one: a person puts right what is wrong there, not what is usual. Found ones
        err by more than any of what is calibrated, and all in the same direction: sleeves would make up for
        another performer's gait.
        """
        enough = self.posed.sum() + self.pictured.sum() // 2 >= FEWEST_POSED
        return self.posed | self.pictured if enough else self.posed

    @property
    def depth_std_m(self) -> Array:
        """(F,) noise of the prior's depths [m], between that of posed and of found keyframes."""
        # 2.0: Noise of the points' depths as observations of their own (paper, eq. 9) near a found posture
        # [m]: so large that they count for nothing, since place and joints have errors of their own that
        # determine them.
        return np.asarray(DEPTH_STD_M * (2.0 / DEPTH_STD_M) ** self.found_share)

    @property
    def found_share(self) -> Array:
        """(F,) how much of what is believed around each frame was found and not posed, 0 to 1."""
        return np.interp(np.arange(self.prior.batch[0]), self.frame, 1.0 * ~self.posed)

    def covariance(self, body: Body, camera: Camera) -> Array:
        """(K, D, D) of the keyframes' tangents, without what was put right in the picture."""
        found = found_covariance(self.postures, camera, self.frame) * self.doubt[:, None, None] ** 2
        posed = posing_covariance(body, body.pose(self.postures))
        return np.where(self.posed[:, None, None], posed, found)


# --- Posed


POINT_STD_M = 0.014  # error of each point along each axis [m]


def posing_covariance(body: Body, pose: Pose) -> Array:
    """A person's usual posing error at given poses, as covariance (K, D, D) of the posture's tangent."""
    count = body.skeleton.dof_count
    jacobian = body.points_jacobian(pose).reshape(*pose.posture.batch, -1, count) / POINT_STD_M
    # 0.5: error of rotations that no point determines, about a limb's own axis [rad]
    information = np.swapaxes(jacobian, -1, -2) @ jacobian + np.eye(count) * 0.5**-2
    covariance = np.linalg.solve(information, np.broadcast_to(np.eye(count), information.shape))
    place = np.arange(3)
    # 0.009: error that all points share along each axis [m]
    covariance[..., place, place] += 0.009**2
    return np.asarray(0.5 * (covariance + np.swapaxes(covariance, -1, -2)))


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


# --- Found


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


def joint_std_rad(skeleton: Skeleton) -> Array:
    """(D,) usual difference of each degree of freedom [rad]; zero for the place."""
    names = skeleton.dof_names
    degrees = [0.0 if "location" in name else JOINT_STD_DEG[name.split(".")[0]] for name in names]
    return np.radians(degrees)


def found_covariance(posture: Posture, camera: Camera, frame: IndexArray) -> Array:
    """Usual error of K found keyframes, as covariance (K, D, D) of the posture's tangent."""
    index = np.arange(posture.skeleton.dof_count)
    covariance = np.zeros((len(frame), len(index), len(index)))
    covariance[:, index, index] = joint_std_rad(posture.skeleton) ** 2
    sight = camera.sight(posture.translation, frame)
    along = sight[:, :, None] * sight[:, None, :]
    covariance[:, :3, :3] = PLACE_STD_M**2 * (np.eye(3) - along) + PLACE_DEPTH_STD_M**2 * along
    return covariance
