"""One moment of a motion in clinical terms: angles in degrees, positions in meters.

A moment is posed facing -Y on the floor z = 0; left is +X. Every angle is zero for a person who stands
upright with hanging arms and straight legs.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

SIDES = ("L", "R")
OTHER = {"L": "R", "R": "L"}


@dataclass(frozen=True)
class Turn:
    """Orientation of the pelvis in the world, the chest on the pelvis, or the head on the chest [degrees]."""

    bow: float = 0.0
    """Forward; of the pelvis: its forward tilt."""
    lean: float = 0.0
    """To the performer's left; of the pelvis: its right side is up."""
    turn: float = 0.0
    """To the performer's left."""


@dataclass(frozen=True)
class Arm:
    """An arm by its angles [degrees], the shoulder's relative to the chest."""

    elevation: float = 9.0
    """Angle from hanging down: 90 is level, 180 overhead; negative is the opposite side of the same plane."""
    plane: float = 30.0
    """Plane of elevation: 0 sideways, 90 straight ahead, beyond that across the chest."""
    rotation: float = 12.0
    """Inward, about the upper arm; at 0 a hanging arm bends its elbow forward, one raised ahead upward."""
    elbow: float = 18.0
    pronation: float = 15.0
    girdle: float = 0.0
    """Elevation of the shoulder girdle."""


def swung_arm(forward: float, aside: float = 7.0, **others: float) -> Arm:
    """A hanging arm, swung forward or (negative) back, and held a little off the trunk [degrees]."""
    elevation = math.hypot(forward, aside)
    return Arm(elevation, math.degrees(math.atan2(forward, aside)), **others)


@dataclass(frozen=True)
class Hand:
    """An arm that reaches with its wrist for a position."""

    x: float
    y: float
    z: float
    """Position of the wrist [m]."""
    swivel: float = 30.0
    """Outward turn of the elbow from hanging below the line to the hand [degrees]."""
    pronation: float = 15.0
    girdle: float = 0.0
    short: float = 0.0
    """Largest distance of the wrist from the position where the arm is too short for it [m]."""


@dataclass(frozen=True)
class Leg:
    """A leg by its angles [degrees], the hip's in the order of Grood and Suntay (1983)."""

    flexion: float = 0.0
    abduction: float = 0.0
    rotation: float = 0.0
    """Outward rotation of the toes."""
    knee: float = 0.0
    ankle: float = 0.0
    """Plantar flexion; no degree of freedom of the body, but it determines the height of the sole."""


@dataclass(frozen=True)
class Foot:
    """A leg that puts its foot at a position. The foot rolls on its heel or its ball and does not slide."""

    x: float
    y: float
    """Position of the ankle over the floor while the sole is flat [m]."""
    turn: float = 0.0
    """Direction of toes and knee, to the left of -Y [degrees]."""
    pitch: float = 0.0
    """Roll of the foot [degrees]: positive on the ball, toes down; negative on the heel, toes up."""
    height: float = 0.0
    """Height of the lowest point of the sole [m]."""


@dataclass(frozen=True)
class Ankle:
    """A leg that takes its ankle to a position."""

    x: float
    y: float
    z: float
    """Position of the ankle [m]."""
    turn: float = 0.0
    """Direction of the knee, to the left of -Y [degrees]."""


AnyArm = Arm | Hand
AnyLeg = Leg | Foot | Ankle


@dataclass(frozen=True)
class Moment:
    """A whole body at one moment."""

    x: float = 0.0
    y: float = 0.0
    """Position of the hips' midpoint over the floor [m]."""
    height: float | None = None
    """Height of the hips' midpoint [m]. None: as high as legs with a position reach, knees bent by `bend`;
    where both legs have angles, so that the lower sole is `lift` above the floor."""
    bend: float = 6.0
    """Least flexion of the knees of legs with a position [degrees], where they determine the height."""
    lift: float = 0.0
    """Height of the lower sole [m], where the legs' angles determine the height."""
    pelvis: Turn = Turn()
    waist: Turn = Turn()
    neck: Turn = Turn()
    arms: Mapping[str, AnyArm] = field(default_factory=lambda: {"L": Arm(), "R": Arm()})
    legs: Mapping[str, AnyLeg] = field(default_factory=lambda: {"L": Leg(), "R": Leg()})


def moment(
    *,
    left_arm: AnyArm | None = None,
    right_arm: AnyArm | None = None,
    arms: AnyArm | None = None,
    left_leg: AnyLeg | None = None,
    right_leg: AnyLeg | None = None,
    legs: AnyLeg | None = None,
    **others: Any,
) -> Moment:
    """A moment with limbs given by side, or both alike (`arms`, `legs`; mirrored positions on the right)."""
    both_arms, both_legs = arms or Arm(), legs or Leg()
    return Moment(
        arms={"L": left_arm or both_arms, "R": right_arm or _other_side(both_arms)},
        legs={"L": left_leg or both_legs, "R": right_leg or _other_side(both_legs)},
        **others,
    )


def mirrored(moment: Moment) -> Moment:
    """The moment with left and right exchanged."""
    return replace(
        moment,
        x=-moment.x,
        pelvis=_other_turn(moment.pelvis),
        waist=_other_turn(moment.waist),
        neck=_other_turn(moment.neck),
        arms={side: _other_side(moment.arms[OTHER[side]]) for side in SIDES},
        legs={side: _other_side(moment.legs[OTHER[side]]) for side in SIDES},
    )


def _other_turn(turn: Turn) -> Turn:
    return Turn(turn.bow, -turn.lean, -turn.turn)


def _other_side(limb: Any) -> Any:
    """The same limb of the other side: angles are defined alike for both, positions are mirrored."""
    if isinstance(limb, Hand):
        return replace(limb, x=-limb.x)
    return replace(limb, x=-limb.x, turn=-limb.turn) if isinstance(limb, Foot | Ankle) else limb
