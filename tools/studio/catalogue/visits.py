"""People as they come in from the street: no garment is a marker."""

from ..described import Described, actor, performed
from ..look import Look
from ..motions import greeting
from ..surroundings import Lamp, Room, Thing
from ..viewpoint import look_at
from .sizes import SMALL

JUMPER, JEANS = (92, 110, 92), (52, 62, 92)
SHELF, SOFA, CUSHION, RUG = (0.34, 0.22, 0.12), (0.20, 0.26, 0.27), (0.50, 0.40, 0.22), (0.34, 0.30, 0.27)

GREETING = Described(
    name="greeting",
    perform=performed(greeting.plan, actor(1.71, forearm=1.02, shin=0.98), 132),
    camera=look_at((0.45, -4.0, 1.45), (-0.12, 0.0, 0.98), 44.0, SMALL),
    look=Look(
        colors={
            **dict.fromkeys(("trunk", "forearm.L", "forearm.R", "sleeve"), JUMPER),
            **dict.fromkeys(("shin.L", "shin.R", "cloth"), JEANS),
            "skin": (196, 146, 118),
            "hair": (66, 44, 30),
        },
        cloth_m={"trunk": 0.012, "forearm": 0.008, "shin": 0.012, "sleeve": 0.008, "cloth": 0.006},
        folds=0.3,
    ),
    room=Room(
        lamps=(
            Lamp((1.6, -3.6, 3.0), 2.2, 230.0, (1.0, 0.95, 0.88)),
            Lamp((-3.0, -2.4, 2.4), 1.8, 70.0, (0.92, 0.96, 1.0)),
        ),
        wall=(0.66, 0.67, 0.62),
        furnished=False,
        things=(
            *(Thing((1.0, 0.30, 0.04), SHELF, {0: (-1.65, 1.58, height)}) for height in (0.2, 0.7, 1.2, 1.7)),
            *(Thing((0.04, 0.30, 1.75), SHELF, {0: (x, 1.58, 0.87)}) for x in (-2.17, -1.13)),
            Thing((0.30, 0.20, 0.26), (0.30, 0.10, 0.09), {0: (-1.95, 1.56, 0.86)}),
            Thing((0.42, 0.20, 0.22), (0.16, 0.22, 0.32), {0: (-1.52, 1.56, 0.84)}),
            Thing((0.50, 0.20, 0.24), (0.42, 0.38, 0.30), {0: (-1.75, 1.56, 1.35)}),
            Thing((0.24, 0.24, 0.24), (0.16, 0.28, 0.16), {0: (-1.4, 1.55, 1.84)}, round=True),
            Thing((1.7, 0.75, 0.40), SOFA, {0: (1.35, 1.20, 0.20)}),
            Thing((1.7, 0.20, 0.80), SOFA, {0: (1.35, 1.52, 0.40)}),
            Thing((0.20, 0.75, 0.58), SOFA, {0: (0.42, 1.20, 0.29)}),
            Thing((0.44, 0.16, 0.40), CUSHION, {0: (0.86, 1.32, 0.60)}),
            Thing((0.80, 0.03, 0.56), (0.09, 0.08, 0.08), {0: (1.25, 1.735, 1.55)}),
            Thing((0.72, 0.02, 0.48), (0.45, 0.48, 0.50), {0: (1.25, 1.715, 1.55)}),
            Thing((2.4, 1.5, 0.012), RUG, {0: (0.1, -0.05, -0.004)}),
        ),
    ),
    seed=120,
    keyframes=(0, 14, 29, 43, 60, 78, 92, 108, 120, 131),
    postures=True,
    detected=True,
    plain=True,
    samples=3,
    noise=1.2,
    quality="MEDIUM",
)
"""The example in plain clothes: somebody comes into a living room, waves, and offers the sofa.

Its keyframes are an animator's choice: contacts of the feet, and the ends of gestures.
"""
