"""A room about a take's performer, as somebody draws its lines over the picture, and clicks on the performer.

The takes have rooms of their own, which nobody measured. These are made up: lines that are truly plumb or
level lie where walls and floors are, and only what the picture shows of them is drawn, with a hand's errors.
"""

import numpy as np
from takes import load_project

load_project()

from keymark.core.arrays import Array  # noqa: E402
from keymark.core.body.body_volume import (  # noqa: E402
    HEAD_OVERSHOOT,  # noqa: E402
    standing_height_m,  # noqa: E402
)
from keymark.core.camera.camera import Camera  # noqa: E402
from keymark.core.camera.camera_evidence import CameraEvidence  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402

HAND_PX = 1.5
"""Error of a hand that draws [px]."""
TURNED_RAD = 0.6
"""Most by which a room is turned from the camera's view."""
BEHIND_M, BESIDE_M = (0.5, 2.5), (0.4, 2.2)
"""Where plumb lines are from the performer, and how far to each side."""
APART_M = (0.8, 2.0)
"""Between lines on the floor."""
LONGEST_M = 2.1
SHORTEST_SHARE = 0.12
"""Of the picture's height: shorter lines nobody draws."""
INSIDE = 0.02
"""Share of the picture at its edges that is left free."""
STEPS = 200
TRIES = 400
PLACES = 3
"""At which the performer is clicked on."""
STRAIGHT, STANDING_M, LEANING_M = 0.95, 0.2, 0.2
"""Of someone who stands straight: least height of the crown, as a share of the stature, largest height of an
ankle, and largest distance of the crown from over the feet [m]."""


def drawn_room(camera: Camera, truth: Array, random: np.random.Generator) -> CameraEvidence:
    """Two plumb lines and two level ones, as they are drawn.

    Args:
        camera: The true one.
        truth: (F, 13, 3) the performer, about whom the room is.
        random: Source of the room and of the hand's errors.
    """
    middle = truth.mean(axis=(0, 1)) * [1.0, 1.0, 0.0]
    rotation, location = camera.pose(0)
    ahead = (middle - location) * [1.0, 1.0, 0.0]
    ahead /= np.linalg.norm(ahead)
    right = np.array([ahead[1], -ahead[0], 0.0])
    angle = random.uniform(-TURNED_RAD, TURNED_RAD)
    along, across = (
        np.cos(angle) * ahead + np.sin(angle) * right,
        np.cos(angle) * right - np.sin(angle) * ahead,
    )

    def plumb(side: float) -> Array:
        foot = middle + random.uniform(*BEHIND_M) * ahead + side * random.uniform(*BESIDE_M) * right
        return foot + np.linspace(0.0, LONGEST_M, STEPS)[:, None] * [0.0, 0.0, 1.0]

    def level(side: float) -> Array:
        start = middle + side * 0.5 * random.uniform(*APART_M) * across + random.uniform(-1.0, 1.0) * along
        return start + np.linspace(-1.5, 1.5, STEPS)[:, None] * along

    return CameraEvidence(
        np.stack([_drawn(camera, plumb, side, random) for side in (-1.0, 1.0)]),
        np.stack([_drawn(camera, level, side, random) for side in (-1.0, 1.0)]),
    )


def _drawn(camera: Camera, line: "object", side: float, random: np.random.Generator) -> Array:
    """The ends (2, 2) of what the picture shows of one of many lines, the first that is long enough."""
    size = np.array(camera.resolution, dtype=np.float64)
    longest, best = 0.0, np.zeros((2, 2))
    for _ in range(TRIES):
        pixel, _ = camera.project(line(side), 0)
        with np.errstate(invalid="ignore"):
            inside = ((pixel > INSIDE * size) & (pixel < (1.0 - INSIDE) * size)).all(axis=-1)
        if inside.sum() < 2:
            continue
        ends = pixel[inside][[0, -1]]
        length = float(np.linalg.norm(ends[1] - ends[0]))
        if length > longest:
            longest, best = length, ends
        if length > SHORTEST_SHARE * size[1]:
            break
    return best + random.normal(0.0, HAND_PX, (2, 2))


def standing_clicks(take: Take, truth: Array, random: np.random.Generator) -> Array:
    """Clicks (N, 2, 2) on ground and crown [px], where the performer stands, in places far apart."""
    names = take.body.skeleton.point_names

    def middle(part: str) -> Array:
        return truth[:, [names.index(f"{part}.{side}") for side in "LR"]].mean(axis=1)

    shoulders, head = middle("shoulder"), truth[:, names.index("head")]
    crown = shoulders + HEAD_OVERSHOOT * (head - shoulders)
    ground = middle("ankle") * [1.0, 1.0, 0.0]
    pixel = np.stack([take.camera.project(each, np.arange(len(each)))[0] for each in (ground, crown)], axis=1)
    size = np.array(take.camera.resolution)
    seen = ((pixel > 0.0) & (pixel < size)).all(axis=(1, 2))
    feet = truth[:, [names.index(f"ankle.{side}") for side in "LR"], 2]
    stands = feet.max(axis=1) < STANDING_M
    stands &= np.linalg.norm((crown - ground)[:, :2], axis=-1) < LEANING_M
    stands &= seen & (crown[:, 2] > STRAIGHT * standing_height_m(take.body))
    frames = np.flatnonzero(stands)
    if not len(frames):
        return np.zeros((0, 2, 2))
    chosen = [int(random.choice(frames))]
    while len(chosen) < min(PLACES, len(frames)):
        apart = np.linalg.norm(pixel[frames, 0][:, None] - pixel[chosen, 0], axis=-1).min(axis=1)
        chosen.append(int(frames[apart.argmax()]))
    return pixel[chosen] + random.normal(0.0, HAND_PX, (len(chosen), 2, 2))
