"""Joint limits: the range of motion of each joint of the default body [degrees].

American Academy of Orthopaedic Surgeons (1965), *Joint Motion: Method of Measuring and Recording*, widened by
about a quarter because performers are no patients and because a ball's range is stated on the components of
its rotation vector from rest, which is only a box around the true, rounder range.
"""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from ..arrays import Array
from .skeleton import SIDES, Joint, JointKind, Placement, PrincipalPoint, Segment, Skeleton

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

SHADED: Mapping[str, Rgb] = {**STRONG, "": (150, 153, 158)}
"""The strong ones where the ground is dark: of bones that are not selected."""


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


WAIST_HEIGHT = 0.4
"""Share of the trunk below the waist joint. The real spine bends all along; a single joint fits best here."""
XYZ = ("x", "y", "z")
ROTATIONS = tuple(f"rotation_{axis}" for axis in XYZ)
HERE: Placement = {}


def _joints() -> tuple[Joint, ...]:
    joints = [
        Joint(
            "pelvis",
            -1,
            JointKind.FREE,
            HERE,
            components=(*(f"location_{axis}" for axis in XYZ), *ROTATIONS),
            deviations=(0.02, 0.015, 0.03, 0.05, 0.05, 0.05),
        ),
        Joint(
            "waist",
            0,
            JointKind.BALL,
            {"trunk": (0.0, 0.0, WAIST_HEIGHT)},
            components=ROTATIONS,
            limits_deg=joint_limits_deg("waist"),
            deviations=(0.08, 0.06, 0.06),
        ),
        Joint(
            "neck",
            1,
            JointKind.BALL,
            {"trunk": (0.0, 0.0, 1.0 - WAIST_HEIGHT)},
            components=ROTATIONS,
            limits_deg=joint_limits_deg("neck"),
            deviations=(0.25, 0.08, 0.12),
        ),
    ]
    for side in SIDES:
        joints += _arm(side, len(joints))
    for side in SIDES:
        joints += _leg(side, len(joints))
    return tuple(joints)


def _arm(side: str, first: int) -> list[Joint]:
    out = 1.0 if side == "L" else -1.0
    chest = 1
    return [
        Joint(
            f"girdle.{side}",
            chest,
            JointKind.HINGE,
            {"trunk": (0.0, 0.0, 1.0 - WAIST_HEIGHT)},
            axis=(0.0, -out, 0.0),
            components=("elevation",),
            limits_deg=joint_limits_deg(f"girdle.{side}"),
            deviations=(0.03,),
        ),
        Joint(
            f"shoulder.{side}",
            first,
            JointKind.BALL,
            {"shoulder_width": (0.5 * out, 0.0, 0.0)},
            components=ROTATIONS,
            limits_deg=joint_limits_deg(f"shoulder.{side}"),
            deviations=(0.12, 0.12, 0.14),
        ),
        Joint(
            f"elbow.{side}",
            first + 1,
            JointKind.HINGE,
            {f"upper_arm.{side}": (out, 0.0, 0.0)},
            axis=(0.0, 0.0, -out),
            components=("flexion",),
            limits_deg=joint_limits_deg(f"elbow.{side}"),
            deviations=(0.15,),
        ),
        Joint(
            f"forearm.{side}",
            first + 2,
            JointKind.HINGE,
            HERE,
            axis=(out, 0.0, 0.0),
            components=("pronation",),
            limits_deg=joint_limits_deg(f"forearm.{side}"),
            deviations=(0.15,),
        ),
    ]


def _leg(side: str, first: int) -> list[Joint]:
    out = 1.0 if side == "L" else -1.0
    return [
        Joint(
            f"hip.{side}",
            0,
            JointKind.BALL,
            {"hip_width": (0.5 * out, 0.0, 0.0)},
            components=ROTATIONS,
            limits_deg=joint_limits_deg(f"hip.{side}"),
            deviations=(0.11, 0.08, 0.11),
        ),
        Joint(
            f"knee.{side}",
            first,
            JointKind.HINGE,
            {f"thigh.{side}": (0.0, 0.0, -1.0)},
            axis=(1.0, 0.0, 0.0),
            components=("flexion",),
            limits_deg=joint_limits_deg(f"knee.{side}"),
            deviations=(0.2,),
        ),
        Joint(
            f"shin.{side}",
            first + 1,
            JointKind.HINGE,
            HERE,
            axis=(0.0, 0.0, -1.0),
            components=("axial",),
            limits_deg=joint_limits_deg(f"shin.{side}"),
            deviations=(0.08,),
        ),
    ]


