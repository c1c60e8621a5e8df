"""Walks."""

from ..described import Described, actor, performed
from ..look import Look
from ..motions import stroll
from ..surroundings import Room, Thing
from ..viewpoint import look_from
from .sizes import SMALL

STROLL = Described(
    name="stroll",
    perform=performed(stroll.plan, actor(1.78, thigh=1.04, forearm=0.96), 90),
    camera=look_from(6.0, 4.1, 1.55, (0.0, 0.0, 0.98), 32.0, SMALL),
    look=Look(
        colors={
            "trunk": (196, 54, 44),
            "forearm.L": (36, 140, 130),
            "forearm.R": (150, 70, 190),
            "shin.L": (70, 100, 210),
            "shin.R": (210, 180, 40),
            "cloth": (92, 80, 66),
        },
        cloth_m={"trunk": 0.010, "forearm": 0.006, "shin": 0.016},
        folds=0.7,
    ),
    room=Room(
        things=(
            Thing((0.26, 0.26, 2.7), (0.46, 0.44, 0.40), {0: (-0.42, -1.0, 1.35)}),
            Thing((0.9, 0.5, 0.05), (0.30, 0.20, 0.12), {0: (0.75, -1.0, 0.52)}),
            Thing((0.8, 0.06, 0.5), (0.30, 0.20, 0.12), {0: (0.75, -1.0, 0.25)}),
        )
    ),
    seed=108,
    samples=1,
)
"""The performer walks past behind a pillar and a low table."""
