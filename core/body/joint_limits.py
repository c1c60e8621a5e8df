"""Joint limits: the range of motion of each joint of the default body [degrees].

American Academy of Orthopaedic Surgeons (1965), *Joint Motion: Method of Measuring and Recording*, widened by
about a quarter because performers are no patients and because a ball's range is stated on the components of
its rotation vector from rest, which is only a box around the true, rounder range.
"""

from collections.abc import Mapping
from types import MappingProxyType

Range = tuple[float, float]

JOINT_LIMITS_DEG: Mapping[str, tuple[Range, ...]] = MappingProxyType(
    {
        "waist": ((-40.0, 110.0), (-45.0, 45.0), (-60.0, 60.0)),
        "neck": ((-75.0, 60.0), (-55.0, 55.0), (-100.0, 100.0)),
        "girdle": ((-15.0, 45.0),),
        "shoulder": ((-130.0, 130.0), (-100.0, 110.0), (-140.0, 60.0)),
        "elbow": ((-5.0, 155.0),),
        "forearm": ((-100.0, 100.0),),
        "hip": ((-145.0, 45.0), (-70.0, 40.0), (-60.0, 60.0)),
        "knee": ((-5.0, 155.0),),
        "shin": ((-40.0, 40.0),),
    }
)
"""Lower and upper bound of a hinge's angle, or of a ball's rotation vector about x, y and z; of the left side
where there are two. `Skeleton.limits` has them by degree of freedom [rad]."""


def joint_limits_deg(joint: str) -> tuple[Range, ...]:
    """Limits of one joint by its name, such as `waist` or `shoulder.R`; KeyError for an unknown one.

    Mirrored in the sagittal plane, rotations about y and z change their sign and those about x do not. Hinges
    have mirrored axes, so that their angles mean the same on both sides.
    """
    name, _, side = joint.partition(".")
    limits = JOINT_LIMITS_DEG[name]
    if side != "R" or len(limits) == 1:
        return limits
    about_x, *others = limits
    return (about_x, *((-upper, -lower) for lower, upper in others))
