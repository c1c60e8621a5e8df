"""Exercises: jogging, jumping, lifting, jumping jacks."""

from ..described import Described, actor, lifted_onto_a_stand, performed
from ..look import Look, wearing
from ..motions import jog, jump, lift, star_jumps
from ..surroundings import Lamp, Room, Thing
from ..viewpoint import look_from
from .sizes import MIDDLE, SMALL

JOG = Described(
    name="jog",
    perform=performed(jog.plan, actor(1.88, trunk=0.97, thigh=1.03, forearm=1.05), 100, -8.0),
    camera=look_from(38.0, 3.6, 1.75, (0.0, -0.05, 0.98), 40.0, SMALL, tilt_deg=-3.0),
    look=Look(
        colors=wearing("d6601e 2896be be2860 3c963c 6046be", skin="7a543e", hair="161210"),
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
        colors=wearing("783caa 3caa46 dc6e1e c82846 3282c8", skin="d6a086", hair="785428"),
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
        colors=wearing("468c3c d23232 3c50c8 e1821e 8232aa", cloth="282e46", skin="c69270"),
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
        colors=wearing("3c3cb4 dc961e c83278 3caa78 be3c28", hair="966e3c", skin="e8bea4"),
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
