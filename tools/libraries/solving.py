"""Postures of the body from moments: joints from angles, limbs that reach for positions.

The skeleton's foot is rigid with its shin; a person's is not. Heights are those of a person: the sole's heel
or ball is on the floor, and the foot as drawn with the skeleton may reach a little below.
"""

from functools import lru_cache

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.body.rotations import hinge
from studio.limbs import MIRROR, STRAIGHTEST, X, Y, Z, arm_rotations, leg_rotations, turned

from .moment import SIDES, Ankle, Arm, Foot, Leg, Moment

BODY = Body(Actor.from_stature(1.75))
"""The body on which the libraries are posed."""
STRETCHED = 0.98
"""Effortless reach as a share of an arm's length."""
HEEL, BALL = (0.0, 0.29, -0.36), (0.0, -0.66, -0.36)
"""Points of the sole relative to the ankle, in lengths of the foot; the skeleton's own foot ends at
(0, -0.93, -0.36)."""


def posture_of(moment: Moment, body: Body = BODY) -> Posture:
    """The posture of a moment.

    Raises:
        ValueError: A hand or a foot is out of reach.
    """
    pelvis = pelvis_rotation(moment)
    hips = np.array([moment.x, moment.y, hips_height(moment, body)])
    rotations = {"pelvis": pelvis}
    for name, turn in (("waist", moment.waist), ("neck", moment.neck)):
        rotations[name] = _turn(turn.turn, turn.bow, turn.lean)
    angles: dict[str, float] = {}
    for side in SIDES:
        leg, knee = _leg(side, moment, hips, pelvis, body)
        rotations[f"hip.{side}"], angles[f"knee.{side}"] = leg, knee
        _place_arm(side, moment, hips, rotations, angles, body)
    skeleton = body.skeleton
    return Posture(
        skeleton,
        hips,
        np.stack([rotations[skeleton.joints[i].name] for i in skeleton.ball_joints]),
        np.array([angles.get(skeleton.joints[i].name, 0.0) for i in skeleton.hinge_joints]),
    )


def hips_height(moment: Moment, body: Body = BODY) -> float:
    """Height of the hips' midpoint [m]: the moment's own, or the one its legs determine.

    Raises:
        ValueError: A foot is out of reach.
    """
    pelvis = pelvis_rotation(moment)
    if moment.height is not None:
        return moment.height
    here = np.array([moment.x, moment.y, 0.0])
    placed = {side: leg for side, leg in moment.legs.items() if isinstance(leg, Foot | Ankle)}
    if not placed:
        return moment.lift - min(
            lowest_sole(side, leg, here, pelvis, body) for side, leg in moment.legs.items()
        )
    heights = []
    for side, leg in placed.items():
        thigh, shin = (body.actor.segments_m[f"{part}.{side}"] for part in ("thigh", "shin"))
        longest = thigh**2 + shin**2 + 2.0 * thigh * shin * np.cos(np.radians(moment.bend))
        longest = min(longest, (0.9999 * STRAIGHTEST * (thigh + shin)) ** 2)
        away = ankle_of(leg, body) - (here + pelvis @ _hip_place(side, body))
        if away[0] ** 2 + away[1] ** 2 > longest:
            raise ValueError(f"foot {side} is out of reach")
        heights.append(away[2] + np.sqrt(longest - away[0] ** 2 - away[1] ** 2))
    return float(min(heights))


def ankle_of(foot: Foot | Ankle, body: Body = BODY) -> Array:
    """(3,) ankle of a foot with a position [m]: it rolls about the heel or the ball."""
    if isinstance(foot, Ankle):
        return np.array([foot.x, foot.y, foot.z])
    pivot = _sole(BALL if foot.pitch > 0.0 else HEEL, body)
    flat = np.array([foot.x, foot.y, foot.height - pivot[2]])
    return np.asarray(flat + _turn(foot.turn) @ pivot - _turn(foot.turn, foot.pitch) @ pivot)


def swinging_ankle(side: str, leg: Leg, hips: Array, pelvis: Array, body: Body = BODY) -> tuple[Array, Array]:
    """Ankle (3,) of a leg by angles [m], and the foot's rotation (3, 3)."""
    hip, knee = _leg_angles(side, leg)
    lengths = body.actor.segments_m
    shin = hinge(X, np.asarray(knee))
    reach = hip @ (-lengths[f"thigh.{side}"] * Z - shin @ (lengths[f"shin.{side}"] * Z))
    ankle = hips + pelvis @ (_hip_place(side, body) + reach)
    return ankle, pelvis @ hip @ shin @ hinge(X, np.asarray(np.radians(leg.ankle)))


def lowest_sole(side: str, limb: Leg | Foot | Ankle, hips: Array, pelvis: Array, body: Body = BODY) -> float:
    """Height of the lowest point of a sole [m]; for an ankle with a position, that of a level foot."""
    if isinstance(limb, Foot):
        return limb.height
    if isinstance(limb, Ankle):
        return float(limb.z + _sole(BALL, body)[2])
    ankle, foot = swinging_ankle(side, limb, hips, pelvis, body)
    return float(ankle[2] + min((foot @ _sole(place, body))[2] for place in (HEEL, BALL)))


