"""Center of mass, and moments moved so that it is over the feet or on a ballistic path."""

from dataclasses import replace

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body, Pose

from .moment import Foot, Moment
from .solving import BODY, posture_of

GRAVITY_MPS2 = 9.81
SHARES_OF_MASS = {
    "hand": (0.006, 0.5),
    "forearm": (0.016, 0.43),
    "upper_arm": (0.028, 0.436),
    "thigh": (0.100, 0.433),
    "shin": (0.0465, 0.433),
    "foot": (0.0145, 0.5),
    "pelvis": (0.217, 0.5),
    "chest": (0.280, 0.5),
    "head": (0.081, 0.8),
}
"""Share of each part in the body's mass, and position of its center along it: Winter (2009), table 4.1; the
trunk's is divided at the waist."""
BEFORE_ANKLE_M = 0.045
"""Distance of a standing person's center of pressure before the ankle [m]."""
STEPS = 12


def center_of_mass(body: Body, pose: Pose) -> Array:
    """(..., 3) center of mass [m]."""
    total, weight = np.zeros((*pose.posture.batch, 3)), 0.0
    for segment in body.skeleton.segments:
        mass, share = SHARES_OF_MASS.get(segment.name.partition(".")[0], (0.0, 0.0))
        start, end = body.segment_ends(pose, segment.name)
        total, weight = total + mass * (start + share * (end - start)), weight + mass
    return np.asarray(total / weight)


def mass_of(moment: Moment) -> Array:
    """(3,) the center of mass of a moment [m]."""
    return center_of_mass(BODY, BODY.pose(posture_of(moment)))


def balanced(moment: Moment, left: float = 0.5, ahead_m: float = 0.0) -> Moment:
    """A moment with its hips moved over the floor until its mass is over its standing feet.

    Args:
        moment: A moment with at least one foot on the floor.
        left: Share of the weight on the left foot where both stand.
        ahead_m: Offset of the mass toward the toes, before a step or a jump.
    """
    places = {}
    for side, foot in moment.legs.items():
        if isinstance(foot, Foot) and foot.height <= 0.0:
            toes = np.radians(foot.turn)
            places[side] = np.array([foot.x, foot.y]) + BEFORE_ANKLE_M * np.array(
                [np.sin(toes), -np.cos(toes)]
            )
    if not places:
        raise ValueError("balance needs a foot on the floor")
    wanted = (
        left * places["L"] + (1.0 - left) * places["R"] if len(places) == 2 else next(iter(places.values()))
    )
    facing = np.radians(moment.pelvis.turn)
    wanted = wanted + ahead_m * np.array([np.sin(facing), -np.cos(facing)])
    return balanced_over(replace(moment, x=float(wanted[0]), y=float(wanted[1])), *wanted.tolist())


def balanced_over(moment: Moment, x: float = 0.0, y: float = -BEFORE_ANKLE_M) -> Moment:
    """A moment with its hips moved until its mass is over a point on the floor [m].

    Its hands and feet stay in place; the default point is before ankles at the world's origin.
    """
    wanted = np.array([x, y])
    for _ in range(STEPS):
        away = wanted - mass_of(moment)[:2]
        moment = replace(moment, x=moment.x + float(away[0]), y=moment.y + float(away[1]))
    return moment


def thrown(moment: Moment, mass: Array) -> Moment:
    """A moment in the air with its mass at a point (3,) [m]."""
    there = replace(moment, x=0.0, y=0.0, height=1.0)
    x, y, z = (float(value) for value in mass - mass_of(there))
    return replace(moment, x=x, y=y, height=1.0 + z)


def flight(start: Array, end: Array, duration_s: float, share: float) -> Array:
    """(3,) position of a thrown mass after a share of its flight from one point to another [m]."""
    elapsed, left = share * duration_s, (1.0 - share) * duration_s
    rise = np.array([0.0, 0.0, 0.5 * GRAVITY_MPS2 * elapsed * left])
    return np.asarray(start + share * (end - start) + rise)
