"""The body's volume: tapered cylinders of elliptical cross-section along the segments.

Half-widths are shares of stature, rounded from the averages of adults' breadths, depths and
circumferences (Gordon et al. 2014, *2012 Anthropometric Survey of U.S. Army Personnel*, NATICK/TR-15/007).
The calibration starts from them and corrects them by the footage.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ..arrays import Array, IndexArray
from . import rotations
from .human import HUMAN
from .kinematics import Body, Pose
from .posture import Posture, headings_rad, yaw_rotation
from .skeleton import SIDES, Segment, Skeleton

# Half-widths (lateral, sagittal) at a segment's start and end, as shares of stature.
HALF_WIDTHS: dict[str, tuple[tuple[float, float], tuple[float, float]]] = {
    "pelvis": ((0.100, 0.068), (0.086, 0.062)),
    "chest": ((0.086, 0.062), (0.098, 0.066)),
    "head": ((0.034, 0.036), (0.044, 0.056)),
    "upper_arm": ((0.030, 0.030), (0.026, 0.026)),
    "forearm": ((0.026, 0.026), (0.017, 0.017)),
    "hand": ((0.016, 0.016), (0.020, 0.012)),
    "thigh": ((0.052, 0.052), (0.034, 0.036)),
    "shin": ((0.032, 0.034), (0.021, 0.022)),
    "foot": ((0.026, 0.024), (0.028, 0.014)),
}
HEAD_OVERSHOOT = 1.40  # position of the crown along the head segment, whose end is the head's center
TRUNK = "trunk"
TRUNK_PARTS = ("pelvis", "chest")
MARKER_SEGMENTS = (TRUNK, *(one.name for one in HUMAN.segments if one.name.split(".")[0] in HALF_WIDTHS))
"""What a marker may be bound to: every segment with a volume, and the trunk as a whole."""


@dataclass(frozen=True, eq=False)
class Piece:
    """A tapered elliptical cylinder fixed in a joint's frame."""

    segment: str
    joint: int
    start: Array  # (3,) center of the first end in the joint's frame [m]
    end: Array  # (3,) center of the other end [m]
    lateral: Array  # (3,) unit direction of the first half-width, across the axis
    sagittal: Array  # (3,) unit direction of the second half-width
    half_widths: Array  # (2, 2) at start and end: lateral and sagittal half-width [m]

    def cut(self, first: float, last: float) -> "Piece":
        """The part between two fractions of the length; fractions outside 0 to 1 extend it."""
        along = self.end - self.start
        widths = self.half_widths[0] + np.outer([first, last], self.half_widths[1] - self.half_widths[0])
        return replace(
            self,
            start=self.start + first * along,
            end=self.start + last * along,
            half_widths=np.maximum(widths, 0.2 * self.half_widths.min()),
        )

    def changed(self, offset: Array, girth: float) -> "Piece":
        """The piece moved by `offset` (3,) [m] in its joint's frame and made `girth` times as thick."""
        return replace(
            self,
            start=self.start + offset,
            end=self.end + offset,
            half_widths=self.half_widths * girth,
        )

    def rings(self, sides: int, cap: int, shaft: int) -> Array:
        """(2 * cap + shaft + 1, sides, 3) rings around the piece, which half ellipsoids close [m].

        A half ellipsoid has `cap` bands and is as deep as the narrower half-width; the shaft has `shaft`.
        """
        along = self.end - self.start
        axis = along / np.linalg.norm(along)
        rise = np.linspace(0.0, 0.5 * np.pi, cap + 1)
        share = np.concatenate([np.zeros(cap), np.linspace(0.0, 1.0, shaft + 1), np.ones(cap)])
        beyond = np.concatenate([-np.sin(rise[:0:-1]), np.zeros(shaft + 1), np.sin(rise[1:])])
        widths = self.half_widths[0] + share[:, None] * (self.half_widths[1] - self.half_widths[0])
        center = self.start + share[:, None] * along + (beyond * widths.min(axis=1))[:, None] * axis
        # The pole keeps a tiny ring, so that every band is made of quads.
        around = np.maximum(np.sqrt(1.0 - beyond**2), 1e-3)[:, None] * widths
        angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)[:, None]
        spokes = [
            wide * np.cos(angle) * self.lateral + deep * np.sin(angle) * self.sagittal
            for wide, deep in around
        ]
        return np.asarray(center[:, None] + np.stack(spokes))


