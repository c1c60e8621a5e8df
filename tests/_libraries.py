"""A small library to test with, and libraries' motions as they are meant to be played."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import lower_sole_m
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import UP, Posture, yaw_rotation, yawed_at
from keymark.core.body.posture_spline import cubic_spline, find_intervals
from keymark.core.prior.library import Library, LibraryMotion, LibraryPosture, MotionStep, transferred

ACTOR = Actor.from_stature(1.75)


def random_posture(seed: int, spread: float = 0.4) -> Posture:
    """A posture away from rest in every degree of freedom, its hips about as high as in standing."""
    vector = np.random.default_rng(seed).normal(0.0, spread, 34)
    vector[:3] = vector[:3] * 0.1 + (0.0, 0.0, 0.93)
    return Posture.from_vector(HUMAN, vector)


def small_library(actor: Actor = ACTOR) -> Library:
    """Three postures, a cyclic motion that travels and one that does not come again."""
    names = ("Left foot lands", "Stand on one leg", "Right foot lands")
    postures = tuple(
        LibraryPosture(name, random_posture(seed), ("gait", "contact") if seed != 1 else ())
        for seed, name in enumerate(names)
    )
    steps = tuple(MotionStep(name, 0.31 * place) for place, name in enumerate(names))
    return Library(
        identifier="small_steps",
        title="Small steps, große Schritte",
        version=3,
        author="A. Person",
        license="CC0-1.0",
        actor=actor,
        postures=postures,
        motions=(
            LibraryMotion("Steps", steps, 1.0, True, (0.1, -1.3, 0.2)),
            LibraryMotion("Once", steps[:2], 0.5),
        ),
        description="For tests.",
        sources=("Nobody (1900), *Nothing*.",),
        tags=("gait",),
    )


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
