"""The default body: ten joints, 34 degrees of freedom, thirteen principal points."""

from .joint_limits import joint_limits_deg
from .skeleton import SIDES, Joint, JointKind, Placement, PrincipalPoint, Segment, Skeleton

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
                f"thigh.{side}",
                index[f"hip.{side}"],
                HERE,
                {f"thigh.{side}": (0.0, 0.0, -1.0)},
                "pelvis",
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


HUMAN = human_skeleton()
"""The default skeleton; immutable, hence shared."""
