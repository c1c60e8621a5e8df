"""The surface of a mannequin on the body's segments, as points with normals; for pictures alone.

Limbs are the volumes of `body/body_volume`, a little swollen where muscles are; head, hands and feet are
shaped so that the direction of a person's face and feet shows. The feet's undersides are the soles of
`body/soles`.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from ..body.body_volume import Piece, body_pieces
from ..body.kinematics import Body
from ..body.soles import HEEL_BEHIND
from .canvas import LEFT, RIGHT, Color
from .mannequin_feet import foot_frame_index

TRUNK: Color = (186, 182, 180)
BAND: Color = (235, 232, 230)
"""Color of the rings around the right limbs, which mark them for color-blind eyes too."""
SHOE = 0.72
"""Brightness of feet beside that of legs."""
SWELLING = {"upper_arm": 0.10, "forearm": 0.16, "thigh": 0.06, "shin": 0.22}
"""Excess thickness of a limb at a third of its length over a straight taper."""
ROUNDING = {"chest": 0.35, "pelvis": 0.6, "hand": 1.0}
"""Length of a rounded end, of its half-width; 0.85 where not named."""


@dataclass(frozen=True, eq=False)
class Surface:
    """Points of the skin, fixed in frames."""

    frame: IndexArray
    """(N,) the frame that moves each point: a joint's, or a foot's, of `mannequin_feet`."""
    point: SingleArray
    """(N, 3) position in that frame [m]."""
    normal: SingleArray
    """(N, 3) unit directions outwards."""
    color: SingleArray
    """(N, 3) blue, green, red."""

    @cached_property
    def parts(self) -> tuple[tuple[int, slice], ...]:
        """Consecutive points that one frame moves: that frame, and their slice."""
        starts = [0, *np.flatnonzero(np.diff(self.frame)) + 1, len(self.frame)]
        return tuple((int(self.frame[a]), slice(a, b)) for a, b in pairwise(starts))


@dataclass(frozen=True, eq=False)
class _Tube:
    """Elliptical rings (R) along a line, in a frame."""

    frame: int
    center: Array
    """(R, 3) [m]."""
    lateral: Array
    """(R, 3) from the center to the ring [m]."""
    sagittal: Array
    """(R, 3)."""
    color: Array
    """(R, 3)."""


@lru_cache(maxsize=4)
def mannequin_surface(body: Body, spacing_m: float) -> Surface:
    """The skin of a body, its points about `spacing_m` apart."""
    parts = [_points(tube, spacing_m) for tube in _tubes(body, spacing_m)]
    frame = np.concatenate([np.full(len(point), tube) for tube, point, _, _ in parts])
    point, normal, color = (np.concatenate([part[i] for part in parts]).astype(np.float32) for i in (1, 2, 3))
    return Surface(frame, point, normal, color)


def _tubes(body: Body, spacing_m: float) -> Iterator[_Tube]:
    for piece in body_pieces(body):
        kind = piece.segment.split(".")[0]
        if kind == "head":
            yield from _head(piece, spacing_m)
        elif kind == "foot":
            yield _foot(body, piece, spacing_m)
        else:
            yield _limb(piece, kind, spacing_m)


def _limb(piece: Piece, kind: str, spacing_m: float) -> _Tube:
    """A tapered cylinder with rounded ends and, on the right, a pale band around its middle."""
    axis = piece.end - piece.start
    length = float(np.linalg.norm(axis))
    share, width = [], []
    inner = np.linspace(0.0, 1.0, max(int(length / spacing_m), 2))
    for sign, end in ((-1.0, 0), (1.0, 1)):
        size = ROUNDING.get(kind, 0.85) * piece.half_widths[end].mean()
        widest = max(size, float(piece.half_widths[end].max()))
        angle = np.linspace(0.0, 0.5 * np.pi, max(int(1.6 * widest / spacing_m), 4))[1:]
        share.append(end + sign * np.sin(angle) * size / length)
        width.append(np.cos(angle)[:, None] * piece.half_widths[end])
    shares = np.concatenate([share[0][::-1], inner, share[1]])
    shaft = piece.half_widths[0] + inner[:, None] * (piece.half_widths[1] - piece.half_widths[0])
    shaft = shaft * (1.0 + SWELLING.get(kind, 0.0) * np.sin(np.pi * inner**0.63) ** 2)[:, None]
    widths = np.concatenate([width[0][::-1], shaft, width[1]])
    color = np.tile(_side_color(piece.segment), (len(shares), 1))
    if piece.segment.endswith(".R") and kind != "hand":
        color[np.abs(shares - 0.5) < 0.02 / length] = BAND
    return _Tube(
        piece.joint,
        piece.start + shares[:, None] * axis,
        widths[:, :1] * piece.lateral,
        widths[:, 1:] * piece.sagittal,
        color,
    )


def _head(piece: Piece, spacing_m: float) -> Iterator[_Tube]:
    """A neck, an egg and a nose; the crown is where the piece ends."""
    axis = piece.end - piece.start
    neck = Piece(
        "neck", piece.joint, piece.start, piece.start + 0.5 * axis, piece.lateral, piece.sagittal,
        0.82 * piece.half_widths[:1].repeat(2, axis=0),
    )  # fmt: skip
    yield _limb(neck, "neck", spacing_m)
    up = 0.40 * axis
    center = piece.end - up
    wide, deep = piece.half_widths[1]
    yield _egg(piece.joint, center, up, wide * piece.lateral, deep * piece.sagittal, spacing_m)
    nose = center - 0.98 * deep * piece.sagittal - 0.12 * up
    size = 0.17 * wide
    yield _egg(piece.joint, nose, 0.22 * up, size * piece.lateral, 2.0 * size * piece.sagittal, spacing_m)


def _egg(joint: int, center: Array, up: Array, lateral: Array, sagittal: Array, spacing_m: float) -> _Tube:
    angle = np.linspace(0.0, np.pi, max(int(np.pi * np.linalg.norm(up) / spacing_m), 12))[:, None]
    # The jaw is narrower than the skull.
    size = np.sin(angle) * (1.0 - 0.05 * (1.0 - np.cos(angle)))
    color = np.tile(np.array(TRUNK, dtype=np.float64), (len(angle), 1))
    return _Tube(joint, center + np.cos(angle) * up, size * lateral, size * sagittal, color)


def _foot(body: Body, piece: Piece, spacing_m: float) -> _Tube:
    """A shoe from heel to tip: flat below, high at the ankle."""
    length = body.actor.segments_m[piece.segment]
    ankle, low = piece.start, float(piece.end[2])
    heel, tip = ankle[1] + HEEL_BEHIND * length, float(piece.end[1])
    angle = np.linspace(0.0, np.pi, max(int(1.5 * (heel - tip) / spacing_m), 12))
    along = 0.5 * (heel + tip) + 0.5 * (heel - tip) * np.cos(angle)  # (R,)
    ends = np.sqrt(np.sin(angle))
    rise = np.clip((along - tip) / (heel - tip), 0.0, 1.0) ** 1.3
    height = ends * (0.32 + 0.68 * rise) * (ankle[2] - low) * 1.15
    half_width = ends * float(piece.half_widths[:, 0].mean()) * (1.15 - 0.25 * rise)
    center = np.stack([np.full_like(along, ankle[0]), along, low + 0.5 * height], axis=-1)
    across, up = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    color = np.tile(SHOE * _side_color(piece.segment), (len(along), 1))
    frame = foot_frame_index(body, piece.segment)
    return _Tube(frame, center, half_width[:, None] * across, 0.5 * height[:, None] * up, color)


def _side_color(segment: str) -> Array:
    side = segment.rsplit(".", 1)[-1]
    return np.array({"L": LEFT, "R": RIGHT}.get(side, TRUNK), dtype=np.float64)


def _points(tube: _Tube, spacing_m: float) -> tuple[int, Array, Array, Array]:
    widest = max(np.linalg.norm(tube.lateral, axis=-1).max(), np.linalg.norm(tube.sagittal, axis=-1).max())
    around = np.linspace(0.0, 2.0 * np.pi, max(int(2.0 * np.pi * widest / spacing_m), 12), endpoint=False)
    cos, sin = np.cos(around)[:, None], np.sin(around)[:, None]
    spoke = cos * tube.lateral[:, None] + sin * tube.sagittal[:, None]  # (R, S, 3)
    point = tube.center[:, None] + spoke
    turn = cos * tube.sagittal[:, None] - sin * tube.lateral[:, None]
    normal = np.cross(np.gradient(point, axis=0), turn)
    normal *= np.sign(np.sum(normal * spoke, axis=-1, keepdims=True) + 1e-15)
    # At the poles, where rings are points, normals point along the line.
    pole = tube.center - tube.center.mean(axis=0)
    flat = np.linalg.norm(normal, axis=-1, keepdims=True) < 1e-12
    normal = np.where(flat, pole[:, None], normal)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    color = np.broadcast_to(tube.color[:, None], point.shape)
    return tube.frame, point.reshape(-1, 3), normal.reshape(-1, 3), color.reshape(-1, 3)
