"""Exercises: jogging, jumping, lifting, jumping jacks."""

from ..described import Described, actor, lifted_onto_a_stand, performed
from ..look import Look
from ..motions import jog, jump, lift, star_jumps
from ..surroundings import Lamp, Room, Thing
from ..viewpoint import look_from
from .sizes import MIDDLE, SMALL

JOG = Described(
    name="jog",
    perform=performed(jog.plan, actor(1.88, trunk=0.97, thigh=1.03, forearm=1.05), 100, -8.0),
    camera=look_from(38.0, 3.6, 1.75, (0.0, -0.05, 0.98), 40.0, SMALL, tilt_deg=-3.0),
    look=Look(
        colors={"trunk": (214, 96, 30), "forearm.L": (40, 150, 190), "forearm.R": (190, 40, 96),
                 "shin.L": (60, 150, 60),
                 "shin.R": (96, 70, 190), "skin": (122, 84, 62), "hair": (22, 18, 16)},
        girths={"thigh": 0.93, "shin": 0.94, "upper_arm": 0.9, "forearm": 0.92, "trunk": 0.95},
    ),
    room=Room(wall=(0.42, 0.50, 0.55), planks=((0.16, 0.16, 0.17), (0.14, 0.14, 0.15), (0.1, 0.1, 0.1)),
              furnished=False,
              things=(Thing((0.85, 1.9, 0.04), (0.05, 0.05, 0.055), {0: (0.0, 0.0, -0.018)}),)),
    seed=101,
)  # fmt: skip


JUMP = Described(
    name="jump",
    perform=performed(jump.plan, actor(1.62, trunk=1.04, thigh=0.97), 92, -14.0),
    camera=look_from(-12.0, 3.3, 0.8, (0.0, 0.0, 1.19), 30.0, SMALL, tilt_deg=1.5),
    look=Look(
        colors={"trunk": (120, 60, 170), "forearm.L": (60, 170, 70), "forearm.R": (220, 110, 30),
                 "shin.L": (200, 40, 70),
                 "shin.R": (50, 130, 200), "skin": (214, 160, 134), "hair": (120, 84, 40)},
        girths={"thigh": 1.06, "shin": 1.05, "trunk": 0.93, "upper_arm": 0.92, "forearm": 0.92},
    ),
    room=Room(wall=(0.55, 0.58, 0.44), planks=((0.24, 0.28, 0.22), (0.22, 0.26, 0.20), (0.2, 0.22, 0.18))),
    seed=104,
)  # fmt: skip


LIFT = Described(
    name="lift",
    perform=performed(lift.plan, actor(1.93, trunk=1.02, shoulder_width=1.05), 110, 6.0),
    camera=look_from(72.0, 4.7, 1.3, (-0.15, -0.05, 0.98), 48.0, SMALL, tilt_deg=-1.0),
    look=Look(
        colors={
            "trunk": (70, 140, 60),
            "forearm.L": (210, 50, 50),
            "forearm.R": (60, 80, 200),
            "shin.L": (225, 130, 30),
            "shin.R": (130, 50, 170),
            "cloth": (40, 46, 70),
            "skin": (198, 146, 112),
        },
        girths={"trunk": 1.18, "thigh": 1.12, "upper_arm": 1.12, "forearm": 1.1, "shin": 1.06},
        cloth_m={"trunk": 0.014, "forearm": 0.004, "shin": 0.012},
        folds=0.6,
    ),
    props=lambda performance: lifted_onto_a_stand(performance, 33, 81),
    seed=106,
    samples=1,
)
"""Seen from the side, with a box that hides the hands."""


STAR_JUMPS = Described(
    name="star_jumps",
    perform=performed(star_jumps.plan, actor(1.56, trunk=1.05, thigh=0.95, upper_arm=0.95), 90, 15.0),
    camera=look_from(10.0, 5.0, 1.0, (0.0, 0.0, 1.10), 40.0, MIDDLE, tilt_deg=-2.5),
    look=Look(
        colors={
            "trunk": (60, 60, 180),
            "forearm.L": (220, 150, 30),
            "forearm.R": (200, 50, 120),
            "shin.L": (60, 170, 120),
            "shin.R": (190, 60, 40),
            "hair": (150, 110, 60),
            "skin": (232, 190, 164),
        },
        girths={"trunk": 1.1, "thigh": 1.12, "shin": 1.08, "upper_arm": 1.05},
    ),
    room=Room(
        lamps=(Lamp((2.6, -2.6, 3.0), 0.5, 210.0, (1.0, 0.95, 0.85)),),
        sky=(0.75, 0.85, 1.0, 0.3),
        wall=(0.60, 0.55, 0.50),
        things=(
            Thing((0.32, 0.32, 0.32), (0.50, 0.03, 0.16), {0: (-1.9, 0.9, 0.16), 89: (2.3, 0.5, 0.16)}, True),
        ),
    ),
    seed=110,
    moments=2,
    samples=1,
    shadow_per_height=(-0.9, 0.9, 0.0),
)
"""A ball of nearly a marker's color rolls past behind."""
