"""The default body: joint limits, parts, colors of sides, masses, and the skeleton itself.

Limits: American Academy of Orthopaedic Surgeons (1965), *Joint Motion: Method of Measuring and Recording*,
widened by about a quarter because performers are no patients and because a ball's range is stated on the
components of its rotation vector from rest, which is only a box around the true, rounder range.
"""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from ..arrays import Array
from .skeleton import SIDES, Joint, JointKind, Placement, PrincipalPoint, Segment, Skeleton, Vector

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
    about_x, *sideways = limits
    return (about_x, *((-upper, -lower) for lower, upper in sideways))


# --- The five parts of the body that move about independently


TRUNK = "trunk"
LIMBS = ("arm.L", "arm.R", "leg.L", "leg.R")
_STEMS = {
    "arm": ("upper_arm", "forearm", "hand", "elbow", "wrist", "index", "thumb", "pinky"),
    "leg": ("thigh", "shin", "foot", "knee", "ankle", "heel", "toe", "small_toe"),
}
_LIMB_OF = {stem: limb for limb, stems in _STEMS.items() for stem in stems}


def limb_of(name: str) -> str:
    """The part of the body that a segment or a point of the body belongs to: `arm.L` ... `leg.R` or `trunk`.

    Shoulders and hips are the trunk's.
    """
    stem, _, side = name.partition(".")
    limb = _LIMB_OF.get(stem)
    return TRUNK if limb is None else f"{limb}.{side}"


# --- The one color code of left and right


Rgb = tuple[int, int, int]

LIGHT: Mapping[str, Rgb] = {"L": (87, 181, 232), "R": (245, 168, 26), "": (235, 235, 235)}
"""By side, over footage and in Blender's dark viewport: sky blue and orange; the middle has no side."""
STRONG: Mapping[str, Rgb] = {"L": (0, 114, 178), "R": (213, 94, 0), "": (42, 45, 51)}
"""By side, on white paper: blue and vermilion, the dark neighbors of those; ink for the middle."""

SHADED: Mapping[str, Rgb] = {**STRONG, "": (150, 153, 158)}  # the strong ones on dark ground: bones


def side_of(name: str) -> str:
    """The side in a name of Keymark's own: `L`, `R`, or nothing for the middle."""
    side = name.rpartition(".")[2]
    return side if side in ("L", "R") else ""


# --- Center of mass of the body, by its principal points


MASS_SHARES = {
    "head": ((("head", 1.0),), 0.081),
    "trunk": ((("shoulder", 0.5), ("hip", 0.5)), 0.497),
    "upper_arm": ((("shoulder", 0.564), ("elbow", 0.436)), 0.056),
    "forearm": ((("elbow", 0.318), ("wrist", 0.682)), 0.044),
    "thigh": ((("hip", 0.567), ("knee", 0.433)), 0.2),
    "shin": ((("knee", 0.394), ("ankle", 0.606)), 0.122),
}
"""Where each segment's center of mass lies between principal points, and its share of the body's mass, both
sides together, hands and feet with the segments above them (Winter 2009, *Biomechanics and Motor Control of
Human Movement*, table 4.1)."""


def mass_weights(skeleton: Skeleton) -> Array:
    """(P,) weight of each principal point in the center of mass; they sum to 1."""
    names = skeleton.point_names
    weights = np.zeros(len(names))
    for points, share in MASS_SHARES.values():
        for stem, part in points:
            own = [index for index, name in enumerate(names) if name.partition(".")[0] == stem]
            weights[own] += share * part / len(own)
    return weights


# --- The default body


WAIST_HEIGHT = 0.4  # share of the trunk below the one waist joint, which stands for a whole spine
XYZ = ("x", "y", "z")
ROTATIONS = tuple(f"rotation_{axis}" for axis in XYZ)
HERE: Placement = {}
OUTWARD = {"L": 1.0, "R": -1.0}  # sign of x away from the middle


def _ball(name: str, parent: int, placement: Placement, *deviations: float) -> Joint:
    limits = joint_limits_deg(name)
    return Joint(name, parent, JointKind.BALL, placement, (0.0, 0.0, 0.0), ROTATIONS, limits, deviations)


def _hinge(
    name: str, parent: int, placement: Placement, axis: Vector, component: str, deviation: float
) -> Joint:
    limits = joint_limits_deg(name)
    return Joint(name, parent, JointKind.HINGE, placement, axis, (component,), limits, (deviation,))