def _segments(index: dict[str, int]) -> tuple[Segment, ...]:
    segments = [
        Segment("pelvis", index["pelvis"], HERE, {"trunk": (0.0, 0.0, WAIST_HEIGHT)}, None),
        Segment("chest", index["waist"], HERE, {"trunk": (0.0, 0.0, 1.0 - WAIST_HEIGHT)}, "pelvis"),
        Segment("head", index["neck"], HERE, {"neck_head": (0.0, 0.0, 1.0)}, "chest"),
    ]
    for side in SIDES:
        out = 1.0 if side == "L" else -1.0
        segments += [
            Segment(
                f"girdle.{side}",
                index[f"girdle.{side}"],
                HERE,
                {"shoulder_width": (0.5 * out, 0.0, 0.0)},
                "chest",
            ),
            Segment(
                f"upper_arm.{side}",
                index[f"shoulder.{side}"],
                HERE,
                {f"upper_arm.{side}": (out, 0.0, 0.0)},
                f"girdle.{side}",
            ),
            Segment(
                f"forearm.{side}",
                index[f"forearm.{side}"],
                HERE,
                {f"forearm.{side}": (out, 0.0, 0.0)},
                f"upper_arm.{side}",
            ),
            Segment(
                f"hand.{side}",
                index[f"forearm.{side}"],
                {f"forearm.{side}": (out, 0.0, 0.0)},
                {f"forearm.{side}": (out, 0.0, 0.0), f"hand.{side}": (out, 0.0, 0.0)},
                f"forearm.{side}",
            ),
        ]
    for side in SIDES:
        ankle: Placement = {f"shin.{side}": (0.0, 0.0, -1.0)}
        segments += [
            Segment(
                f"thigh.{side}", index[f"hip.{side}"], HERE, {f"thigh.{side}": (0.0, 0.0, -1.0)}, "pelvis"
            ),
            Segment(f"shin.{side}", index[f"shin.{side}"], HERE, ankle, f"thigh.{side}"),
            Segment(
                f"foot.{side}",
                index[f"shin.{side}"],
                ankle,
                {**ankle, f"foot.{side}": (0.0, -0.93, -0.36)},
                f"shin.{side}",
            ),
        ]
    return tuple(segments)


def _points(index: dict[str, int]) -> tuple[PrincipalPoint, ...]:
    points = [PrincipalPoint("head", index["neck"], {"neck_head": (0.0, 0.0, 1.0)})]
    for name, joint in (("shoulder", "shoulder"), ("elbow", "elbow")):
        points += [PrincipalPoint(f"{name}.{side}", index[f"{joint}.{side}"], HERE) for side in SIDES]
    for side in SIDES:
        out = 1.0 if side == "L" else -1.0
        points.append(
            PrincipalPoint(f"wrist.{side}", index[f"forearm.{side}"], {f"forearm.{side}": (out, 0.0, 0.0)})
        )
    for name, joint in (("hip", "hip"), ("knee", "knee")):
        points += [PrincipalPoint(f"{name}.{side}", index[f"{joint}.{side}"], HERE) for side in SIDES]
    for side in SIDES:
        points.append(
            PrincipalPoint(f"ankle.{side}", index[f"shin.{side}"], {f"shin.{side}": (0.0, 0.0, -1.0)})
        )
    return tuple(points)


def human_skeleton() -> Skeleton:
    """The default skeleton of 34 degrees of freedom (paper, section 2; our reading of its Figure 2)."""
    joints = _joints()
    index = {joint.name: i for i, joint in enumerate(joints)}
    return Skeleton(joints, _segments(index), _points(index))


HUMAN = human_skeleton()  # the default skeleton; immutable, hence shared
