"""What the tests of footage share: the active take with the tiny clip loaded."""

import bpy
import pytest
from keymark.core.take.take import Take
from keymark.operators.shell.takes import active_take


@pytest.fixture
def loaded(registered: None, tiny_take: Take) -> bpy.types.PropertyGroup:
    assert bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip)) == {"FINISHED"}
    return active_take(bpy.context.scene)
