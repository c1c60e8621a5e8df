"""A small square picture of a posture for an asset browser, from the direction that shows its limbs best."""

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
"""Downward tilt of the view, which shows where on the floor the feet are."""
WALL = np.array([250.0, 249.0, 248.0])
FLOOR = np.array([229.0, 225.0, 222.0])
BEHIND_M = 0.45
"""Distance of the wall behind the figure."""
TURNS_RAD = np.radians(np.arange(-80.0, 81.0, 10.0))
"""Turns of the candidate views, all from the front, where the face is seen."""
PREFERRED_TURN_RAD, TURN_PENALTY = np.radians(-50.0), 0.10
"""Preferred turn, with the face to the right of the picture, and the loss of score per radian from it."""
LEAST_FORESHORTENING = 0.15
"""Projected share of a limb's length below which the limb counts as hidden."""
WORST_LIMBS, WORST_WEIGHT = 5, 0.3
"""Number of a posture's most foreshortened limbs that count against a view, and their weight."""
FLESH_M = 0.07
"""Reach of the skin beyond the joints."""


def posture_picture(body: Body, posture: Posture) -> Image:
    """Draw a single posture; the floor is z = 0.

    Returns:
        (256, 256, 3) blue, green, red.
    """
    batch = Posture.stack([posture])
    turn = best_view_turn(body, batch)
    seen = projected_landmarks(body, batch, turn)[0]
    floor_y = float(posture.translation * [1.0, 1.0, 0.0] @ view_axes(turn, TILT_RAD)[1])
    low = min(float(seen[:, 1].min()) - FLESH_M, floor_y - 0.1)
    high = float(seen[:, 1].max()) + FLESH_M
    left, right = float(seen[:, 0].min()) - FLESH_M, float(seen[:, 0].max()) + FLESH_M
    free = SIZE - 2 * EDGE
    scale = min(free / (high - low), free / (right - left), free / (1.08 * body.actor.stature_m))
    center = (0.5 * SIZE - scale * 0.5 * (left + right), SIZE - EDGE + scale * low)
    view = View(turn, TILT_RAD, scale, center)
    return draw_mannequin(backdrop(SIZE, SIZE, center[1] - scale * floor_y, scale), body, posture, view)


def backdrop(height: int, width: int, floor: float, scale: float) -> Image:
    """A floor before a wall.

    Args:
        height: Height of the picture.
        width: Width of the picture.
        floor: Picture row of the floor under the figure.
        scale: Pixels a meter.
    """
    rows = np.arange(height) + 0.5 - (floor - scale * BEHIND_M * np.sin(TILT_RAD))
    share = np.clip(rows + 0.5, 0.0, 1.0)  # of each row, that is floor
    fade = np.clip(rows / (3.0 * scale * BEHIND_M * np.sin(TILT_RAD)), 0.0, 1.0)
    ground = FLOOR + fade[:, None] * 0.6 * (WALL - FLOOR)
    colors = WALL + share[:, None] * (ground - WALL)
    return np.asarray(np.repeat(np.round(colors)[:, None], width, axis=1), dtype=np.uint8)


def best_view_turn(body: Body, postures: Posture) -> float:
    """Turn of the view around the world's Z that shows limbs best over a batch of postures (K) [rad]."""
    ahead = -postures.rotations[:, 0, :, 1]
    heading = facing_rad(ahead.mean(axis=0))
    landmarks, limbs = _landmarks(body, postures), _limbs(body, postures)
    offsets = landmarks[:, :, None] - landmarks[:, None]
    deviation = np.abs(TURNS_RAD - PREFERRED_TURN_RAD)
    scores = [_view_score(offsets, limbs, heading + turn) for turn in TURNS_RAD]
    return float(heading + TURNS_RAD[np.argmax(np.array(scores) - TURN_PENALTY * deviation)])


def _view_score(offsets: Array, limbs: Array, turn_rad: float) -> float:
    """Score of a view over all postures: landmarks far apart, and few limbs pointing at the eye.

    Args:
        offsets: (K, N, N, 3) from each landmark to each other one [m].
        limbs: (K, S, 3) from each segment's start to its end [m].
        turn_rad: Turn of the view.
    """
    axes = view_axes(turn_rad, TILT_RAD)[:2]
    aside = _length(offsets @ axes.T).mean() / _length(offsets).mean()
    share = np.maximum(_length(limbs @ axes.T) / _length(limbs), LEAST_FORESHORTENING)
    worst = np.sort(np.log(share), axis=1)[:, :WORST_LIMBS].mean()
    return float(aside + WORST_WEIGHT * worst)


def _limbs(body: Body, postures: Posture) -> Array:
    """(K, S, 3) vectors from start to end of each segment [m]."""
    pose = body.pose(postures)
    ends = [body.segment_ends(pose, segment.name) for segment in body.skeleton.segments]
    return np.stack([end - start for start, end in ends], axis=1)


def _length(vector: Array) -> Array:
    return np.asarray(np.linalg.norm(vector, axis=-1))


def projected_landmarks(body: Body, postures: Posture, turn_rad: float) -> Array:
    """Joints, crown and tips of a batch (K) of postures in a view, (K, N, 2) to the right and up [m]."""
    return np.asarray(_landmarks(body, postures) @ view_axes(turn_rad, TILT_RAD)[:2].T)


def _landmarks(body: Body, postures: Posture) -> Array:
    """(K, N, 3) joints, tips of hands and feet, and crown [m]."""
    pose = body.pose(postures)
    tips = [body.segment_ends(pose, f"{part}.{side}")[1] for part in ("hand", "foot") for side in ("L", "R")]
    neck, head = body.segment_ends(pose, "head")
    crown = neck + HEAD_OVERSHOOT * (head - neck)
    return np.concatenate([body.points(pose), np.stack([*tips, crown], axis=1)], axis=1)
