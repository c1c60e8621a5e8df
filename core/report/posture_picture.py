"""A small square picture of a posture, as an asset browser shows it, seen from where its limbs show."""

import numpy as np

from ..arrays import Array, Image
from ..body.body_volume import HEAD_OVERSHOOT
from ..body.heading import facing_rad
from ..body.kinematics import Body
from ..body.posture import Posture
from .mannequin import View, draw_mannequin, view_axes

SIZE = 256
EDGE = 8
TILT_RAD = 0.16
"""Looking down a little, so that one sees where on the floor the feet are."""
WALL = np.array([250.0, 249.0, 248.0])
FLOOR = np.array([229.0, 225.0, 222.0])
BEHIND_M = 0.45
"""The wall stands so far behind the figure."""
TURNS_RAD = np.radians(np.arange(-80.0, 81.0, 10.0))
"""Views from the front half: faces are seen."""
USUAL_RAD, UNUSUAL = np.radians(-50.0), 0.10
"""People preferably look to the right of the picture: so much is lost for every radian away from there."""
SHORTEST = 0.15
"""A limb that looks shorter than this share of its length is as good as hidden."""
WORST, WORST_COUNTS = 5, 0.3
"""So many of a posture's limbs, those that look shortest, speak against a view."""
FLESH_M = 0.07
"""How far skin reaches beyond the joints."""


def posture_picture(body: Body, posture: Posture) -> Image:
    """Draw a single posture; the floor is z = 0.

    Returns:
        (256, 256, 3) blue, green, red.
    """
    batch = Posture.stack([posture])
    turn = showing_turn(body, batch)
    seen = outermost(body, batch, turn)[0]
    floor_y = float(posture.translation * [1.0, 1.0, 0.0] @ view_axes(turn, TILT_RAD)[1])
    low = min(float(seen[:, 1].min()) - FLESH_M, floor_y - 0.1)
    high = float(seen[:, 1].max()) + FLESH_M
    left, right = float(seen[:, 0].min()) - FLESH_M, float(seen[:, 0].max()) + FLESH_M
    free = SIZE - 2 * EDGE
    scale = min(free / (high - low), free / (right - left), free / (1.08 * body.actor.stature_m))
    center = (0.5 * SIZE - scale * 0.5 * (left + right), SIZE - EDGE + scale * low)
    view = View(turn, TILT_RAD, scale, center)
    return draw_mannequin(stage(SIZE, SIZE, center[1] - scale * floor_y, scale), body, posture, view)


def stage(height: int, width: int, floor: float, scale: float) -> Image:
    """A floor before a wall.

    Args:
        height: Of the picture.
        width: Of the picture.
        floor: Where on it, downwards, the floor under the figure lies.
        scale: Pixels a meter.
    """
    rows = np.arange(height) + 0.5 - (floor - scale * BEHIND_M * np.sin(TILT_RAD))
    share = np.clip(rows + 0.5, 0.0, 1.0)  # of each row, that is floor
    fade = np.clip(rows / (3.0 * scale * BEHIND_M * np.sin(TILT_RAD)), 0.0, 1.0)
    ground = FLOOR + fade[:, None] * 0.6 * (WALL - FLOOR)
    colors = WALL + share[:, None] * (ground - WALL)
    return np.asarray(np.repeat(np.round(colors)[:, None], width, axis=1), dtype=np.uint8)


def showing_turn(body: Body, postures: Posture) -> float:
    """From where, around the world's Z, limbs show best over a batch of postures (K) [rad]."""
    ahead = -postures.rotations[:, 0, :, 1]
    heading = facing_rad(ahead.mean(axis=0))
    places, limbs = _places(body, postures), _limbs(body, postures)
    apart = places[:, :, None] - places[:, None]
    away = np.abs(TURNS_RAD - USUAL_RAD)
    shown = [_shown(apart, limbs, heading + turn) for turn in TURNS_RAD]
    return float(heading + TURNS_RAD[np.argmax(np.array(shown) - UNUSUAL * away)])


def _shown(apart: Array, limbs: Array, turn_rad: float) -> float:
    """How well limbs show in a view, over all postures: far apart, and not pointing at the eye.

    Args:
        apart: (K, N, N, 3) from each place to each other one [m].
        limbs: (K, S, 3) from each segment's start to its end [m].
        turn_rad: Of the view.
    """
    axes = view_axes(turn_rad, TILT_RAD)[:2]
    aside = _length(apart @ axes.T).mean() / _length(apart).mean()
    share = np.maximum(_length(limbs @ axes.T) / _length(limbs), SHORTEST)
    worst = np.sort(np.log(share), axis=1)[:, :WORST].mean()
    return float(aside + WORST_COUNTS * worst)


def _limbs(body: Body, postures: Posture) -> Array:
    """(K, S, 3) [m]."""
    pose = body.pose(postures)
    ends = [body.segment_ends(pose, segment.name) for segment in body.skeleton.segments]
    return np.stack([end - start for start, end in ends], axis=1)


def _length(vector: Array) -> Array:
    return np.asarray(np.linalg.norm(vector, axis=-1))


def outermost(body: Body, postures: Posture, turn_rad: float) -> Array:
    """Joints, crown and tips of a batch (K) of postures in a view, (K, N, 2): meters right and up."""
    return np.asarray(_places(body, postures) @ view_axes(turn_rad, TILT_RAD)[:2].T)


def _places(body: Body, postures: Posture) -> Array:
    """(K, N, 3) [m]."""
    pose = body.pose(postures)
    tips = [body.segment_ends(pose, f"{part}.{side}")[1] for part in ("hand", "foot") for side in ("L", "R")]
    neck, head = body.segment_ends(pose, "head")
    crown = neck + HEAD_OVERSHOOT * (head - neck)
    return np.concatenate([body.points(pose), np.stack([*tips, crown], axis=1)], axis=1)
