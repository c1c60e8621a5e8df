"""Alignment of rest poses: the turn that takes each role's rest to that of the performer's body.

The performer at rest stands in a T pose. A limb of the character may rest anywhere (T, A, hanging, with bent
elbows or knees): each bone takes on the turn of the one before it and then the smallest rotation of its
direction, as if the character's arm were raised first and then stretched. So hinges keep their places on the
limb, and palms that no fingers tell of; others face as the performer's. Trunk, head, clavicles and feet are
upright in both, and are not turned.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ...arrays import Array
from ...body import rotations
from ...body.body_volume import segment_piece
from ...body.fingers import RESTING
from ...body.kinematics import SegmentMotion
from ...body.skeleton import SIDES
from ...feet.fading import ease
from ...numerics.vectors import unit
from ..character import FINGER_ROLES, LONG_BONES
from .rest_body import RestBody


def rest_alignment(body: RestBody) -> Mapping[str, Array]:
    """(3, 3) by role: the turn from the character's rest, in canonical axes, to the performer's."""
    turns = {role: np.eye(3) for role in body.first}
    for role, quaternion in body.character_map.rest_corrections.items():
        if role in turns:
            turn = Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()
            turns[role] = body.stance @ turn @ body.stance.T
    for side in SIDES:
        out = 1.0 if side == "L" else -1.0
        arm = [f"{part}.{side}" for part in ("upper_arm", "forearm", "hand")]
        leg = [f"{part}.{side}" for part in ("thigh", "shin", "foot")]
        _align(body, turns, arm, np.array([out, 0.0, 0.0]), np.array([0.0, 0.0, -out]))
        _align(body, turns, leg, np.array([0.0, 0.0, -1.0]), np.array([1.0, 0.0, 0.0]))
        hand = f"hand.{side}"
        if hand in turns:
            palm = None if hand in body.character_map.rest_corrections else body.palm(side)
            aligned = turns[f"forearm.{side}"] @ turns[hand]
            turns[hand] = aligned if palm is None else RESTING[side] @ palm.T
    return turns


def _align(body: RestBody, turns: dict[str, Array], limb: list[str], along: Array, hinge: Array) -> None:
    """Align a limb's two long bones: `along` and `hinge` are its direction and axis in the T pose."""
    upper, lower, end = limb
    middle = body.joint(lower)
    first = unit(middle - body.joint(upper))
    tip = body.joint(end) if end in body.first else body.tip(lower)
    second = first if tip is None else unit(tip - middle)
    turn = rotations.smallest(turns[upper] @ first, along) @ turns[upper]
    # A twist about the limb lets its resting bend turn about the hinge; none where it hardly bends.
    axis = rotations.cross(turn @ first, turn @ second)
    bend = float(np.arctan2(np.linalg.norm(axis), first @ second))
    axis = unit(axis)
    twist = float(np.arctan2(rotations.cross(axis, hinge) @ along, axis @ hinge))
    # Bends from which the plane of an elbow or knee begins to count, and counts in full; one that is farther
    # than the last from the hinge's own direction says nothing of it.
    begins, clear, astray = np.radians([12.0, 30.0, 75.0])
    share = float(ease(np.array(bend), begins, clear)) * float(abs(twist) < astray)
    turn = rotations.hinge(along, np.array(share * twist)) @ turn
    turns[upper] = turn
    bent = turn @ turns[lower] @ second
    turns[lower] = rotations.smallest(bent, along) @ turn @ turns[lower]


FOLLOWED = {"hips": "pelvis", "shoulder": "girdle", "toe": "foot"}  # segments of other names


def bone_turns(body: RestBody, turn: Mapping[str, Array], alignment: Mapping[str, Array]) -> list[Array]:
    """(F, 3, 3) a bone: its turn from the character's rest, in canonical axes.

    The performer's segments are turned (F, 3, 3) on the character's stage; the alignment is (3, 3) by role.
    """
    found: list[Array] = []
    chest = turn["chest" if body.is_moved("spine") else "pelvis"]
    for bone in body.bones:
        if not body.is_moved(bone.role) or bone.role in FINGER_ROLES:
            still = np.broadcast_to(np.eye(3), chest.shape)
            found.append(found[bone.carrier] if bone.carrier >= 0 else still)
            continue
        if bone.role in ("spine", "neck"):
            lower, upper = (turn["pelvis"], turn["chest"]) if bone.role == "spine" else (chest, turn["head"])
            share = body.character_map.shares(bone.role)[bone.number]
            turn_up = rotations.logarithm(np.swapaxes(lower, -1, -2) @ upper)
            wanted = lower @ rotations.exponential(share * turn_up)
        else:
            part, dot, side = bone.role.partition(".")
            wanted = turn[FOLLOWED.get(part, part) + dot + side]
        found.append(np.asarray(wanted @ alignment[bone.role]))
    return found


