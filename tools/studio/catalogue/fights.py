"""Kicks and punches."""

from ..build import Build
from ..described import Described, actor, performed
from ..look import Look, wearing
from ..motions import box, kick, martial
from ..surroundings import Lamp, Room
from ..viewpoint import look_from
from .sizes import SMALL

HARD_SHADOW = (2.0, 1.2, 0.0)

KICK = Described(
    name="kick",
    perform=performed(kick.plan, actor(1.70, upper_arm=0.95, shin=0.97, hip_width=1.1), 100, 12.0),
    camera=look_from(58.0, 4.8, 1.1, (0.05, -0.25, 0.98), 55.0, SMALL, tilt_deg=2.0),
    look=Look(
        colors=wearing("1c8278 dcaa1e c83ca0 3c5ad2 c83c28", cloth="c4c0b8", skin="e2b496"),
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
        colors=wearing("962222 2878c8 e6c832 3ca05a 963cb4", skin="aa785c"),
        girths={"upper_arm": 1.15, "forearm": 1.1, "trunk": 1.04},
    ),
    room=Room(
        lamps=(Lamp((-2.3, -1.9, 2.4), 0.35, 95.0, (1.0, 0.86, 0.68)), Lamp((2.6, -3.0, 1.4), 1.2, 7.0,
                                                                            (0.75, 0.85, 1.0))),
        sky=(0.7, 0.8, 1.0, 0.05), wall=(0.30, 0.27, 0.25),
    ),
    noise=3.0, seed=103, shadow_per_height=HARD_SHADOW,
)  # fmt: skip

MARTIAL = Described(
    name="martial",
    perform=performed(martial.plan, actor(1.76, shin=0.98, hip_width=1.04), 88, -4.0, build=Build()),
    camera=look_from(-36.0, 4.4, 1.3, (0.0, -0.12, 0.97), 48.0, SMALL, tilt_deg=1.0),
    look=Look(
        colors=wearing("dc8c28 4646c8 c4303c 3caa96 aa3c96", cloth="424a3c", skin="a07054", hair="1a1614"),
        girths={"thigh": 1.08, "upper_arm": 1.1, "forearm": 1.06},
        folds=0.6,
    ),
    room=Room(wall=(0.50, 0.58, 0.58)),
    seed=114,
    moments=4,
    samples=1,
)
"""The performer's joints lie up to two centimeters beside the skeleton's; no posture reaches them all."""
