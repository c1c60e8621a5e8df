"""Armatures that move as a network's motion does."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from _armatures import build_character
from _characters import plain_character
from _performances import steps
from keymark.core.progress import run
from keymark.core.retarget.maps.map_registry import choose_map
from keymark.core.take.conversion_settings import LimbKeys, Placement, RetargetOptions
from keymark.operators.bridge.character.read_character import read_character
from keymark.operators.bridge.character.retarget import retarget
from keymark.operators.bridge.keys import mark_generated

FRAMES = 45
MoveFingers = Callable[[], bpy.types.Object]


@pytest.fixture
def shaken() -> bpy.types.Object:
    """An armature with an Action of 45 frames whose bones shake, a finger and the toes among them."""
    bpy.context.scene.render.fps = 30
    made = build_character(plain_character(scale=0.01))
    source = steps()
    short = type(source)(
        source.body,
        source.time_s[:FRAMES],
        *(
            {name: values[:FRAMES] for name, values in each.items()}
            for each in (source.turn, source.start, source.end)
        ),
    )
    character_map = choose_map(read_character(made), "none", ()).character_map
    options = RetargetOptions(
        place=Placement.CHARACTER, arms=LimbKeys.FK, legs=LimbKeys.FK, plant_feet=False, tolerance_mm=0.0
    )
    frames = np.arange(1.0, FRAMES + 1.0)
    run(retarget(made, short, frames, character_map, options)).write(bpy.context.scene, "Network")
    bag = made.animation_data.action.layers[0].strips[0].channelbags[0]
    rng = np.random.default_rng(0)
    for bone in ("finger.L", "toe.L"):
        made.pose.bones[bone].rotation_mode = "XYZ"
        for frame in range(1, FRAMES + 1, 4):
            made.pose.bones[bone].rotation_euler = rng.normal(0.0, 0.3, 3)
            made.pose.bones[bone].keyframe_insert("rotation_euler", frame=frame)
    for curve in bag.fcurves:
        if "finger" in curve.data_path or "toe" in curve.data_path:
            continue
        size = 2.0 if curve.data_path.endswith("location") else 0.02
        for key in curve.keyframe_points:
            key.co[1] += rng.normal(0.0, size)
        curve.update()
    mark_generated(bag)
    return made
