"""Libraries learned from the motion of an Action."""

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.prior.learning import shape_vectors
from keymark.core.prior.library import read_library
from keymark.core.take.motion import Motion
from keymark.operators.bridge.armature import build_armature, read_body
from keymark.operators.bridge.fcurves import write_motion
from keymark.operators.library import registry
from keymark.operators.shell.takes import add_take

FRAMES = 50
NOBODY = "LicenseRef-Proprietary"


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(registry, "own_folder", lambda: tmp_path)
    return tmp_path


@pytest.fixture
def posture(wave_posture: Callable[[np.ndarray], Posture]) -> Posture:
    return wave_posture(np.linspace(0.0, 1.0, FRAMES) ** 2)


@pytest.fixture
def take(registered: None, body: Body, posture: Posture) -> bpy.types.PropertyGroup:
    """A take with that motion, in a scene whose actor was moved, turned and scaled."""
    scene = bpy.context.scene
    scene.render.fps, scene.frame_end = 30, FRAMES
    actor = build_armature(scene, body)
    actor.location, actor.scale, actor.rotation_euler = (0.4, -0.2, 0.1), (1.1, 1.1, 1.1), (0.0, 0.0, 0.7)
    actor.pose.bones["chest"].rotation_mode = "XYZ"
    bpy.context.view_layer.update()
    points = body.points(body.pose(posture))
    covariance = np.broadcast_to(1e-4 * np.eye(3), (FRAMES, 13, 3, 3))
    time_s = np.arange(FRAMES) / 30.0
    result = add_take(scene, "Take")
    result.armature = actor
    size = Body(read_body(actor).actor)
    motion = Motion(size, 30.0, 1, time_s, posture, points, covariance, (0,), "map")
    result.motion_action = write_motion(actor, motion)
    return result


def test_a_motion_becomes_a_library(take: bpy.types.PropertyGroup, posture: Posture, own: Path) -> None:
    assert bpy.ops.keymark.learn_library(count=12) == {"FINISHED"}
    (file,) = own.iterdir()
    library = read_library(file)
    assert (library.title, library.identifier, library.license) == ("Take", "take", NOBODY)
    assert len(library.postures) == 12 and len(library.motions[0].steps) == 12
    body = read_body(take.armature)
    assert library.actor.stature_m == pytest.approx(body.actor.stature_m, rel=1e-6)
    frames = [round(step.time_s * 30.0) for step in library.motions[0].steps]
    assert (frames[0], frames[-1]) == (0, FRAMES - 1)
    kept = Posture.stack([entry.posture for entry in library.postures])
    apart = shape_vectors(body, kept) - shape_vectors(body, posture[np.array(frames)])
    apart = apart.reshape(len(frames), -1, 3)
    apart -= apart.mean(axis=(0, 1)) * [0.0, 0.0, 1.0]  # the floor is found from the feet
    assert np.abs(apart).max() < 2e-3


def test_a_second_library_never_replaces_the_first(take: bpy.types.PropertyGroup, own: Path) -> None:
    for _ in range(2):
        assert bpy.ops.keymark.learn_library(title="Swing", author="Anna", license="CC0-1.0") == {"FINISHED"}
    assert sorted(file.name for file in own.iterdir()) == ["swing.json", "swing_2.json"]


def test_doing_it_again_in_another_way_replaces_it(take: bpy.types.PropertyGroup, own: Path) -> None:
    assert bpy.ops.keymark.learn_library(title="Swing") == {"FINISHED"}
    assert bpy.ops.keymark.learn_library(title="Swing", count=14, learned_as="swing") == {"FINISHED"}
    assert [file.name for file in own.iterdir()] == ["swing.json"]
    assert len(read_library(own / "swing.json").postures) == 14


def test_nothing_is_left_behind_where_it_fails(take: bpy.types.PropertyGroup, own: Path) -> None:
    actions = len(bpy.data.actions)
    for wrong, sentence in (({"license": "free for all!"}, "license"), ({"count": 500}, "50 frames")):
        with pytest.raises(RuntimeError, match=sentence):
            bpy.ops.keymark.learn_library(**wrong)
    assert list(own.iterdir()) == [] and len(bpy.data.actions) == actions


@pytest.mark.usefixtures("registered")
def test_without_a_motion_it_says_what_is_missing() -> None:
    with pytest.raises(RuntimeError, match="Build the actor first"):
        bpy.ops.keymark.learn_library()
