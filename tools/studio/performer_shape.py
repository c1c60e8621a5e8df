"""The performer's outer shape at one posture: limbs as stacks of rings with calves, hips, cuffs and a face.

The shape is drawn by eye and deliberately differs from the estimator's tapered cylinders: muscles bulge,
cloth stands off, the trunk is one curved form. Sizes are meters. Each part moves with one joint; the skin
blends where parts meet.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body, Pose

Ring = tuple[float, float, float, float]
"""Share of the length, half-width sideways, half-width front to back, shift to the back."""

SIDES_OF_RING = 28

LIMBS: dict[str, list[Ring]] = {
    "thigh": [
        (-0.12, 0.070, 0.076, 0.012),
        (0.04, 0.086, 0.092, 0.010),
        (0.25, 0.082, 0.086, 0.0),
        (0.6, 0.066, 0.070, -0.004),
        (0.9, 0.052, 0.056, 0.0),
        (1.03, 0.050, 0.053, -0.004),
    ],
    "shin": [
        (-0.04, 0.050, 0.053, -0.003),
        (0.12, 0.053, 0.057, 0.008),
        (0.29, 0.059, 0.064, 0.017),
        (0.48, 0.053, 0.056, 0.014),
        (0.72, 0.041, 0.044, 0.007),
        (0.89, 0.037, 0.041, 0.004),
        (1.02, 0.036, 0.044, 0.006),
    ],
    "upper_arm": [
        (-0.10, 0.046, 0.046, 0.0),
        (0.08, 0.055, 0.057, 0.0),
        (0.28, 0.051, 0.052, 0.0),
        (0.55, 0.047, 0.050, -0.003),
        (0.85, 0.040, 0.042, 0.0),
        (1.04, 0.041, 0.041, 0.004),
    ],
    "forearm": [
        (-0.05, 0.040, 0.041, 0.003),
        (0.10, 0.044, 0.045, 0.0),
        (0.28, 0.046, 0.043, -0.003),
        (0.6, 0.037, 0.034, 0.0),
        (0.88, 0.030, 0.026, 0.0),
        (1.0, 0.030, 0.023, 0.0),
    ],
    "hand": [
        (0.02, 0.027, 0.020, 0.0),
        (0.22, 0.036, 0.018, 0.0),
        (0.5, 0.042, 0.017, 0.0),
        (0.78, 0.036, 0.013, 0.0),
        (1.0, 0.024, 0.010, 0.0),
    ],
    "girdle": [(0.25, 0.052, 0.052, 0.01), (0.7, 0.056, 0.056, 0.004), (1.05, 0.052, 0.052, 0.0)],
}
"""Rings along the segment; for arms, sideways is y of the rest posture and front to back its z."""

TRUNK: list[Ring] = [
    (-0.17, 0.100, 0.075, 0.006),
    (-0.08, 0.150, 0.105, 0.012),
    (0.02, 0.170, 0.120, 0.014),
    (0.12, 0.164, 0.112, 0.006),
    (0.30, 0.140, 0.097, -0.004),
    (0.42, 0.140, 0.099, -0.004),
    (0.62, 0.158, 0.114, -0.006),
    (0.80, 0.166, 0.114, 0.0),
    (0.93, 0.150, 0.094, 0.008),
    (1.03, 0.105, 0.070, 0.012),
    (1.09, 0.070, 0.060, 0.012),
]
"""Rings along the trunk from the hips' midpoint; those below `WAIST_SHARE` move with the pelvis."""
WAIST_SHARE = 0.4
NECK: list[Ring] = [(0.0, 0.060, 0.062, 0.012), (0.4, 0.056, 0.060, 0.010), (0.75, 0.056, 0.062, 0.004)]
HEAD: list[Ring] = [
    (-0.122, 0.026, 0.030, -0.052),
    (-0.100, 0.048, 0.062, -0.026),
    (-0.065, 0.062, 0.084, -0.010),
    (-0.02, 0.070, 0.094, 0.002),
    (0.03, 0.077, 0.102, 0.006),
    (0.075, 0.072, 0.096, 0.010),
    (0.105, 0.054, 0.072, 0.012),
    (0.122, 0.024, 0.034, 0.012),
]
"""Rings with the height above the head's center [m] instead of a share."""
SHOE: list[Ring] = [
    (-0.075, 0.026, 0.030, -0.042), (-0.055, 0.036, 0.046, -0.034), (0.0, 0.040, 0.060, -0.026),
    (0.06, 0.043, 0.048, -0.036), (0.12, 0.047, 0.034, -0.048), (0.165, 0.043, 0.027, -0.054),
    (0.195, 0.028, 0.020, -0.060)
]  # fmt: skip
"""Distance before the ankle, half-width sideways, half-height, height above the ankle [m]."""


@dataclass(frozen=True, eq=False)
class Part:
    """A closed stack of rings."""

    name: str
    """Kind of the part."""
    mover: str
    """Name of the joint or shoe that it moves with."""
    rings: Array
    """(R, S, 3) points in the mover's frame [m]."""


