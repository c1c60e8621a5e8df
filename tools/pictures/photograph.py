"""Single photographs in the studio."""

import bpy
import numpy as np
from keymark.core.arrays import Image
from keymark.operators.cli.blender_silence import blender_silence
from studio.filming import GAMMA, add_sensor_noise, place_camera, prepare_cycles, render
from studio.performer import build_performer
from studio.room import build_room

from .shot import Shot


def photograph(shot: Shot) -> Image:
    """Film one frame, with the shutter open as long as the take says.

    Returns:
        (height, width, 3) blue, green, red.
    """
    take = shot.take
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    performance = take.perform(take.seed)
    build_room(take.surroundings(performance))
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
    with blender_silence(debug=False):
        for moment, index in enumerate(performance.at(shot.frame + offsets)):
            place_camera(cameras[moment * len(cameras) // take.moments])
            performer.bend(performance, int(index))
            light += render(take.samples) ** GAMMA / take.moments
    return add_sensor_noise(light ** (1.0 / GAMMA), np.random.default_rng(take.seed), take.noise)
