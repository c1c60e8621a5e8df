"""Load Motion and Mend Motion: from a file onto an armature, and onto an actor for any character."""

from pathlib import Path

import bpy
import pytest
from _performances import seen_by_network, stepping, write_mhr70
from keymark.operators.bridge.actor_bones import is_actor, moves_an_actor
from keymark.operators.bridge.motions.mend_action import SOURCE

FRAMES = 24


@pytest.fixture
def network(tmp_path: Path) -> Path:
    """A network's points as a csv."""
    body, posture = stepping()
    write_mhr70(tmp_path / "network.csv", seen_by_network(body.points(body.pose(posture[:FRAMES]))))
    return tmp_path / "network.csv"


def test_a_motion_is_loaded_mended_and_put_onto_an_actor(registered: None, network: Path) -> None:
    scene = bpy.context.scene
    scene.render.fps, scene.frame_start = 30, 11
    assert bpy.ops.keymark.load_motion(filepath=str(network)) == {"FINISHED"}
    loaded = bpy.context.object
    assert loaded.name == "network" and is_actor(loaded) and scene.render.fps == 30
    assert tuple(loaded.animation_data.action.frame_range) == (11.0, 11.0 + FRAMES - 1)
    given = loaded.animation_data.action
    assert bpy.ops.keymark.mend_motion(posed="12, 20") == {"FINISHED"}
    made = loaded.animation_data.action
    assert made[SOURCE] == given and moves_an_actor(made)
    assert bpy.ops.keymark.mend_motion(onto="ACTOR") == {"FINISHED"}
    actor = bpy.context.object
    assert actor != loaded and is_actor(actor) and moves_an_actor(actor.animation_data.action)
    assert tuple(actor.animation_data.action.frame_range) == (11.0, 11.0 + FRAMES - 1)


def test_what_cannot_be_done_is_said(registered: None, network: Path) -> None:
    assert not bpy.ops.keymark.mend_motion.poll()
    with pytest.raises(RuntimeError, match="No file is chosen; choose a motion"):
        bpy.ops.keymark.load_motion()
    with pytest.raises(RuntimeError, match="no such file"):
        bpy.ops.keymark.load_motion(filepath=str(network.with_name("other.csv")))
    bpy.ops.keymark.load_motion(filepath=str(network))
    before = bpy.context.object.animation_data.action
    with pytest.raises(RuntimeError, match="Posed Frames is soon"):
        bpy.ops.keymark.mend_motion(posed="soon")
    with pytest.raises(RuntimeError, match="Posed frame 500 is not in Action"):
        bpy.ops.keymark.mend_motion(posed="500")
    assert bpy.context.object.animation_data.action == before
