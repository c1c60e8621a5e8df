"""Walks."""

from ..described import Described, actor, performed
from ..look import Look, wearing
from ..motions import approach, duck, steps, stroll
from ..surroundings import Room, Thing
from ..viewpoint import look_at, look_from
from .sizes import SMALL

STROLL = Described(
    name="stroll",
    perform=performed(stroll.plan, actor(1.78, thigh=1.04, forearm=0.96), 90),
    camera=look_from(6.0, 4.1, 1.55, (0.0, 0.0, 0.98), 32.0, SMALL),
    look=Look(
        colors=wearing("c4362c 248c82 9646be 4664d2 d2b428", cloth="5c5042"),
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

APPROACH = Described(
    name="approach",
    perform=performed(approach.plan, actor(1.73, thigh=1.01, upper_arm=1.03, trunk=0.98), 66, 4.0),
    camera=look_at((0.35, -6.6, 1.25), (-0.02, -1.2, 0.98), 38.0, SMALL),
    look=Look(
        colors=wearing("be3c78 3296b4 e29628 6e50c8 46a03c", cloth="3c383c", skin="e2b496", hair="5a3c1e"),
        girths={"thigh": 1.04, "shin": 1.05},
    ),
    room=Room(wall=(0.44, 0.50, 0.44)),
    seed=115,
    samples=1,
)
"""A run toward the camera: feet touch the floor briefly, and the performer more than doubles in size."""

STEPS = Described(
    name="steps",
    perform=performed(steps.plan, actor(1.68, shin=0.98, trunk=1.03), 96),
    camera=look_from(86.0, 4.9, 1.25, (0.0, -0.08, 1.12), 44.0, SMALL),
    look=Look(
        colors=wearing("3c6ec8 dc5a28 50a046 c83282 dcbe32", cloth="463c38", skin="6e4c3a", hair="141010"),
        girths={"trunk": 1.08, "thigh": 1.06},
        folds=0.7,
    ),
    room=Room(
        wall=(0.58, 0.50, 0.46),
        things=tuple(
            Thing((1.0, length, steps.RISE_M), (0.30, 0.31, 0.33), {0: (0.0, middle, height)})
            for length, middle, height in steps.boxes()
        ),
    ),
    seed=116,
    samples=1,
)
"""Three steps, seen from the side: the near leg hides the far one, and the floor is not level."""

DUCK = Described(
    name="duck",
    perform=performed(duck.plan, actor(1.79, forearm=0.97, hip_width=1.05), 88),
    camera=look_from(22.0, 4.4, 1.35, (0.0, -0.05, 0.92), 38.0, SMALL, tilt_deg=1.5),
    look=Look(
        colors=wearing("96a032 3c50d2 d23c32 aa46b4 28a096", cloth="604638", skin="be8a6c", hair="3c281a"),
        cloth_m={"trunk": 0.011, "forearm": 0.008, "shin": 0.010},
        folds=0.7,
    ),
    room=Room(
        things=(
            Thing((0.14, 1.9, 0.14), (0.42, 0.08, 0.06), {0: (-0.15, -0.05, 1.30)}),
            Thing((0.12, 0.12, 1.23), (0.40, 0.40, 0.42), {0: (-0.15, -0.95, 0.615)}),
            Thing((0.12, 0.12, 1.23), (0.40, 0.40, 0.42), {0: (-0.15, 0.85, 0.615)}),
            Thing((0.50, 0.04, 0.34), (0.62, 0.60, 0.20), {0: (0.16, -0.97, 1.18)}),
        )
    ),
    seed=117,
    samples=1,
)
"""A bar, its post and a sign hide parts of the performer, who ducks under it."""
