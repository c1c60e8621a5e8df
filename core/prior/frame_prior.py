"""What is believed of one frame's posture before its picture is looked at, for assisted posing."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.heading import yawed_in_place
from ..body.posture import Posture
from ..body.skeleton import Skeleton
from ..observation.depths import DEPTH_STD_M
from .interpolation import interpolate
from .keyframes import Keyframe

# How far postures of the same person lie apart at two moments that have nothing to do with each other
# [m, rad]: round numbers for lively motion. Head and what no marker shows stay nearer to what was posed.
FARTHEST = {
    "pelvis.location": 0.40,
    "pelvis": 0.35,
    "waist": 0.30,
    "neck": 0.15,
    "girdle": 0.12,
    "shoulder": 0.60,
    "elbow": 0.60,
    "forearm": 0.15,
    "hip": 0.45,
    "knee": 0.60,
    "shin": 0.05,
}
FORGETTING_S = 0.3
"""Time after which two thirds of that difference are there."""
SPEED_M_PER_S = 0.7
"""A performer who walks goes on and on: the place differs by as much as this times the time, too."""
GOING_ON = 0.5
"""Of the way between the last two keyframes, so much goes on at the same pace."""
TOUCHED_UP = 0.5
"""A pose that the animator has set lies within this share of the farthest differences."""
UNKNOWN_HEADING_RAD = 1.2
UNKNOWN_PLACE_M = 0.3
UNKNOWN_DEPTHS_M = 0.6
HEADINGS_RAD = np.radians([0.0, 60.0, -60.0, 180.0])


@dataclass(frozen=True, eq=False)
class FramePrior:
    """A normal belief in a posture, and where else to look."""

    posture: Posture
    """A single posture: the most probable one."""
    std: Array
    """(D,) how far each degree of freedom of its tangent may lie off [m, rad]."""
    starts: Posture
    """A batch of postures to start looking from, the first of them `posture`."""
    depth_std_m: float = DEPTH_STD_M
    """How far each point's depth may lie off [m]."""
    grounded: Posture | None = None
    """Postures of which at least one stands on the ground; None where nothing says where that is."""


def difference_std(skeleton: Skeleton, time_s: float) -> Array:
    """How much postures differ, (D,) [m, rad], that lie a time apart."""
    share = 1.0 - np.exp(-abs(time_s) / FORGETTING_S)
    std = share * _farthest(skeleton)
    std[:3] = np.maximum(std[:3], SPEED_M_PER_S * abs(time_s))
    return np.maximum(std, 1e-3)


def prior_from_keyframes(keyframes: Sequence[Keyframe], index: int, fps: float) -> FramePrior:
    """What the nearest keyframes before and after say of a frame.

    Args:
        keyframes: At least one, in order of frame; one at the very frame is left out of account unless it is
            the only one.
        index: The frame's place in the clip.
        fps: Frames per second.
    """
    others = [keyframe for keyframe in keyframes if keyframe.index != index] or list(keyframes)
    before = [keyframe for keyframe in others if keyframe.index <= index][-1:]
    after = [keyframe for keyframe in others if keyframe.index > index][:1]
    near = sorted(before + after, key=lambda keyframe: abs(keyframe.index - index))
    skeleton = near[0].posture.skeleton
    variances = [difference_std(skeleton, (keyframe.index - index) / fps) ** 2 for keyframe in near]
    postures = [keyframe.posture for keyframe in near]
    everyone = Posture.stack([keyframe.posture for keyframe in others])
    if len(near) == 1:
        postures = [_moved_on(others, index)]
        return FramePrior(postures[0], np.sqrt(variances[0]), Posture.stack(postures), grounded=everyone)
    between = interpolate(tuple(others), index + 1)[index]
    # Each neighbor says something of its own, the nearer one more.
    std = (1.0 / variances[0] + 1.0 / variances[1]) ** -0.5
    return FramePrior(between, std, Posture.stack([between, *postures]), grounded=everyone)


def _moved_on(keyframes: Sequence[Keyframe], index: int) -> Posture:
    """The keyframe nearest to a frame before or after all of them, going on the way the last two went."""
    early = index < keyframes[0].index
    last, other = (keyframes[0], keyframes[1:2]) if early else (keyframes[-1], keyframes[-2:-1])
    if not other:
        return last.posture
    step = np.zeros(last.posture.skeleton.dof_count)
    time = (index - last.index) / (last.index - other[0].index)
    step[:2] = GOING_ON * time * (last.posture.translation - other[0].posture.translation)[:2]
    return last.posture.plus(step)


def prior_from_pose(posture: Posture) -> FramePrior:
    """What a pose says that the animator has set roughly for the frame."""
    return FramePrior(posture, TOUCHED_UP * _farthest(posture.skeleton), Posture.stack([posture]))


def prior_from_standing(posture: Posture, depth_std_m: float = UNKNOWN_DEPTHS_M) -> FramePrior:
    """What a body says that merely stands about where the performer is: anything is possible.

    Args:
        posture: How it stands.
        depth_std_m: How far the points may lie off in depth [m]; less where the place was measured.
    """
    std = _farthest(posture.skeleton)
    std[:3] = UNKNOWN_PLACE_M
    std[5] = UNKNOWN_HEADING_RAD  # about the body's own vertical
    around = yawed_in_place(posture, HEADINGS_RAD)
    return FramePrior(posture, std, around, depth_std_m, grounded=around[:1])


def _farthest(skeleton: Skeleton) -> Array:
    return np.array(
        [
            FARTHEST["pelvis.location" if ".location" in name else name.split(".")[0]]
            for name in skeleton.dof_names
        ]
    )
