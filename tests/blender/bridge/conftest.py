"""What the bridge's tests share."""

import bpy
import pytest
from keymark.core.body.kinematics import Body
from keymark.operators.bridge.armature import build_armature


@pytest.fixture
def actor(body: Body) -> bpy.types.Object:
    """An actor in the scene."""
    return build_armature(bpy.context.scene, body)