def joint_places(body: RestBody, turns: list[Array]) -> list[Array]:
    """(F, 3) a bone: its joint relative to the midpoint of the hip joints [m]."""
    places: list[Array] = []
    for bone in body.bones:
        if bone.carrier < 0:
            places.append(np.zeros((len(turns[0]), 3)))
        else:
            offset = bone.head - body.bones[bone.carrier].head
            places.append(places[bone.carrier] + turns[bone.carrier] @ offset)
    middle = 0.5 * (places[body.first["thigh.L"]] + places[body.first["thigh.R"]])
    return [place - middle for place in places]


# --- Places on a body that carry over to another


@dataclass(frozen=True, eq=False)
class PartShape:
    """A part of the character as a place for hands."""

    segment: str  # the performer's segment
    bone: int  # index of the character's bone that it is fixed to
    origin: Array  # (3,) its origin from that bone's joint at rest, canonical [m]
    scale: Array  # (3,) the character's width, depth and length over the performer's, in the segment's axes
    to_rest: Array  # (3, 3) from those axes to the bone's rest, canonical

    def place(self, source: SegmentMotion, points: Array, joint: Array, turn: Array) -> Array:
        """(F, 3) where world points (F, 3) near the performer belong on the character, by this part [m].

        Canonical are the joint (F, 3) of its bone and the bone's turn from rest (F, 3, 3).
        """
        inside = self.scale * in_segment(source, self.segment, points)
        return np.asarray(joint + (turn @ (self.origin + inside @ self.to_rest.T)[..., None])[..., 0])


def part_shapes(
    body: RestBody, source: SegmentMotion, size: float, alignment: Mapping[str, Array]
) -> tuple[PartShape, ...]:
    """The parts of a character that hands may be near: head, chest, pelvis and legs."""
    lengths = source.body.actor.segments_m
    hip, shoulder = body.middle("thigh"), body.middle("upper_arm")
    trunk = float(np.linalg.norm(shoulder - hip)) / lengths["trunk"]
    hips, shoulders = (
        float(np.linalg.norm(body.joint(f"{part}.L") - body.joint(f"{part}.R"))) / lengths[width]
        for part, width in (("thigh", "hip_width"), ("upper_arm", "shoulder_width"))
    )
    # Range of a width over what the character's size alone would give.
    hips, shoulders = np.clip([hips, shoulders], 0.5 * size, 2.5 * size)
    chest = body.last.get("spine", 0)
    wanted = [
        ("pelvis", 0, hip, (hips, np.sqrt(hips * size), trunk)),
        ("chest", chest, shoulder, (shoulders, np.sqrt(shoulders * trunk), trunk)),
    ]
    if "head" in body.first:
        joint, tip = body.joint("head"), body.tip("head")
        # Crown over the head's joint and legs, as shares of stature (the latter Drillis & Contini 1966).
        height = 0.10 * body.leg_m / 0.491
        if tip is not None and tip[2] - joint[2] > 0.5 * height:
            height = float(tip[2] - joint[2])
        ratio = height / (0.10 * source.body.actor.stature_m)
        wanted.append(("head", body.first["head"], joint + [0.0, 0.0, 0.5 * height], (ratio, ratio, ratio)))
    for role, below in (ends for side in SIDES for ends in LONG_BONES[f"leg.{side}"]):
        ratio = body.length_m(role, below) / lengths[role]
        wanted.append((role, body.first[role], body.joint(role), (size, size, ratio)))
    parts = []
    for segment, bone, origin, scale in wanted:
        own = body.bones[bone]
        to_rest = alignment[own.role].T if body.is_moved(own.role) else np.eye(3)
        parts.append(PartShape(segment, bone, origin - own.head, np.array(scale), to_rest))
    return tuple(parts)


def in_segment(source: SegmentMotion, segment: str, points: Array) -> Array:
    """(F, 3) points of the world in the axes of a performer's segment, from its origin [m]."""
    origin = source.end[segment] if segment in ("head", "chest") else source.start[segment]
    return np.asarray((np.swapaxes(source.turn[segment], -1, -2) @ (points - origin)[..., None])[..., 0])


def distances_m(source: SegmentMotion, segment: str, points: Array) -> Array:
    """(F,) distance of points (F, 3) from the surface of one of the performer's segments; 0 inside [m]."""
    piece, turn = segment_piece(source.body, segment), source.turn[segment]
    own = next(each for each in source.body.skeleton.segments if each.name == segment)
    start = source.start[segment] + turn @ (piece.start - source.body.local(own.start))
    axis = turn @ (piece.end - piece.start)
    way = points - start
    length = np.linalg.norm(axis, axis=-1)
    along = np.sum(way * axis, axis=-1) / length
    share = np.clip(along / length, 0.0, 1.0)
    overhang = along - share * length
    sideways = [np.sum(way * (turn @ direction), axis=-1) for direction in (piece.lateral, piece.sagittal)]
    widths = piece.half_widths[0] + share[:, None] * (piece.half_widths[1] - piece.half_widths[0])
    radius = np.hypot(sideways[0], sideways[1])
    relative = np.hypot(sideways[0] / widths[:, 0], sideways[1] / widths[:, 1])
    outside = radius * np.maximum(1.0 - 1.0 / np.maximum(relative, 1e-9), 0.0)
    return np.hypot(outside, overhang)
