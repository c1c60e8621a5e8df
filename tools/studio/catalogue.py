"""All takes: the demonstration, and others that share as little as possible with it."""

from . import aerobic
from .described import Described, actor, lifted_onto_a_stand, performed
from .look import Look
from .motions import box, dance, jog, jump, kick, lift, spin, star_jumps, stroll, throw
from .surroundings import Lamp, Room, Thing
from .viewpoint import look_at, look_from

SMALL, WIDE = (320, 240), (1280, 720)
HARD_SHADOW = (2.0, 1.2, 0.0)

DEMONSTRATION = Described(
    name="aerobic",
    perform=aerobic.perform,
    camera=look_at((0.75, -4.15, 1.32), (0.24, 0.05, 1.03), 47.0, SMALL),
    side=look_at((4.35, -0.25, 1.25), (0.1, -0.15, 1.03), 47.0, SMALL),
    keyframes=tuple(frame - 1 for frame in (1, 9, 16, 24, 31, 43, 54, 67, 81, 95, 107, 118)),
    postures=True,
    detected=True,
    samples=3,
)
"""Its keyframes are an animator's choice: ends of movements, and midpoints where these are far apart."""

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

KICK = Described(
    name="kick",
    perform=performed(kick.plan, actor(1.70, upper_arm=0.95, shin=0.97, hip_width=1.1), 100, 12.0),
    camera=look_from(58.0, 4.8, 1.1, (0.05, -0.25, 0.98), 55.0, SMALL, tilt_deg=2.0),
    look=Look(
        colors={"trunk": (28, 130, 120), "forearm.L": (220, 170, 30), "forearm.R": (200, 60, 160),
                 "shin.L": (60, 90, 210), "shin.R": (200, 60, 40), "cloth": (196, 192, 184), "skin": (226,
                                                                                                      180,
    150)},
        girths={"thigh": 1.12, "trunk": 1.08, "upper_arm": 1.1, "forearm": 1.08},
        cloth_m={"trunk": 0.012, "forearm": 0.008, "shin": 0.010}, folds=0.7,
    ),
    seed=102,
)  # fmt: skip

BOX = Described(
    name="box",
    perform=performed(box.plan, actor(1.80, forearm=1.04, shoulder_width=1.08), 108, 4.0),
    camera=look_from(24.0, 4.2, 1.45, (0.0, -0.05, 0.98), 50.0, SMALL),
    look=Look(
        colors={"trunk": (150, 34, 34), "forearm.L": (40, 120, 200), "forearm.R": (230, 200, 50),
                 "shin.L": (60, 160, 90),
                 "shin.R": (150, 60, 180), "skin": (170, 120, 92)},
        girths={"upper_arm": 1.15, "forearm": 1.1, "trunk": 1.04},
    ),
    room=Room(
        lamps=(Lamp((-2.3, -1.9, 2.4), 0.35, 95.0, (1.0, 0.86, 0.68)), Lamp((2.6, -3.0, 1.4), 1.2, 7.0,
                                                                            (0.75, 0.85, 1.0))),
        sky=(0.7, 0.8, 1.0, 0.05), wall=(0.30, 0.27, 0.25),
    ),
    noise=3.0, seed=103, shadow_per_height=HARD_SHADOW,
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

SPIN = Described(
    name="spin",
    perform=performed(spin.plan, actor(1.74, thigh=1.02, upper_arm=1.05), 96, -20.0, tempo=0.92),
    camera=look_from(-24.0, 3.4, 2.2, (0.0, 0.0, 0.93), 35.0, SMALL),
    look=Look(
        colors={
            "trunk": (190, 178, 40),
            "forearm.L": (190, 50, 130),
            "forearm.R": (40, 110, 200),
            "shin.L": (200, 70, 30),
            "shin.R": (30, 150, 110),
            "cloth": (120, 124, 132),
            "hair": (24, 20, 20),
        },
        girths={"trunk": 0.92, "upper_arm": 0.9, "thigh": 0.98},
        cloth_m={"trunk": 0.008, "forearm": 0.016, "shin": 0.008},
        folds=0.8,
    ),
    room=Room(
        lamps=(
            Lamp((-2.2, -2.2, 2.6), 0.8, 120.0, (1.0, 0.55, 0.42)),
            Lamp((2.8, -2.4, 2.4), 1.0, 110.0, (0.45, 0.62, 1.0)),
        ),
        sky=(0.8, 0.7, 1.0, 0.16),
        things=(Thing((0.9, 0.3, 0.75), (0.10, 0.09, 0.08), {0: (-0.55, -0.95, 0.375)}),),
    ),
    seed=105,
    keyframes=(0, 10, 19, 26, 32, 38, 47, 55, 64, 72, 80, 95),
    samples=1,
    noise=2.0,
    shadow_per_height=(0.8, 0.9, 0.0),
)
"""Warm light from one side, blue from the other, wide sleeves, and a counter before the feet.

Keyframes half a turn apart would leave open which way the turn goes; an animator poses more while it lasts.
"""

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

DANCE = Described(
    name="dance",
    perform=performed(dance.plan, actor(1.67, shin=1.03, trunk=0.97, hip_width=1.06), 120, 10.0),
    camera=look_from(14.0, 4.4, 1.5, (0.0, 0.0, 0.95), 47.0, SMALL),
    look=Look(
        colors={
            "trunk": (40, 90, 190),
            "forearm.L": (206, 44, 44),
            "forearm.R": (60, 160, 60),
            "shin.L": (216, 110, 34),
            "shin.R": (40, 150, 170),
            "cloth": (70, 60, 66),
            "skin": (92, 62, 46),
            "hair": (18, 16, 16),
        },
        girths={"thigh": 1.08, "trunk": 0.96, "forearm": 0.94},
    ),
    room=Room(
        lamps=(
            Lamp((0.6, -3.8, 3.2), 1.6, 170.0, (1.0, 0.78, 0.86)),
            Lamp((-2.2, -1.0, 2.2), 0.7, 50.0, (0.55, 0.45, 1.0)),
        ),
        sky=(0.9, 0.85, 1.0, 0.22),
        wall=(0.36, 0.34, 0.40),
        planks=((0.20, 0.13, 0.09), (0.17, 0.11, 0.08), (0.08, 0.06, 0.05)),
    ),
    seed=107,
    samples=1,
    noise=2.0,
)
"""Red and orange are similar colors, and so are the blues; the light is rosy."""

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

STAR_JUMPS = Described(
    name="star_jumps",
    perform=performed(star_jumps.plan, actor(1.56, trunk=1.05, thigh=0.95, upper_arm=0.95), 90, 15.0),
    camera=look_from(10.0, 5.0, 1.0, (0.0, 0.0, 1.10), 40.0, (640, 360), tilt_deg=-2.5),
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

TAKES = {
    described.name: described
    for described in (
        DEMONSTRATION, JOG, KICK, BOX, JUMP, SPIN, LIFT, DANCE, STROLL, THROW, STAR_JUMPS
    )
}  # fmt: skip
