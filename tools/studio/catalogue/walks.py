"""Walks."""

from ..described import Described, actor, performed
from ..look import Look
from ..motions import far_leg, stroll
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

FAR_LEG = Described(
    name="far_leg",
    perform=performed(far_leg.plan, actor(1.82, thigh=0.98, shin=1.03, hip_width=0.95), 102),
    camera=look_from(90.0, 4.6, 1.05, (0.0, 0.0, 0.98), 46.0, SMALL),
    look=Look(
        colors={
            "trunk": (54, 150, 90),
            "forearm.L": (206, 60, 150),
            "forearm.R": (214, 160, 40),
            "shin.L": (60, 80, 200),
            "shin.R": (206, 84, 40),
            "cloth": (150, 146, 140),
            "skin": (142, 98, 74),
            "hair": (20, 18, 18),
        },
        girths={"thigh": 1.02, "trunk": 1.02, "shin": 1.04},
        cloth_m={"trunk": 0.008, "forearm": 0.005, "shin": 0.012},
        folds=0.6,
    ),
    room=Room(
        wall=(0.56, 0.52, 0.58),
        things=(Thing((0.75, 2.0, 0.04), (0.06, 0.06, 0.065), {0: (0.0, 0.0, -0.018)}),),
    ),
    seed=113,
    keyframes=(0, 15, 28, 42, 57, 72, 87, 101),
    samples=1,
)
"""Seen exactly from the side; every keyframe is a heel strike, so that all swings happen between them."""
