"""A small library to test with."""

import numpy as np
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.prior.library import Library, LibraryMotion, LibraryPosture, MotionStep

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
