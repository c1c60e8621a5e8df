"""Places on a body that carry over to another: by the part they are near, in that part's own proportions.

A point near a part is described in the part's frame, in shares of the part's own width, depth and length.
On a wider body the hand on the hip is so much farther out.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...body.body_volume import segment_piece
from ...body.segment_motion import SegmentMotion
from ...body.skeleton import SIDES
from .rest_body import RestBody
from .stage import Stage

HEAD_HEIGHT = 0.10
"""From the head's joint to the crown, as a share of stature."""
HEAD_CENTER = 0.5
"""Place of the head's center between its joint and the crown."""
LEG_SHARE = 0.491
"""The legs' share of stature (Drillis & Contini 1966)."""
PROPORTION_RANGE = (0.5, 2.5)
"""Range of a width over what the character's size alone would give."""


@dataclass(frozen=True, eq=False)
class PartShape:
    """A part of the character as a place for hands."""

    segment: str
    """The performer's segment."""
    bone: int
    """Index of the character's bone that it is fixed to."""
    origin: Array
    """(3,) its origin from that bone's joint at rest, canonical [m]."""
    scale: Array
    """(3,) the character's width, depth and length over the performer's, in the segment's axes."""


def part_shapes(body: RestBody, source: SegmentMotion, size: float) -> tuple[PartShape, ...]:
    """The parts of a character that hands may be near: head, chest, pelvis and legs."""
    lengths = source.body.actor.segments_m
    trunk = float(np.linalg.norm(body.shoulder_joints - body.hip_joints)) / lengths["trunk"]
    shoulders = _width_m(body, "upper_arm") / lengths["shoulder_width"]
    hips = _width_m(body, "thigh") / lengths["hip_width"]
    shoulders, hips = (
        float(np.clip(ratio, *np.multiply(PROPORTION_RANGE, size))) for ratio in (shoulders, hips)
    )
    chest = body.last.get("spine", 0)
    parts = [
        _part(body, "pelvis", 0, body.hip_joints, (hips, np.sqrt(hips * size), trunk)),
        _part(body, "chest", chest, body.shoulder_joints, (shoulders, np.sqrt(shoulders * trunk), trunk)),
    ]
    if "head" in body.first:
        joint, tip = body.joint("head"), body.tip("head")
        height = HEAD_HEIGHT * body.leg_m / LEG_SHARE
        if tip is not None and tip[2] - joint[2] > 0.5 * height:
            height = float(tip[2] - joint[2])
        ratio = height / (HEAD_HEIGHT * source.body.actor.stature_m)
        center = joint + [0.0, 0.0, HEAD_CENTER * height]
        parts.append(_part(body, "head", body.first["head"], center, (ratio, ratio, ratio)))
    for side in SIDES:
        for name, below in (("thigh", "shin"), ("shin", "foot")):
            role = f"{name}.{side}"
            ratio = body.length_m(role, f"{below}.{side}") / lengths[role]
            parts.append(_part(body, role, body.first[role], body.joint(role), (size, size, ratio)))
    return tuple(parts)


def source_origin(source: SegmentMotion, segment: str) -> Array:
    """(F, 3) the origin of a performer's part in the world [m]."""
    if segment == "head":
        return source.end["head"]
    if segment == "chest":
        return source.end["chest"]
    return source.start[segment]


def in_segment(source: SegmentMotion, segment: str, points: Array) -> Array:
    """(F, 3) points of the world in the axes of a performer's segment, from its origin [m]."""
    local = points - source_origin(source, segment)
    return np.asarray((np.swapaxes(source.turn[segment], -1, -2) @ local[..., None])[..., 0])


def places_by_part(
    parts: Sequence[PartShape],
    source: SegmentMotion,
    stage: Stage,
    places: Sequence[Array],
    turns: Sequence[Array],
    alignment: Mapping[int, Array],
    points: Array,
) -> Array:
    """(K, F, 3) where points near the performer belong on the character, by each of K parts, canonical [m].

    Args:
        parts: The parts.
        source: The performer's motion.
        stage: Where the character performs.
        places: (F, 3) the joint of each of the character's bones [m].
        turns: (F, 3, 3) turn of each bone from its rest.
        alignment: (3, 3) by bone: the turn from the character's rest to the performer's.
        points: (F, 3) in the world [m].
    """
    found = []
    for part in parts:
        inside = in_segment(source, part.segment, points)
        turn = turns[part.bone] @ alignment[part.bone].T
        origin = places[part.bone] + turns[part.bone] @ part.origin
        found.append(origin + (turn @ (part.scale * inside)[..., None])[..., 0])
    return np.stack(found)


def distances_m(source: SegmentMotion, segment: str, points: Array) -> Array:
    """(F,) distance of points (F, 3) from the surface of one of the performer's segments; 0 inside [m]."""
    piece = segment_piece(source.body, segment)
    start, axis = _piece_axis(source, segment)
    way = points - start
    length = np.linalg.norm(axis, axis=-1)
    along = np.sum(way * axis, axis=-1) / length
    share = np.clip(along / length, 0.0, 1.0)
    overhang = along - share * length
    turn = source.turn[segment]
    sideways = [np.sum(way * (turn @ direction), axis=-1) for direction in (piece.lateral, piece.sagittal)]
    widths = piece.half_widths[0] + share[:, None] * (piece.half_widths[1] - piece.half_widths[0])
    radius = np.hypot(sideways[0], sideways[1])
    relative = np.hypot(sideways[0] / widths[:, 0], sideways[1] / widths[:, 1])
    outside = radius * np.maximum(1.0 - 1.0 / np.maximum(relative, 1e-9), 0.0)
    return np.hypot(outside, overhang)


def _piece_axis(source: SegmentMotion, segment: str) -> tuple[Array, Array]:
    """Start and axis (F, 3) of a segment's volume in the world [m]."""
    piece = segment_piece(source.body, segment)
    own = next(each for each in source.body.skeleton.segments if each.name == segment)
    turn = source.turn[segment]
    start = source.start[segment] + turn @ (piece.start - source.body.local(own.start))
    return start, turn @ (piece.end - piece.start)


def _part(
    body: RestBody, segment: str, bone: int, origin: Array, scale: tuple[float, float, float]
) -> PartShape:
    return PartShape(segment, bone, origin - body.bones[bone].head, np.array(scale))


def _width_m(body: RestBody, part: str) -> float:
    return float(np.linalg.norm(body.joint(f"{part}.L") - body.joint(f"{part}.R")))
