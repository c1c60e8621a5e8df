"""Motions over time: shapes of postures for comparing them, and playback."""

import numpy as np

from ..arrays import Array
from ..body.body_volume import lower_sole_m
from ..body.kinematics import Body
from ..body.posture import UP, Posture, headings_rad, yaw_rotation, yawed_at
from ..body.posture_spline import cubic_spline, find_intervals
from ..body.skeleton import SIDES
from .library import Library, LibraryMotion
from .transfer import transferred


def shape_vectors(body: Body, posture: Posture) -> Array:
    """Shape vectors (F, 3 P); their distance is the root mean square distance of the points [m].

    They are the principal points relative to the ground below the hips, the performer facing -Y.
    """
    points = body.points(body.pose(posture))
    ground = posture.translation * [1.0, 1.0, 0.0]
    turn = yaw_rotation(-headings_rad(posture))
    seen = (points - ground[..., None, :]) @ np.swapaxes(turn, -1, -2)
    return np.asarray(seen.reshape(*posture.batch, -1) / np.sqrt(points.shape[-2]))


def ankle_heights(body: Body, posture: Posture) -> Array:
    """Heights (F, 2) of the left and the right ankle over those of feet flat on z = 0 [m].

    Ankles tell the floor's height, as soles do not: the skeleton's feet, rigid with the shins, point into the
    floor at the end of a step.
    """
    points = body.points(body.pose(posture))
    ankles = [body.skeleton.point_names.index(f"ankle.{side}") for side in SIDES]
    below = [0.36 * body.actor.segments_m[f"foot.{side}"] for side in SIDES]
    return np.asarray(points[..., ankles, 2] - below)


# --- Playback


NEIGHBORS = 2  # postures before and after a cycle that the spline within it depends on


def sample_motion(library: Library, motion: LibraryMotion, body: Body, time_s: Array) -> Posture:
    """The postures of a motion at any times, on a spline through those of its steps.

    A cyclic motion continues without end, before time 0 too, and travels with every cycle; any other holds
    its first posture before its beginning and its last one after its end. Between two steps the lowest sole
    stays between its heights in both of them: a foot on the floor stays there.
    """
    posed = Posture.stack([library.by_name[step.posture].posture for step in motion.steps])
    knots = np.array([step.time_s for step in motion.steps])
    at = np.asarray(time_s, dtype=np.float64)
    if not motion.cyclic:
        return transferred(_interpolated(library, posed, knots, at), library.actor, body)
    cycle = np.floor(at / motion.duration_s)
    around = np.arange(-NEIGHBORS, len(knots) + NEIGHBORS)
    turn, step = np.divmod(around, len(knots))
    spline = _interpolated(
        library,
        after_cycles(posed[step], motion, turn),
        knots[step] + turn * motion.duration_s,
        at - cycle * motion.duration_s,
    )
    return transferred(after_cycles(spline, motion, cycle), library.actor, body)


def after_cycles(posture: Posture, motion: LibraryMotion, cycles: Array) -> Posture:
    """Postures moved by the travel of some cycles, later or earlier ones.

    A cycle turns a point about the world's origin by the travel's heading, then shifts it by x and y.

    `cycles` (N,): whole numbers, negative for earlier ones.
    """
    *way, heading = motion.travel
    angle = np.asarray(cycles) * heading
    # The sum of the turned shifts of all cycles is a geometric series; sin(n h / 2) / sin(h / 2) is its size.
    half = 0.5 * np.remainder(heading + np.pi, 2.0 * np.pi) - 0.5 * np.pi
    size = np.asarray(cycles) if abs(half) < 1e-9 else np.sin(cycles * half) / np.sin(half)
    direction = yaw_rotation((np.asarray(cycles) - 1.0) * half)
    moved = size[:, None] * (direction @ np.array([*way, 0.0]))
    hips = (yaw_rotation(angle) @ posture.translation[..., None])[..., 0] + moved
    return yawed_at(posture, angle, hips)


def _interpolated(library: Library, posed: Posture, knots: Array, at: Array) -> Posture:
    """Postures (T,) on a spline through the knots, with soles no lower and no higher than at both knots."""
    if len(knots) == 1:
        return posed[np.zeros(len(at), dtype=np.intp)]
    spline = cubic_spline(posed, knots, at)
    body = Body(library.actor, posed.skeleton)
    interval, _ = find_intervals(knots, at)
    posed_m = lower_sole_m(body, posed)
    height = lower_sole_m(body, spline)
    low = np.minimum(posed_m[:-1], posed_m[1:])[interval]
    high = np.maximum(posed_m[:-1], posed_m[1:])[interval]
    lift = np.clip(height, low, high) - height
    return Posture(spline.skeleton, spline.translation + lift[:, None] * UP, spline.rotations, spline.angles)