def _joints() -> tuple[Joint, ...]:
    location = tuple(f"location_{axis}" for axis in XYZ)
    chest: Placement = {"trunk": (0.0, 0.0, 1.0 - WAIST_HEIGHT)}
    joints = [
        Joint(
            "pelvis",
            -1,
            JointKind.FREE,
            HERE,
            components=(*location, *ROTATIONS),
            deviations=(0.02, 0.015, 0.03, 0.05, 0.05, 0.05),
        ),
        _ball("waist", 0, {"trunk": (0.0, 0.0, WAIST_HEIGHT)}, 0.08, 0.06, 0.06),
        _ball("neck", 1, chest, 0.25, 0.08, 0.12),
    ]
    for side, out in OUTWARD.items():
        first = len(joints)
        width, arm = {"shoulder_width": (0.5 * out, 0.0, 0.0)}, {f"upper_arm.{side}": (out, 0.0, 0.0)}
        joints += [
            _hinge(f"girdle.{side}", 1, chest, (0.0, -out, 0.0), "elevation", 0.03),
            _ball(f"shoulder.{side}", first, width, 0.12, 0.12, 0.14),
            _hinge(f"elbow.{side}", first + 1, arm, (0.0, 0.0, -out), "flexion", 0.15),
            _hinge(f"forearm.{side}", first + 2, HERE, (out, 0.0, 0.0), "pronation", 0.15),
        ]
    for side, out in OUTWARD.items():
        first = len(joints)
        width, thigh = {"hip_width": (0.5 * out, 0.0, 0.0)}, {f"thigh.{side}": (0.0, 0.0, -1.0)}
        joints += [
            _ball(f"hip.{side}", 0, width, 0.11, 0.08, 0.11),
            _hinge(f"knee.{side}", first, thigh, (1.0, 0.0, 0.0), "flexion", 0.2),
            _hinge(f"shin.{side}", first + 1, HERE, (0.0, 0.0, -1.0), "axial", 0.08),
        ]
    return tuple(joints)


def _segments(index: dict[str, int]) -> tuple[Segment, ...]:
    segments = [
        Segment("pelvis", index["pelvis"], HERE, {"trunk": (0.0, 0.0, WAIST_HEIGHT)}, None),
        Segment("chest", index["waist"], HERE, {"trunk": (0.0, 0.0, 1.0 - WAIST_HEIGHT)}, "pelvis"),
        Segment("head", index["neck"], HERE, {"neck_head": (0.0, 0.0, 1.0)}, "chest"),
    ]
    for side, out in OUTWARD.items():
        girdle, arm, forearm, hand = (f"{part}.{side}" for part in ("girdle", "upper_arm", "forearm", "hand"))
        elbow, wrist = ({name: (out, 0.0, 0.0)} for name in (arm, forearm))
        segments += [
            Segment(girdle, index[girdle], HERE, {"shoulder_width": (0.5 * out, 0.0, 0.0)}, "chest"),
            Segment(arm, index[f"shoulder.{side}"], HERE, elbow, girdle),
            Segment(forearm, index[forearm], HERE, wrist, arm),
            Segment(hand, index[forearm], wrist, {**wrist, hand: (out, 0.0, 0.0)}, forearm),
        ]
    for side in SIDES:
        thigh, shin, foot = (f"{part}.{side}" for part in ("thigh", "shin", "foot"))
        knee, ankle = ({name: (0.0, 0.0, -1.0)} for name in (thigh, shin))
        segments += [
            Segment(thigh, index[f"hip.{side}"], HERE, knee, "pelvis"),
            Segment(shin, index[shin], HERE, ankle, thigh),
            Segment(foot, index[shin], ankle, {**ankle, foot: (0.0, -0.93, -0.36)}, shin),
        ]
    return tuple(segments)


def _points(index: dict[str, int]) -> tuple[PrincipalPoint, ...]:
    points = [PrincipalPoint("head", index["neck"], {"neck_head": (0.0, 0.0, 1.0)})]
    limbs = (("shoulder", "elbow", "wrist", "forearm"), ("hip", "knee", "ankle", "shin"))
    for root, middle, end, last in limbs:
        for name in (root, middle):
            points += [PrincipalPoint(f"{name}.{side}", index[f"{name}.{side}"], HERE) for side in SIDES]
        for side, out in OUTWARD.items():
            along: Vector = (0.0, 0.0, -1.0) if last == "shin" else (out, 0.0, 0.0)
            part = f"{last}.{side}"
            points.append(PrincipalPoint(f"{end}.{side}", index[part], {part: along}))
    return tuple(points)


_JOINTS = _joints()
_INDEX = {joint.name: index for index, joint in enumerate(_JOINTS)}
HUMAN = Skeleton(_JOINTS, _segments(_INDEX), _points(_INDEX))
"""The default skeleton of 34 degrees of freedom (paper, section 2; our reading of its Figure 2)."""
HIPS, SHOULDERS, ANKLES = (
    tuple(HUMAN.point_names.index(f"{joint}.{side}") for side in SIDES)
    for joint in ("hip", "shoulder", "ankle")
)
"""Indices of the left and the right one among the principal points."""
LIMB_SEGMENTS = (
    *(("upper_arm", "shoulder", "elbow"), ("forearm", "elbow", "wrist")),
    *(("thigh", "hip", "knee"), ("shin", "knee", "ankle")),
)
"""Segments of limbs, from the body outward, and the principal points at their ends, without sides."""
