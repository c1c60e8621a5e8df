"""What the tests of the step Character share: a take with a motion, and a character beside it."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from _armatures import build_character
from _characters import plain_character
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.take.motion import Motion
from keymark.operators.bridge.armature import build_armature, read_body
from keymark.operators.bridge.fcurves import write_motion
from keymark.operators.shell.takes import add_take

FRAMES = 20


@pytest.fixture
def take(
    registered: None, body: Body, wave_posture: Callable[[np.ndarray], Posture]
) -> bpy.types.PropertyGroup:
    """A take with a reconstructed motion of FRAMES frames, nothing selected."""
    scene = bpy.context.scene
    scene.render.fps = 30
    scene.frame_end = FRAMES
    actor = build_armature(scene, body, "Walk Actor")
    size = read_body(actor)
    posture = wave_posture(0.5 - 0.5 * np.cos(np.linspace(0.0, 2.0 * np.pi, FRAMES)))
    points = size.points(size.pose(posture))
    covariance = np.broadcast_to(1e-4 * np.eye(3), (FRAMES, 13, 3, 3))
    motion = Motion(size, 30.0, 1, np.arange(FRAMES) / 30.0, posture, points, covariance, (0,), "map")
    result = add_take(scene, "Walk")
    result.armature = actor
    result.motion_action = write_motion(actor, motion)
    return result


@pytest.fixture
def rig() -> bpy.types.Object:
    """A plain character in the scene, under names that any convention has."""
    return build_character(plain_character())


@pytest.fixture
def character(take: bpy.types.PropertyGroup, rig: bpy.types.Object) -> bpy.types.PropertyGroup:
    """The plain character, added to the take and recognized."""
    assert bpy.ops.keymark.add_character(armature=rig.name) == {"FINISHED"}
    return take.characters[0]
