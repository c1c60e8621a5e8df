"""Learning a library from a finished motion: its postures at distinct frames, spread over shape and time."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray
from ..body.human import ANKLES
from ..body.kinematics import Body
from ..body.posture import Posture, headings_rad, turned_and_shifted, yaw_rotation
from ..body.skeleton import SIDES
from ..errors import InputError
from .library import Library, LibraryMotion, LibraryPosture, MotionStep
from .texts import LONGEST_NAME, identifier_from

FEWEST, MOST = 10, 40  # default bounds of the number of postures
DECIMALS_S = 3


@dataclass(frozen=True)
class LibraryMetadata:
    """Title, author and license of a library that is made."""

    title: str
    author: str
    license: str = "LicenseRef-Proprietary"  # SPDX expression; by default all rights are reserved
    identifier: str = ""  # by default derived from the title


def learn_library(
    body: Body, posture: Posture, time_s: Array, about: LibraryMetadata, count: int | None = None
) -> Library:
    """Turn a finished motion into a library of one motion.

    `count` of postures: by default as many as are distinct, from 10 to 40.

    Raises:
        InputError: The motion has fewer frames than the postures asked for, or stands still.
    """
    frames = len(time_s)
    fewest = 2 if count is None else count
    if count is not None and not 2 <= count <= 1000:
        raise InputError(f"the count of postures is {count}; 2 to 1000 are valid")
    if frames < fewest:
        raise InputError(f"the motion has {frames} frames; a library of it needs at least {fewest} frames")
    shape = shape_vectors(body, posture)
    if np.linalg.norm(shape - shape[0], axis=1).max() < 0.01:  # [m]
        raise InputError("the motion stands still; a library needs postures that differ")
    posture = on_floor(body, posture, time_s)
    duration_s, time_s = float(time_s[-1] - time_s[0]), time_s - time_s[0]
    # The mean heading counts as straight ahead, or the first where headings go all round.
    heading = headings_rad(posture)
    x, y = np.sin(heading).mean(), np.cos(heading).mean()
    turn = -float(np.arctan2(x, y)) if np.hypot(x, y) > 0.5 else -float(heading[0])
    shift = turned_and_shifted(posture[:1], turn, np.zeros(3)).translation[0] * [-1.0, -1.0, 0.0]
    posture = turned_and_shifted(posture, turn, shift)
    chosen = spread_frames(shape_vectors(body, posture), time_s, duration_s, count)
    names = numbered_names(about.title, len(chosen))
    left, right = np.moveaxis(ankle_heights(body, posture[chosen]), -1, 0)
    higher = [left - right > 0.08, right - left > 0.08]  # [m], of a foot that is lifted
    tags = np.select(higher, ["left foot up", "right foot up"], "").tolist()
    motion = LibraryMotion(
        name=about.title,
        steps=tuple(
            MotionStep(name, round(float(time_s[frame]), DECIMALS_S))
            for name, frame in zip(names, chosen, strict=True)
        ),
        duration_s=round(duration_s, DECIMALS_S),
    )
    return Library(
        identifier=about.identifier or identifier_from(about.title),
        title=about.title,
        version=1,
        author=about.author,
        license=about.license,
        actor=body.actor,
        postures=tuple(
            LibraryPosture(name, posture[int(frame)], (tag,) if tag else ())
            for name, frame, tag in zip(names, chosen, tags, strict=True)
        ),
        motions=(motion,),
    )


def on_floor(body: Body, posture: Posture, time_s: Array) -> Posture:
    """Shift a motion of F frames at times (F,) [s] so that its floor, where the lower foot rests, is at 0."""
    lower = ankle_heights(body, posture).min(axis=-1)
    slow = np.abs(np.gradient(lower, time_s)) < 0.15  # [m/s], of a foot that rests
    floor_m = float(np.median(lower[slow]) if slow.any() else np.quantile(lower, 0.1))
    return turned_and_shifted(posture, 0.0, np.array([0.0, 0.0, -floor_m]))


def spread_frames(shape: Array, time_s: Array, duration_s: float, count: int | None) -> IndexArray:
    """Frames spread over shape and time by farthest point sampling, the first and the last among them.

    `shape` (F, N) [m] at times (F,) from 0; `count`: by default as many as are distinct, from 10 to 40.
    """
    wanted = min(len(shape), MOST if count is None else count)
    tenth = max(1, round(0.1 * duration_s * (len(time_s) - 1) / max(time_s[-1] - time_s[0], 1e-9)))
    tenth = min(tenth, len(shape) - 1)
    pace = float(
        np.linalg.norm(shape[tenth:] - shape[:-tenth], axis=1).mean()
    )  # [m] in a tenth of the motion
    chosen: list[int] = []
    nearest = np.full(len(shape), np.inf)
    nearest_shape = np.full(len(shape), np.inf)

    def choose(frame: int) -> None:
        chosen.append(frame)
        apart = np.linalg.norm(shape - shape[frame], axis=1)
        later = np.abs(time_s - time_s[frame])
        in_time = 0.5 * pace * later / (0.1 * duration_s)  # even coverage in time counts half as much
        np.minimum(nearest, np.hypot(apart, in_time), out=nearest)
        np.minimum(nearest_shape, apart, out=nearest_shape)

    choose(0)
    choose(len(shape) - 1)
    while len(chosen) < wanted:
        if count is None and len(chosen) >= FEWEST and nearest_shape.max() < 0.06:
            break  # every frame is this near [m] to a chosen one in shape
        choose(int(nearest.argmax()))
    return np.array(sorted(chosen), dtype=np.intp)


def numbered_names(title: str, count: int) -> list[str]:
    """Names of postures that begin with their library's title."""
    digits = len(str(count))
    stem = title[: LONGEST_NAME - 1 - digits].rstrip()
    return [f"{stem} {number:0{digits}}" for number in range(1, count + 1)]


def shape_vectors(body: Body, posture: Posture) -> Array:
    """Shape vectors (F, 3 P); their distance is the root mean square distance of the points [m].

    They are the principal points relative to the ground below the hips, the performer facing -Y.
    """
    points = body.points(body.pose(posture))
    ground = posture.translation * [1.0, 1.0, 0.0]
    turn = yaw_rotation(-headings_rad(posture))
    seen = (points - ground[..., None, :]) @ np.swapaxes(turn, -1, -2)
    return np.asarray(seen.reshape(*posture.batch, -1) / np.sqrt(points.shape[-2]))


def ankle_heights(body: Body, posture: Posture) -> Array:
    """Heights (F, 2) of the left and the right ankle over those of feet flat on z = 0 [m].

    Ankles tell the floor's height, as soles do not: the skeleton's feet, rigid with the shins, point into the
    floor at the end of a step.
    """
    points = body.points(body.pose(posture))
    below = [0.36 * body.actor.segments_m[f"foot.{side}"] for side in SIDES]
    return np.asarray(points[..., ANKLES, 2] - below)
