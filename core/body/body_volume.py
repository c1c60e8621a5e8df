"""The body's volume: tapered cylinders of elliptical cross-section along the segments.

Half-widths are shares of stature, rounded from the averages of adults' breadths, depths and
circumferences (Gordon et al. 2014, *2012 Anthropometric Survey of U.S. Army Personnel*, NATICK/TR-15/007).
The calibration starts from them and corrects them by the footage.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..arrays import Array, IndexArray
from . import rotations
from .kinematics import Body, Pose

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
HEAD_OVERSHOOT = 1.40
"""Position of the crown along the head segment, whose end is the head's center."""
TRUNK = "trunk"
TRUNK_PARTS = ("pelvis", "chest")


@dataclass(frozen=True, eq=False)
class Piece:
    """A tapered elliptical cylinder fixed in a joint's frame."""

    segment: str
    joint: int
    start: Array
    """(3,) center of the first end in the joint's frame [m]."""
    end: Array
    """(3,) center of the other end [m]."""
    lateral: Array
    """(3,) unit direction of the first half-width, across the axis."""
    sagittal: Array
    """(3,) unit direction of the second half-width."""
    half_widths: Array
    """(2, 2) at start and end: lateral and sagittal half-width [m]."""

    def cut(self, first: float, last: float) -> "Piece":
        """The part between two fractions of the length; fractions outside 0 to 1 extend it."""
        along = self.end - self.start
        widths = self.half_widths[0] + np.outer([first, last], self.half_widths[1] - self.half_widths[0])
        return Piece(
            self.segment,
            self.joint,
            self.start + first * along,
            self.start + last * along,
            self.lateral,
            self.sagittal,
            np.maximum(widths, 0.2 * self.half_widths.min()),
        )

    def changed(self, offset: Array, girth: float) -> "Piece":
        """The piece moved by `offset` (3,) [m] in its joint's frame and made `girth` times as thick."""
        return Piece(
            self.segment,
            self.joint,
            self.start + offset,
            self.end + offset,
            self.lateral,
            self.sagittal,
            self.half_widths * girth,
        )

    def rings(self, sides: int, cap: int, shaft: int) -> Array:
        """(2 * cap + shaft + 1, sides, 3) rings around the piece, which half ellipsoids close [m].

        Args:
            sides: Corners of a ring.
            cap: Bands of a half ellipsoid, which is as deep as the narrower half-width.
            shaft: Bands between the two.
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
    joint: IndexArray
    """(Q,) the joint each piece is fixed to."""
    start: Array
    """(Q, 3), like the other fields of `Piece` stacked."""
    end: Array
    lateral: Array
    sagittal: Array
    half_widths: Array
    """(Q, 2, 2)."""

    @classmethod
    def of(cls, pieces: Iterable[Piece]) -> "PieceStack":
        """Stack pieces in order."""
        listed = list(pieces)
        return cls(
            tuple(piece.segment for piece in listed),
            np.array([piece.joint for piece in listed], dtype=np.intp),
            np.stack([piece.start for piece in listed]),
            np.stack([piece.end for piece in listed]),
            np.stack([piece.lateral for piece in listed]),
            np.stack([piece.sagittal for piece in listed]),
            np.stack([piece.half_widths for piece in listed]),
        )

    def place(self, pose: Pose, local: Array) -> Array:
        """World positions (F, Q, 3) of one point (Q, 3) a piece."""
        return np.asarray(pose.origin[:, self.joint] + self.turn(pose, local))

    def turn(self, pose: Pose, direction: Array) -> Array:
        """World directions (F, Q, 3) of one direction (Q, 3) a piece."""
        return np.asarray((pose.rotation[:, self.joint] @ direction[..., None])[..., 0])


@lru_cache(maxsize=256)
def segment_piece(body: Body, name: str) -> Piece:
    """The volume of one of the skeleton's segments; KeyError for a segment without volume.

    Cached: calibration cuts markers from the same few volumes again and again.
    """
    segment = next(s for s in body.skeleton.segments if s.name == name)
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


def marker_segments(body: Body) -> tuple[str, ...]:
    """Names a marker may be bound to: every segment with a volume, and the trunk as a whole."""
    return (TRUNK, *(piece.segment for piece in body_pieces(body)))


def marker_parts(segment: str) -> tuple[str, ...]:
    """Segments covered by a marker that is bound to `segment`."""
    return TRUNK_PARTS if segment == TRUNK else (segment,)
