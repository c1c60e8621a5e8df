"""Dances and turns."""

from ..described import Described, actor, performed
from ..look import Look, wearing
from ..motions import back_spin, dance, spin
from ..surroundings import Lamp, Room, Thing
from ..viewpoint import look_from
from .sizes import SMALL

SPIN = Described(
    name="spin",
    perform=performed(spin.plan, actor(1.74, thigh=1.02, upper_arm=1.05), 96, -20.0, tempo=0.92),
    camera=look_from(-24.0, 3.4, 2.2, (0.0, 0.0, 0.93), 35.0, SMALL),
    look=Look(
        colors=wearing("beb228 be3282 286ec8 c8461e 1e966e", cloth="787c84", hair="181414"),
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


DANCE = Described(
    name="dance",
    perform=performed(dance.plan, actor(1.67, shin=1.03, trunk=0.97, hip_width=1.06), 120, 10.0),
    camera=look_from(14.0, 4.4, 1.5, (0.0, 0.0, 0.95), 47.0, SMALL),
    look=Look(
        colors=wearing("285abe ce2c2c 3ca03c d86e22 2896aa", cloth="463c42", skin="5c3e2e", hair="121010"),
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

BACK_SPIN = Described(
    name="back_spin",
    perform=performed(back_spin.plan, actor(1.66, trunk=0.99, shin=1.02, shoulder_width=1.04), 88, 8.0),
    camera=look_from(8.0, 4.2, 1.6, (0.0, 0.0, 0.94), 44.0, SMALL, tilt_deg=-1.0),
    look=Look(
        colors=wearing("aa463c 46aa5a 4664d2 dcaa28 be3caa", cloth="2c303c", skin="543a2c", hair="c8a050"),
        girths={"trunk": 0.95, "thigh": 1.06},
        cloth_m={"trunk": 0.008, "forearm": 0.010, "shin": 0.012},
        folds=0.6,
    ),
    room=Room(wall=(0.46, 0.48, 0.60)),
    seed=118,
    samples=1,
)
"""Begins from behind, turns to the front and on to the back, between keyframes spread evenly."""
