"""Single photographs in the studio, of good and of bad filming."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from keymark.core.arrays import Array, Image
from keymark.core.footage.camera import Camera
from studio.described import Described
from studio.filming import GAMMA, add_sensor_noise, place_camera, prepare_cycles, render
from studio.performer import build_performer
from studio.room import build_room


@dataclass(frozen=True, eq=False)
class Shot:
    """One photograph of a take."""

    take: Described
    """Who is filmed, how, and in what room; `samples` and `moments` are those of the photograph."""
    frame: int
    """Frame of the take."""
    words: str
    """What there is to see, in a few words."""
    passing: tuple[tuple[Described, int, tuple[float, float]], ...] = ()
    """Further performers: theirs is the first take's room; the frame of each, and by how far they stand
    elsewhere, in x and y [m]."""
    shaken: tuple[Camera, ...] = ()
    """Where else the camera is during the exposure, if it is not held still."""
    lines: tuple[Array, ...] = ()
    """Lines (N, 3) of the room [m] that are drawn over the photograph."""


def photograph(shot: Shot) -> Image:
    """Film one frame, with the shutter open as long as the take says.

    Returns:
        (height, width, 3) blue, green, red.
    """
    take = shot.take
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    performance = take.perform(take.seed)
    room = build_room(take.surroundings(performance))
    performer = build_performer(performance.body, take.look)
    for other, frame, (x, y) in shot.passing:
        moving = other.perform(other.seed)
        person = build_performer(moving.body, other.look)
        person.bend(moving, int(moving.middles[frame]))
        person.thing.location = (x, y, 0.0)
    prepare_cycles(take.seed)
    offsets = take.shutter_frames * ((np.arange(take.moments) + 0.5) / take.moments - 0.5)
    cameras = shot.shaken or (take.camera,)
    light = np.zeros((*take.camera.resolution[::-1], 3))
    for moment, index in enumerate(performance.at(shot.frame + offsets)):
        place_camera(cameras[moment * len(cameras) // take.moments])
        performer.bend(performance, int(index))
        light += render(take.samples) ** GAMMA / take.moments
    return add_sensor_noise(light ** (1.0 / GAMMA), np.random.default_rng(take.seed), take.noise)


def projected(camera: Camera, lines: Sequence[Array]) -> list[Array]:
    """Lines (N, 3) of the room as a camera sees them (N, 2) [px]."""
    return [camera.project(line)[0] for line in lines]
