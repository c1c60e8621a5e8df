"""What a take is made from: the motion, who performs it, where, seen and lit how."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body
from keymark.core.footage.camera import Camera

from .look import Look
from .performance import FPS, Choreography, Performance, compose, principal_points, stored_times
from .surroundings import Room, Thing

Plan = Callable[[Body, Array, np.random.Generator], Choreography]
SHADOW_CLOSE_BY = (0.08, 0.30, 0.0)
KEYFRAME_EVERY = 10.0
HANDS_TO_BOX_M = 0.13
BOX_M = (0.34, 0.24, 0.20)
CARDBOARD, PAINTED = (0.34, 0.24, 0.13), (0.26, 0.26, 0.28)
KEYFRAME_LATENESS = 0.38
"""How far a keyframe lies from an even spacing, at most, as a share of it."""


def nothing(performance: Performance) -> tuple[Thing, ...]:
    """No props."""
    return ()


@dataclass(frozen=True)
class Described:
    """One take."""

    name: str
    """The take's and its folder's."""
    perform: Callable[[int], Performance]
    """From the seed to the motion."""
    camera: Camera
    """The clip's."""
    look: Look = field(default_factory=Look)
    """The performer's."""
    room: Room = field(default_factory=Room)
    """What surrounds the performer."""
    props: Callable[[Performance], tuple[Thing, ...]] = nothing
    """Further things, whose places depend on the performance."""
    seed: int = 34
    """Of the sway, the sensor noise, the hand that poses keyframes, and their frames."""
    keyframes: tuple[int, ...] = ()
    """Indices of frames posed; chosen by the seed where empty."""
    postures: bool = False
    """Whether keyframes.json says the whole posture too, or its thirteen points only."""
    moments: int = 3
    """Renders while the shutter is open."""
    samples: int = 2
    """Light paths a pixel of each."""
    noise: float = 1.5
    """The sensor's, in eight-bit steps."""
    quality: str = "HIGH"
    """Of the encoding, in Blender's words."""
    side: Camera | None = None
    """A second camera, for reference only."""
    shadow_per_height: tuple[float, float, float] = SHADOW_CLOSE_BY
    """How far a point's shadow falls beside it on the floor, for each meter of height."""

    def surroundings(self, performance: Performance) -> Room:
        """The room with everything in it."""
        return replace(self.room, things=self.room.things + self.props(performance))

    def posed_frames(self, frame_count: int) -> tuple[int, ...]:
        """Indices of the frames posed, rising, the first and the last among them."""
        return self.keyframes or posed_frames(frame_count, np.random.default_rng(self.seed))


def posed_frames(frame_count: int, random: np.random.Generator) -> tuple[int, ...]:
    """About ten frames of a hundred, spread as people spread them: evenly but for some of the distance."""
    gaps = max(round((frame_count - 1) / KEYFRAME_EVERY), 1)
    distance = (frame_count - 1) / gaps
    lateness = KEYFRAME_LATENESS * distance * random.uniform(-1.0, 1.0, gaps - 1)
    between = np.rint(distance * np.arange(1, gaps) + lateness).astype(int)
    return (0, *(int(index) for index in between), frame_count - 1)


def performed(
    plan: Plan, actor: Actor, frame_count: int, heading_deg: float = 0.0, tempo: float = 1.0
) -> Callable[[int], Performance]:
    """From a seed to an actor's performance of a plan.

    Args:
        plan: The motion, in seconds from the take's start.
        actor: Who performs it.
        frame_count: Frames of the take.
        heading_deg: How far the whole is turned left about the world's origin.
        tempo: How fast it goes; gravity knows only 1.
    """

    def perform(seed: int) -> Performance:
        body, times = Body(actor), stored_times(frame_count)
        planned = plan(body, tempo * times / FPS, np.random.default_rng(seed))
        return compose(body, times, planned.turned(heading_deg))

    return perform


def actor(stature_m: float, **changed: float) -> Actor:
    """An actor of a height [m] whose parts differ from the average by factors; `thigh` changes both."""
    average = Actor.from_stature(stature_m).segments_m
    return Actor({name: length * changed.get(name.split(".")[0], 1.0) for name, length in average.items()})


def lifted_onto_a_stand(performance: Performance, first: int, last: int) -> tuple[Thing, ...]:
    """A box that stands where hands grasp it and goes with them from a first to a last frame, and a stand.

    The stand is where the hands leave the box.
    """
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