def ring_quads(rings: int, sides: int) -> IndexArray:
    """(rings - 1, sides, 4) corners of the bands between neighboring rings, counterclockwise from outside."""
    ring = np.arange(rings - 1)[:, None] * sides
    side = np.arange(sides)[None, :]
    following = (side + 1) % sides
    return np.stack([ring + side, ring + following, ring + sides + following, ring + sides + side], axis=-1)


@dataclass(frozen=True, eq=False)
class PieceStack:
    """Several pieces as stacked arrays, for vectorized projection."""

    segments: tuple[str, ...]
    joint: IndexArray  # (Q,) the joint each piece is fixed to
    start: Array  # (Q, 3), like the other fields of `Piece` stacked
    end: Array
    lateral: Array
    sagittal: Array
    half_widths: Array  # (Q, 2, 2)

    @classmethod
    def of(cls, pieces: Iterable[Piece]) -> "PieceStack":
        """Stack pieces in order."""
        listed = list(pieces)
        names = ("start", "end", "lateral", "sagittal", "half_widths")
        return cls(
            tuple(piece.segment for piece in listed),
            np.array([piece.joint for piece in listed], dtype=np.intp),
            *(np.stack([getattr(piece, name) for piece in listed]) for name in names),
        )

    def place(self, pose: Pose, local: Array) -> Array:
        """World positions (F, Q, 3) of one point (Q, 3) a piece."""
        return np.asarray(pose.origin[:, self.joint] + self.turn(pose, local))

    def turn(self, pose: Pose, direction: Array) -> Array:
        """World directions (F, Q, 3) of one direction (Q, 3) a piece."""
        return np.asarray((pose.rotation[:, self.joint] @ direction[..., None])[..., 0])


@lru_cache(maxsize=256)
def segment_piece(body: Body, name: str) -> Piece:
    """The volume of one of the skeleton's segments, kept once made; KeyError for one without."""
    segment = body.skeleton.segment(name)
    start, end = body.local(segment.start), body.local(segment.end)
    if name == "head":
        end = start + HEAD_OVERSHOOT * (end - start)
    axis = (end - start) / np.linalg.norm(end - start)
    # Lateral is the body's x where the axis is not along it, else its y.
    reference = np.array([0.0, 1.0, 0.0]) if abs(axis[0]) > 0.7 else np.array([1.0, 0.0, 0.0])
    across: Array = reference - np.dot(reference, axis) * axis
    lateral: Array = across / np.linalg.norm(across)
    widths = np.array(HALF_WIDTHS[name.split(".")[0]]) * body.actor.stature_m
    return Piece(name, segment.joint, start, end, lateral, rotations.cross_matrix(axis) @ lateral, widths)


def body_pieces(body: Body) -> tuple[Piece, ...]:
    """The volume of the whole body, one piece a segment."""
    return tuple(
        segment_piece(body, segment.name)
        for segment in body.skeleton.segments
        if segment.name.split(".")[0] in HALF_WIDTHS
    )


def marker_parts(segment: str) -> tuple[str, ...]:
    """Segments covered by a marker that is bound to `segment`."""
    return TRUNK_PARTS if segment == TRUNK else (segment,)


# --- Soles


HEEL_BEHIND = 0.32
"""From the ankle, as a share of the length from ankle to tip: about a quarter of a foot lies behind the ankle
(Winter 2009, *Biomechanics and Motor Control of Human Movement*)."""


def sole_offsets(body: Body) -> Array:
    """(2, 2, 3) heel and tip of the left and the right foot from its ankle, in the foot's frame [m]."""
    feet = [body.skeleton.segment(f"foot.{side}") for side in SIDES]
    return np.stack([_sole(body, foot) - body.local(foot.start) for foot in feet])


def sole_places(body: Body, pose: Pose) -> Array:
    """World positions (..., 2, 2, 3) of heel and tip of the left and the right foot [m]."""
    feet = []
    for foot in (body.skeleton.segment(f"foot.{side}") for side in SIDES):
        feet.append(np.stack([pose.place(foot.joint, place) for place in _sole(body, foot)], axis=-2))
    return np.stack(feet, axis=-3)


