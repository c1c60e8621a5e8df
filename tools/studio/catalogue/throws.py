"""Throws."""

from ..described import Described, actor, performed
from ..look import Look
from ..motions import throw
from ..viewpoint import look_from
from .sizes import WIDE

THROW = Described(
    name="throw",
    perform=performed(throw.plan, actor(1.86, forearm=1.03, upper_arm=1.02), 66, -25.0, tempo=0.9),
    camera=look_from(20.0, 4.8, 1.6, (0.0, -0.05, 0.98), 42.0, WIDE),
    look=Look(
        colors={
            "trunk": (236, 196, 40),
            "forearm.L": (160, 50, 170),
            "forearm.R": (220, 70, 36),
            "shin.L": (40, 110, 200),
            "shin.R": (50, 150, 70),
        },
        girths={"upper_arm": 1.08, "thigh": 1.05},
        folds=0.5,
    ),
    seed=109,
    moments=2,
    samples=1,
)
