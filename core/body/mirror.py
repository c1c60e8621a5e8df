"""Mirror images: left and right exchanged about the plane x = 0 of the world."""

from functools import lru_cache

import numpy as np

from ..arrays import Array
from .human import HUMAN
from .posture import Posture
from .skeleton import Skeleton

MIRROR = np.array([-1.0, 1.0, 1.0])  # factors of the reflection on x, y and z
OTHER_SIDE = {".L": ".R", ".R": ".L"}


def other_side(name: str) -> str:
    """The name on the opposite side: `knee.L` for `knee.R`; a name without a side stays."""
    return name[:-2] + OTHER_SIDE.get(name[-2:], name[-2:])


OPPOSITE = np.array([HUMAN.point_names.index(other_side(name)) for name in HUMAN.point_names])
"""(P,) the principal point on the other side of each."""


def mirrored(posture: Posture) -> Posture:
    """The mirror image of a posture, or of a batch.

    Exact: only signs and the order of joints change, so mirroring twice gives the very same numbers.
    """
    balls, hinges, signs = _opposites(posture.skeleton)
    turned = posture.rotations[..., balls, :, :] * np.outer(MIRROR, MIRROR)
    return Posture(
        posture.skeleton, posture.translation * MIRROR, turned, posture.angles[..., hinges] * signs
    )


@lru_cache(maxsize=8)
def _opposites(skeleton: Skeleton) -> tuple[list[int], list[int], Array]:
    """Opposite columns of balls and of hinges, and the signs of these."""
    opposite = [skeleton.joint_index(other_side(joint.name)) for joint in skeleton.joints]
    balls = [skeleton.ball_joints.index(opposite[joint]) for joint in skeleton.ball_joints]
    hinges = [skeleton.hinge_joints.index(opposite[joint]) for joint in skeleton.hinge_joints]
    # M Exp(q a) M = Exp(-q M a): a rotation's axis is a pseudovector.
    signs = np.sign(np.sum(-MIRROR * skeleton.hinge_axes[hinges] * skeleton.hinge_axes, axis=1))
    return balls, hinges, signs