def pelvis_rotation(moment: Moment) -> Array:
    """(3, 3) rotation of the pelvis in the world."""
    return _turn(moment.pelvis.turn, moment.pelvis.bow, moment.pelvis.lean)


@lru_cache(maxsize=4096)  # a moment is solved a dozen times with the same turns while its hips are moved
def _turn(yaw: float, pitch: float = 0.0, roll: float = 0.0) -> Array:
    """(3, 3) read-only rotation by angles [degrees]."""
    rotation = turned(np.array(yaw), np.array(pitch), np.array(roll))
    rotation.setflags(write=False)
    return rotation


def _sole(place: tuple[float, float, float], body: Body) -> Array:
    return body.actor.segments_m["foot.L"] * np.array(place)


def _hip_place(side: str, body: Body) -> Array:
    return 0.5 * body.actor.segments_m["hip_width"] * (X if side == "L" else -X)


def _leg_angles(side: str, leg: Leg) -> tuple[Array, float]:
    """Hip rotation (3, 3) and the knee's flexion [rad]."""
    flexed = hinge(X, np.asarray(-np.radians(leg.flexion)))
    left = (
        flexed
        @ hinge(Y, np.asarray(-np.radians(leg.abduction)))
        @ hinge(Z, np.asarray(np.radians(leg.rotation)))
    )
    return left if side == "L" else MIRROR @ left @ MIRROR, float(np.radians(leg.knee))


def _leg(side: str, moment: Moment, hips: Array, pelvis: Array, body: Body) -> tuple[Array, float]:
    """Hip rotation (3, 3) and the knee's flexion [rad]."""
    leg = moment.legs[side]
    if isinstance(leg, Leg):
        return _leg_angles(side, leg)
    ankle = ankle_of(leg, body)
    hip, knee = leg_rotations(body, side, hips[None], pelvis[None], ankle[None], _turn(leg.turn)[None])
    return hip[0], float(knee[0])


def _place_arm(
    side: str, moment: Moment, hips: Array, rotations: dict[str, Array], angles: dict[str, float], body: Body
) -> None:
    arm = moment.arms[side]
    angles[f"girdle.{side}"] = np.radians(arm.girdle)
    angles[f"forearm.{side}"] = np.radians(arm.pronation)
    if isinstance(arm, Arm):
        rotations[f"shoulder.{side}"] = arm_rotations(
            side, np.array(arm.elevation), np.array(arm.plane), np.array(arm.rotation - arm.plane)
        )
        angles[f"elbow.{side}"] = np.radians(arm.elbow)
        return
    chest = rotations["pelvis"] @ rotations["waist"]
    out = 1.0 if side == "L" else -1.0
    lifted = chest @ hinge(-out * Y, np.asarray(np.radians(arm.girdle)))
    lengths = body.actor.segments_m
    offsets = {joint.name: body.offsets[i] for i, joint in enumerate(body.skeleton.joints)}
    girdle = hips + rotations["pelvis"] @ offsets["waist"] + chest @ offsets[f"girdle.{side}"]
    shoulder = girdle + lifted @ offsets[f"shoulder.{side}"]
    reach = np.array([arm.x, arm.y, arm.z]) - shoulder
    distance, stretched = (
        np.linalg.norm(reach),
        STRETCHED * (lengths[f"upper_arm.{side}"] + lengths[f"forearm.{side}"]),
    )
    if stretched < distance < stretched + arm.short:
        reach *= stretched / distance
    turn, elbow = _reach(
        reach, lengths[f"upper_arm.{side}"], lengths[f"forearm.{side}"], chest, out, arm.swivel
    )
    rotations[f"shoulder.{side}"] = lifted.T @ turn
    angles[f"elbow.{side}"] = elbow


def _reach(
    reach: Array, upper: float, lower: float, chest: Array, out: float, swivel: float
) -> tuple[Array, float]:
    """The upper arm's rotation (3, 3) in the world and the elbow's flexion [rad] that reach for (3,) [m]."""
    distance = float(np.linalg.norm(reach))
    if distance > STRAIGHTEST * (upper + lower):
        raise ValueError(f"a hand is {distance - upper - lower:+.3f} m beyond its arm's length")
    along = reach / distance
    aside = np.radians(swivel)
    hint = chest @ np.array([out * np.sin(aside), 0.3 * np.cos(aside), -np.cos(aside)])
    hint -= along * (hint @ along)
    hint /= np.linalg.norm(hint)
    at_shoulder = np.arccos((upper**2 + distance**2 - lower**2) / (2.0 * upper * distance))
    elbow = np.arccos((upper**2 + lower**2 - distance**2) / (2.0 * upper * lower))
    first = along * np.cos(at_shoulder) + hint * np.sin(at_shoulder)
    bent = along - first * (along @ first)
    bent /= np.linalg.norm(bent)
    # The upper arm lies along out * x; the forearm bends toward -y.
    axes = np.stack([out * first, -bent, np.cross(out * first, -bent)], axis=-1)
    return axes, float(np.pi - elbow)
