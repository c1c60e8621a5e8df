"""A library's motion as it runs on: its postures at any time, over as many cycles as it takes."""

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
"""So many postures before and after a cycle shape the curve within it."""


def sample_motion(library: Library, motion: LibraryMotion, body: Body, time_s: Array) -> Posture:
    """The postures of a motion at any times, led smoothly through those of its steps.

    A cyclic motion goes on endlessly, before time 0 too, and travels with every cycle; any other holds its
    first posture before its beginning and its last one after its end. Between two steps the lowest sole is no
    higher and no lower than in both of them: what stands on the floor stays there.

    Args:
        library: The library.
        motion: One of its motions.
        body: Whom the postures shall fit.
        time_s: (T,) times from the motion's beginning [s].

    Returns:
        A batch of T postures.
    """
    posed = Posture.stack([library.by_name[step.posture].posture for step in motion.steps])
    knots = np.array([step.time_s for step in motion.steps])
    at = np.asarray(time_s, dtype=np.float64)
    if not motion.cyclic:
        return transferred(_led(library, posed, knots, at), library.actor, body)
    cycle = np.floor(at / motion.duration_s)
    around = np.arange(-NEIGHBORS, len(knots) + NEIGHBORS)
    turn, step = np.divmod(around, len(knots))
    led = _led(
        library,
        after_cycles(posed[step], motion, turn),
        knots[step] + turn * motion.duration_s,
        at - cycle * motion.duration_s,
    )
    return transferred(after_cycles(led, motion, cycle), library.actor, body)


def after_cycles(posture: Posture, motion: LibraryMotion, cycles: Array) -> Posture:
    """Postures where they come again some cycles later, or earlier.

    A cycle turns a place about the world's origin by the motion's heading, then moves it by x and y.

    Args:
        posture: A batch of N postures.
        motion: A cyclic motion.
        cycles: (N,) whole numbers.
    """
    *way, heading = motion.travel
    angle = np.asarray(cycles) * heading
    # The sum of the turned ways of all cycles is a geometric series; sin(n h / 2) / sin(h / 2) is its size.
    half = 0.5 * np.remainder(heading + np.pi, 2.0 * np.pi) - 0.5 * np.pi
    size = np.asarray(cycles) if abs(half) < 1e-9 else np.sin(cycles * half) / np.sin(half)
    direction = yaw_rotation((np.asarray(cycles) - 1.0) * half)
    moved = size[:, None] * (direction @ np.array([*way, 0.0]))
    place = (yaw_rotation(angle) @ posture.translation[..., None])[..., 0] + moved
    return yawed_at(posture, angle, place)


def _led(library: Library, posed: Posture, knots: Array, at: Array) -> Posture:
    """Postures (T,) between those at the knots, their soles no lower and no higher than there."""
    if len(knots) == 1:
        return posed[np.zeros(len(at), dtype=np.intp)]
    led = cubic_spline(posed, knots, at)
    body = Body(library.actor, posed.skeleton)
    stretch, _ = find_intervals(knots, at)
    given = lower_sole_m(body, posed)
    height = lower_sole_m(body, led)
    low = np.minimum(given[:-1], given[1:])[stretch]
    high = np.maximum(given[:-1], given[1:])[stretch]
    lift = np.clip(height, low, high) - height
    return Posture(led.skeleton, led.translation + lift[:, None] * UP, led.rotations, led.angles)
