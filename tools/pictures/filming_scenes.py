"""What the guide to filming shows: for each point a good photograph and a bad one."""

from dataclasses import replace

import numpy as np
from keymark.core.footage.camera import Camera
from studio import aerobic
from studio.catalogue.fights import BOX, KICK
from studio.catalogue.walks import STROLL
from studio.described import Described
from studio.look import CLOTH_M, Look
from studio.surroundings import WALL_BEHIND_Y, Lamp, Room, Thing
from studio.viewpoint import look_at, look_from

from .shot import Shot

SIZE = (472, 354)
"""Of a photograph [px]."""
MIDDLE = (0.2, 0.0, 0.95)
"""Of the performer [m]."""
ARMS_UP, KNEE_UP, STANDING = 66, 42, 0
"""Frames of the aerobic exercise."""
STRIKE, KICK_OUT = 27, 29
"""Frames of the kick in which the foot is fastest, and in which it is farthest out."""
SHARP, LONG = 0.1, 1.0
"""How long the shutter is open [frames]."""
PLANK = (205, 196, 178)
"""Color of clothes that are like the wall (sRGB)."""
TAPE = (0.85, 0.10, 0.06)


def _from(azimuth: float, distance: float, height: float, lens: float = 34.0, z: float = 0.95) -> Camera:
    return look_from(azimuth, distance, height, (*MIDDLE[:2], z), lens, SIZE)


GOOD = Described(
    name="good",
    perform=aerobic.perform,
    camera=_from(6.0, 4.2, 1.15),
    moments=1,
    shutter_frames=SHARP,
    samples=12,
    noise=0.8,
)
"""What all good photographs begin with."""
CHEST = replace(GOOD, camera=_from(6.0, 3.9, 1.1, 38.0))
KICKING = replace(
    GOOD,
    perform=KICK.perform,
    look=replace(KICK.look, cloth_m=CLOTH_M, folds=0.0),
    camera=look_from(58.0, 4.6, 1.1, (0.05, -0.2, 0.98), 44.0, SIZE),
)
WIDE_M, FOLDS = {"trunk": 0.036, "forearm": 0.024, "shin": 0.034}, 0.2
"""Clothes that do not show the body in them."""
PLAIN = Look(
    colors=dict.fromkeys(("trunk", "forearm.L", "forearm.R"), (38, 62, 104))
    | dict.fromkeys(("shin.L", "shin.R", "cloth"), (44, 44, 50)),
)
LIKE_THE_WALL = Look(
    colors=dict.fromkeys(("trunk", "forearm.L", "forearm.R", "shin.L", "shin.R", "cloth"), PLANK),
    cloth_m=WIDE_M,
    folds=FOLDS,
)
ALIKE = Look(
    colors={
        "trunk": (150, 120, 92),
        "forearm.L": (206, 170, 140),
        "forearm.R": (198, 160, 134),
        "shin.L": (128, 100, 84),
        "shin.R": (118, 96, 84),
    },
    cloth_m=WIDE_M,
    folds=FOLDS,
)
DIM = Room(lamps=(Lamp((2.9, 1.2, 2.5), 0.5, 120.0, (1.0, 0.86, 0.66)),), sky=(0.7, 0.8, 1.0, 0.05))
TABLE = (
    Thing((1.3, 0.6, 0.05), (0.26, 0.17, 0.10), {0: (0.55, -1.1, 0.74)}),
    Thing((0.06, 0.5, 0.72), (0.2, 0.13, 0.08), {0: (0.0, -1.1, 0.36)}),
    Thing((0.06, 0.5, 0.72), (0.2, 0.13, 0.08), {0: (1.1, -1.1, 0.36)}),
)
MARKS = tuple(
    Thing(size, TAPE, {0: (x, y, 0.002)})
    for x, y in ((-0.75, -0.35), (1.1, -0.35))
    for size in ((0.34, 0.07, 0.004), (0.06, 0.40, 0.008))
)
LINES = tuple(
    np.array(line)
    for line in (
        ((-2.0, WALL_BEHIND_Y - 0.15, 0.1), (-2.0, WALL_BEHIND_Y - 0.15, 2.2)),
        ((-1.1, WALL_BEHIND_Y - 0.15, 0.1), (-1.1, WALL_BEHIND_Y - 0.15, 2.2)),
        ((-1.0, WALL_BEHIND_Y - 0.025, 0.12), (2.2, WALL_BEHIND_Y - 0.025, 0.12)),
        ((0.84, WALL_BEHIND_Y - 0.03, 1.97), (1.46, WALL_BEHIND_Y - 0.03, 1.97)),
    )
)
"""Posts of the wall bars; the skirting, and the upper edge of a picture."""
BARE = Room(furnished=False, planks=((0.34, 0.32, 0.30),) * 3, wall=(0.62, 0.60, 0.57))