def _sole(body: Body, foot: Segment) -> Array:
    """(2, 3) heel and tip in the joint's frame, the foot rigid with its shin [m]."""
    ankle, tip = body.local(foot.start), body.local(foot.end)
    behind = HEEL_BEHIND * body.actor.segments_m[foot.name]
    return np.array([[tip[0], ankle[1] + behind, tip[2]], tip])


def sole_heights_m(body: Body, pose: Pose) -> Array:
    """(..., 2) height of the lowest point of the left and the right sole [m]."""
    return np.asarray(sole_places(body, pose)[..., 2].min(axis=-1))


def lower_sole_m(body: Body, posture: Posture) -> Array:
    """(...,) height of the lower sole [m]."""
    return np.asarray(sole_heights_m(body, body.pose(posture)).min(axis=-1))


# --- The default posture


LIMB_ROOTS = {"arm": "shoulder", "leg": "hip"}
"""The joint that a limb hangs on, without its side."""
ARMS_LOWERED_RAD = float(np.radians(75.0))  # less than a right angle: sleeves keep arms off the trunk


def standing_posture(
    body: Body,
    place: Array | None = None,
    heading_rad: float = 0.0,
    arms_lowered_rad: float = ARMS_LOWERED_RAD,
) -> Posture:
    """A posture of the default skeleton that stands upright on the ground.

    `place` (3,) is the point between the feet [m], by default the world's origin, `heading_rad` the turn from
    facing -Y, `arms_lowered_rad` the angle of the arms below the horizontal.
    """
    skeleton = body.skeleton
    values = {"pelvis.rotation_z": heading_rad}
    for side, out in zip(SIDES, (1.0, -1.0), strict=True):
        values[f"shoulder.{side}.rotation_y"] = out * arms_lowered_rad
        values[f"elbow.{side}.flexion"] = np.radians(10.0)
    vector = np.array([values.get(name, 0.0) for name in skeleton.dof_names])
    vector[:3] = np.zeros(3) if place is None else place
    vector[2] += hip_height_m(body)
    return Posture.from_vector(skeleton, vector)


def limb_dofs(skeleton: Skeleton, limb: str) -> IndexArray:
    """Degrees of freedom of a limb, `arm.L` ... `leg.R`."""
    kind, _, side = limb.partition(".")
    first = skeleton.dof_starts[skeleton.joint_index(f"{LIMB_ROOTS[kind]}.{side}")]
    return next(part for part in skeleton.limbs if first in part)


def rested(body: Body, posture: Posture, limbs: tuple[str, ...]) -> Posture:
    """The postures (F,) with some limbs as one who stands at ease has them: legs hang straight down."""
    if not limbs:
        return posture
    skeleton, ease = posture.skeleton, standing_posture(body)
    own = np.concatenate([limb_dofs(skeleton, limb) for limb in limbs])
    balls, hinges = np.isin(skeleton.ball_dofs[:, 0], own), np.isin(skeleton.hinge_dofs, own)
    turns = np.where(balls[:, None, None], ease.rotations, posture.rotations)
    angles = np.where(hinges, ease.angles, posture.angles)
    upright = np.swapaxes(posture.rotations[..., 0, :, :], -1, -2) @ yaw_rotation(headings_rad(posture))
    names = [skeleton.joints[joint].name for joint in skeleton.ball_joints]
    for limb in limbs:
        if limb.startswith("leg"):
            turns[..., names.index(f"hip.{limb[-1]}"), :, :] = upright
    return Posture(skeleton, posture.translation, turns, angles)


def hip_height_m(body: Body) -> float:
    """Height of the hips' midpoint above the soles of a body that stands upright [m]."""
    pose = body.pose(Posture.rest(body.skeleton))
    ends = [body.segment_ends(pose, segment.name)[1] for segment in body.skeleton.segments]
    return -float(np.min(np.stack(ends)[:, 2]))


def standing_height_m(body: Body) -> float:
    """Height from the soles to the crown of a body that stands upright [m]."""
    lengths = body.actor.segments_m
    return hip_height_m(body) + lengths["trunk"] + HEAD_OVERSHOOT * lengths["neck_head"]
