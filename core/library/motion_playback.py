"""Playback of a library's motion: its postures at any time, over any number of cycles."""

import numpy as np

from ..arrays import Array
from ..body.heading import UP, yaw_rotation, yawed_at
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.posture_spline import cubic_spline, find_intervals
from ..body.soles import lower_sole_m
from .library import Library, LibraryMotion
from .transfer import transferred

NEIGHBORS = 2
"""Postures before and after a cycle that the spline within it depends on."""


def sample_motion(library: Library, motion: LibraryMotion, body: Body, time_s: Array) -> Posture:
    """The postures of a motion at any times, on a spline through those of its steps.

    A cyclic motion continues without end, before time 0 too, and travels with every cycle; any other holds
    its first posture before its beginning and its last one after its end. Between two steps the lowest sole
    stays between its heights in both of them: a foot on the floor stays there.

    Args:
        library: The library.
        motion: One of its motions.
        body: The body that the postures are fitted to.
        time_s: (T,) times from the motion's beginning [s].

    Returns:
        A batch of T postures.
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

    Args:
        posture: A batch of N postures.
        motion: A cyclic motion.
        cycles: (N,) whole numbers, negative for earlier cycles.
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
    given = lower_sole_m(body, posed)
    height = lower_sole_m(body, spline)
    low = np.minimum(given[:-1], given[1:])[interval]
    high = np.maximum(given[:-1], given[1:])[interval]
    lift = np.clip(height, low, high) - height
    return Posture(spline.skeleton, spline.translation + lift[:, None] * UP, spline.rotations, spline.angles)
