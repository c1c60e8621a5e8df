"""Description of a take: motion, performer, room, camera and light."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.actor import SHARES_OF_STATURE, Actor
from keymark.core.body.kinematics import Body
from keymark.core.camera.camera import Camera

from .build import Build
from .look import Look
from .performance import FPS, Choreography, Performance, compose, principal_points, stored_times
from .surroundings import Room, Thing

Plan = Callable[[Body, Array, np.random.Generator], Choreography]
SHADOW_CLOSE_BY = (0.08, 0.30, 0.0)
KEYFRAME_EVERY = 10.0
SHUTTER_FRAMES = 0.5
HANDS_TO_BOX_M = 0.13
BOX_M = (0.34, 0.24, 0.20)
CARDBOARD, PAINTED = (0.34, 0.24, 0.13), (0.26, 0.26, 0.28)
KEYFRAME_LATENESS = 0.38
"""Largest deviation of a keyframe from even spacing, as a share of it."""


def nothing(performance: Performance) -> tuple[Thing, ...]:
    """No props."""
    return ()


@dataclass(frozen=True)
class Described:
    """One take."""

    name: str
    """Name of the take and of its folder."""
    perform: Callable[[int], Performance]
    """Maps the seed to the motion."""
    camera: Camera
    """The clip's camera."""
    look: Look = field(default_factory=Look)
    """The performer's appearance."""
    room: Room = field(default_factory=Room)
    """The performer's surroundings."""
    props: Callable[[Performance], tuple[Thing, ...]] = nothing
    """Further things, positioned by the performance."""
    seed: int = 34
    """Seed of the sway, the sensor noise, the posing errors, and the frames of keyframes."""
    keyframes: tuple[int, ...] = ()
    """Indices of the posed frames; chosen by the seed if empty."""
    postures: bool = False
    """Whether keyframes.json has the whole postures, or only their thirteen points."""
    moments: int = 3
    """Renders per frame while the shutter is open."""
    shutter_frames: float = SHUTTER_FRAMES
    """How long the shutter is open, at most 2 frames."""
    samples: int = 2
    """Light paths per pixel of each render."""
    noise: float = 1.5
    """Sensor noise, in eight-bit steps."""
    quality: str = "HIGH"
    """Quality of the encoding, one of Blender's constants."""
    side: Camera | None = None
    """A second camera, for reference only."""
    detected: bool = False
    """Whether the studio's detector looks at it too; take.json then names the other evidence as its own."""
    plain: bool = False
    """Whether no garment is a marker; `detected` it is held against keypoints and contours then."""
    shadow_per_height: tuple[float, float, float] = SHADOW_CLOSE_BY
    """Offset of a point's shadow on the floor, per meter of height."""

    def surroundings(self, performance: Performance) -> Room:
        """The room with everything in it."""
        return replace(self.room, things=self.room.things + self.props(performance))

    def posed_frames(self, frame_count: int) -> tuple[int, ...]:
        """Indices of the posed frames, rising, including the first and the last."""
        return self.keyframes or posed_frames(frame_count, np.random.default_rng(self.seed))


def posed_frames(frame_count: int, random: np.random.Generator) -> tuple[int, ...]:
    """About ten frames of a hundred, spread roughly evenly, as people do."""
    gaps = max(round((frame_count - 1) / KEYFRAME_EVERY), 1)
    distance = (frame_count - 1) / gaps
    lateness = KEYFRAME_LATENESS * distance * random.uniform(-1.0, 1.0, gaps - 1)
    between = np.rint(distance * np.arange(1, gaps) + lateness).astype(int)
    return (0, *(int(index) for index in between), frame_count - 1)


def performed(
    plan: Plan,
    actor: Actor,
    frame_count: int,
    heading_deg: float = 0.0,
    tempo: float = 1.0,
    fps: int = FPS,
    build: Build | None = None,
) -> Callable[[int], Performance]:
    """Map from a seed to an actor's performance of a plan.

    Args:
        plan: The motion, in seconds from the take's start.
        actor: The performer.
        frame_count: Frames of the take.
        heading_deg: Rotation of the whole motion to the left about the world's origin.
        tempo: Speed factor; gravity is right only at 1.
        fps: Frames per second.
        build: Where the performer's joints lie, if not where the skeleton's do.
    """

    def perform(seed: int) -> Performance:
        body, times = Body(actor), stored_times(frame_count)
        planned = plan(body, tempo * times / fps, np.random.default_rng(seed))
        return replace(compose(body, times, planned.turned(heading_deg), fps), build=build)

    return perform


LIMBS = {"upper_arm": 0.186, "forearm": 0.146, "thigh": 0.245, "shin": 0.246}
"""Shares of stature of performers, whose limbs are not those that Keymark takes for average."""


def actor(stature_m: float, **changed: float) -> Actor:
    """An actor of a height [m] whose segments differ from the average by factors; `thigh` changes both."""
    lengths = {}
    for name, share in SHARES_OF_STATURE.items():
        part = name.split(".")[0]
        lengths[name] = LIMBS.get(part, share) * stature_m * changed.get(part, 1.0)
    return Actor(lengths)


def lifted_onto_a_stand(performance: Performance, first: int, last: int) -> tuple[Thing, ...]:
    """A box that moves with the hands from a first to a last frame, and the stand on which they leave it."""
    indices = performance.middles[first : last + 1]
    names = performance.body.skeleton.point_names
    points = dict(zip(names, np.swapaxes(principal_points(performance, indices), 0, 1), strict=True))
    wrists = 0.5 * (points["wrist.L"] + points["wrist.R"])
    elbows = 0.5 * (points["elbow.L"] + points["elbow.R"])
    ahead = (wrists - elbows) / np.linalg.norm(wrists - elbows, axis=-1, keepdims=True)
    path = {first + row: (*place,) for row, place in enumerate((wrists + HANDS_TO_BOX_M * ahead).tolist())}
    x, y, z = path[last]
    top = z - 0.5 * BOX_M[2]
    return (
        Thing(BOX_M, CARDBOARD, path),
        Thing((0.42, 0.30, 0.04), PAINTED, {0: (x, y, top - 0.02)}),
        Thing((0.05, 0.05, top - 0.04), PAINTED, {0: (x, y, 0.5 * top - 0.02)}),
    )
