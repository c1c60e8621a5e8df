"""Throws."""

from ..described import Described, actor, performed
from ..look import Look, wearing
from ..motions import throw, throw60
from ..viewpoint import look_from
from .sizes import MIDDLE, WIDE

THROW = Described(
    name="throw",
    perform=performed(throw.plan, actor(1.86, forearm=1.03, upper_arm=1.02), 66, -25.0, tempo=0.9),
    camera=look_from(20.0, 4.8, 1.6, (0.0, -0.05, 0.98), 42.0, WIDE),
    look=Look(
        colors=wearing("ecc428 a032aa dc4624 286ec8 329646"),
        girths={"upper_arm": 1.08, "thigh": 1.05},
        folds=0.5,
    ),
    seed=109,
    moments=2,
    samples=1,
)

THROW60 = Described(
    name="throw60",
    perform=performed(throw60.plan, actor(1.84, forearm=1.02, thigh=0.98), 112, 14.0, tempo=0.78, fps=60),
    camera=look_from(-22.0, 4.6, 1.45, (0.0, -0.05, 0.97), 42.0, MIDDLE),
    look=Look(
        colors=wearing("3c9682 e6b432 be3c96 c84628 465ac8", cloth="aaa496", skin="c8987a", hair="462c18"),
        girths={"upper_arm": 1.06, "thigh": 1.04},
    ),
    seed=119,
    keyframes=(0, 17, 35, 54, 68, 84, 99, 111),
    moments=4,
    shutter_frames=0.9,
    samples=1,
)
"""Sixty frames per second, each exposed nearly all its time."""