PAIRS: dict[str, tuple[Shot, Shot]] = {
    "distance": (
        Shot(CHEST, ARMS_UP, "fills three quarters of the height"),
        Shot(
            replace(GOOD, camera=_from(6.0, 6.6, 1.3, 24.0, 1.1)),
            ARMS_UP,
            "a third of the height: limbs are thin lines",
        ),
    ),
    "height": (
        Shot(CHEST, KNEE_UP, "camera level, at the height of the hips"),
        Shot(
            replace(GOOD, camera=_from(6.0, 2.5, 3.3, 30.0, 0.75)),
            KNEE_UP,
            "from above: legs and trunk shrink",
        ),
    ),
    "direction": (
        Shot(KICKING, KICK_OUT, "the kick goes across the view"),
        Shot(
            replace(KICKING, camera=look_from(21.0, 4.6, 1.1, (0.05, -0.2, 0.98), 44.0, SIZE)),
            KICK_OUT,
            "the kick goes into the lens",
        ),
    ),
    "still": (
        Shot(GOOD, KNEE_UP, "tripod: the room stays where it is"),
        Shot(
            replace(GOOD, moments=8, samples=3),
            KNEE_UP,
            "held by hand: the whole room moves",
            shaken=tuple(
                look_at(
                    (0.64 + 0.05 * share, -4.1, 1.15 + 0.03 * share),
                    (0.12 + 0.16 * share, 0.0, 0.98 + 0.05 * share),
                    34.0,
                    SIZE,
                    3.0 + 1.5 * share,
                )
                for share in np.linspace(0.0, 1.0, 8)
            ),
        ),
    ),
    "light": (
        Shot(GOOD, ARMS_UP, "bright, soft light from the camera's side"),
        Shot(replace(GOOD, room=DIM, noise=9.0), ARMS_UP, "one lamp behind, too little light"),
    ),
    "shutter": (
        Shot(KICKING, STRIKE, "open for 1/300 s: sharp"),
        Shot(
            replace(KICKING, moments=12, samples=3, shutter_frames=LONG), STRIKE, "open for 1/30 s: blurred"
        ),
    ),
    "clothes": (
        Shot(replace(GOOD, look=PLAIN), KNEE_UP, "close-fitting, unlike the room"),
        Shot(replace(GOOD, look=LIKE_THE_WALL), KNEE_UP, "wide, and like the wall"),
    ),
    "colors": (
        Shot(GOOD, STANDING, "five strong colors, each once"),
        Shot(replace(GOOD, look=ALIKE), STANDING, "like skin, floor and each other"),
    ),
    "whole": (
        Shot(GOOD, ARMS_UP, "room above the hands and below the feet"),
        Shot(replace(GOOD, camera=_from(6.0, 2.7, 1.2, 38.0, 1.2)), ARMS_UP, "hands and feet are cut off"),
    ),
    "alone": (
        Shot(GOOD, KNEE_UP, "one performer, nothing before them"),
        Shot(
            replace(GOOD, room=Room(things=TABLE)),
            KNEE_UP,
            "a table before the legs, another person",
            passing=((replace(STROLL, look=BOX.look), 44, (-0.75, 0.5)),),
        ),
    ),
    "room": (
        Shot(
            replace(GOOD, room=Room(things=MARKS)),
            STANDING,
            "upright and level lines, marks on the floor",
            lines=LINES,
        ),
        Shot(replace(GOOD, room=BARE), STANDING, "nothing tells how the camera stands"),
    ),
    "start": (
        Shot(CHEST, STANDING, "begins upright and still, for a second"),
        Shot(CHEST, 36, "begins in the middle of the motion"),
    ),
}