def body_parts(body: Body, girths: Mapping[str, float]) -> list[Part]:
    """All parts in their joints' frames; `girths` are factors of thickness by kind, 1 by default."""
    parts = [*_trunk_parts(body, girths.get("trunk", 1.0)), *_head_parts(body)]
    for segment in body.skeleton.segments:
        kind = segment.name.split(".")[0]
        if kind in LIMBS:
            start, end = body.local(segment.start), body.local(segment.end)
            joint = body.skeleton.joints[segment.joint].name
            parts.append(
                Part(segment.name, joint, _stack(start, end - start, LIMBS[kind], girths.get(kind, 1.0)))
            )
            if kind == "hand":
                parts.append(Part(segment.name, joint, _thumb(start, end)))
    for side in ("L", "R"):
        rings = [
            _ring(np.array([0.0, -ahead, up]), np.eye(3)[0] * wide, np.eye(3)[2] * high)
            for ahead, wide, high, up in SHOE
        ]
        parts.append(Part(f"shoe.{side}", f"shoe.{side}", np.stack(rings)))
    return parts


def part_mesh(part: Part, rotation: Array, origin: Array) -> tuple[Array, list[list[int]]]:
    """Vertices in the world and faces of a part whose mover stands at `origin` turned by `rotation`."""
    rings = part.rings
    count, sides = rings.shape[:2]
    faces = []
    for ring in range(count - 1):
        for side in range(sides):
            beside = (side + 1) % sides
            first, second = ring * sides, (ring + 1) * sides
            faces.append([first + side, first + beside, second + beside, second + side])
    faces.append(list(range(sides))[::-1])
    faces.append([(count - 1) * sides + side for side in range(sides)])
    return rings.reshape(-1, 3) @ rotation.T + origin, faces


def movers(body: Body, pose: Pose, feet: dict[str, Array]) -> dict[str, tuple[Array, Array]]:
    """World rotations (T, 3, 3) and origins (T, 3) of all joints and both shoes, by name."""
    placed = {
        joint.name: (pose.rotation[:, i], pose.origin[:, i]) for i, joint in enumerate(body.skeleton.joints)
    }
    for side, rotation in feet.items():
        placed[f"shoe.{side}"] = (rotation, body.segment_ends(pose, f"shin.{side}")[1])
    return placed


def _ring(center: Array, sideways: Array, backwards: Array) -> Array:
    angle = np.linspace(0.0, 2.0 * np.pi, SIDES_OF_RING, endpoint=False)[:, None]
    return np.asarray(center + np.cos(angle) * sideways + np.sin(angle) * backwards)


def _stack(start: Array, along: Array, rings: list[Ring], girth: float = 1.0) -> Array:
    """Rings across a segment, `girth` times as thick; its frame's x, or for arms y, is sideways."""
    arm = abs(along[0]) > abs(along[2])
    sideways, backwards = (np.eye(3)[1], np.eye(3)[2]) if arm else (np.eye(3)[0], np.eye(3)[1])
    return np.stack(
        [
            _ring(
                start + share * along + shift * backwards, girth * wide * sideways, girth * deep * backwards
            )
            for share, wide, deep, shift in _denser(rings)
        ]
    )


def _denser(rings: list[Ring]) -> Array:
    """The rings resampled at even distances, at most a few centimeters apart."""
    table = np.array(rings)
    share = np.linspace(table[0, 0], table[-1, 0], 4 * len(rings))
    columns = [np.interp(share, table[:, 0], table[:, i]) for i in range(1, 4)]
    return np.stack([share, *columns], axis=-1)


def _trunk_parts(body: Body, girth: float) -> list[Part]:
    length = body.actor.segments_m["trunk"]
    up = np.array([0.0, 0.0, length])
    waist = body.offsets[body.skeleton.joint_index("waist")]
    lower = [ring for ring in TRUNK if ring[0] <= WAIST_SHARE + 0.05]
    upper = [ring for ring in TRUNK if ring[0] >= WAIST_SHARE - 0.12]
    return [
        Part("pelvis", "pelvis", _stack(np.zeros(3), up, lower, girth)),
        Part("chest", "waist", _stack(-waist, up, upper, girth)),
    ]


def _head_parts(body: Body) -> list[Part]:
    length = body.actor.segments_m["neck_head"]
    up = np.array([0.0, 0.0, length])
    centimeter = np.array([0.0, 0.0, 1.0])
    nose = [(-0.035, 0.017, 0.016, -0.094), (-0.028, 0.018, 0.022, -0.096), (0.012, 0.010, 0.012, -0.094)]
    parts = [
        Part("neck", "neck", _stack(np.zeros(3), up, NECK)),
        Part("head", "neck", _stack(up, centimeter, HEAD)),
        Part("head", "neck", _stack(up, centimeter, nose)),
    ]
    for side in (-1.0, 1.0):
        ear = [(-0.030, 0.008, 0.010, 0.012), (0.0, 0.012, 0.018, 0.014), (0.030, 0.009, 0.012, 0.018)]
        parts.append(Part("head", "neck", _stack(up + np.array([0.076 * side, 0.0, 0.0]), centimeter, ear)))
    return parts


def _thumb(start: Array, end: Array) -> Array:
    along = end - start
    forward = np.array([0.0, -1.0, 0.0])
    rings = [
        _ring(start + share * along + out * forward, width * np.array([0.0, 1.0, 0.0]), width * np.eye(3)[2])
        for share, out, width in ((0.15, 0.015, 0.016), (0.35, 0.042, 0.014), (0.55, 0.058, 0.010))
    ]
    return np.stack(rings)
