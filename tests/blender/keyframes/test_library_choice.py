"""Which libraries keyframes are sought with: all of them, or the one that the animator chooses."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from _scene_state import shown, wave_library
from keymark.core.prior.library import LibraryMotion, MotionStep, write_library
from keymark.core.take.motion import Motion
from keymark.operators.library import registry_files
from keymark.operators.shell.keyed_frames import matched_frames, posed_frames
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")

Group = bpy.types.PropertyGroup


def test_a_named_library_alone_is_asked(
    unposed: Group, given: SimpleNamespace, wave_motion: Motion, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(registry_files, "load_registered", lambda name: wave_library(wave_motion, name))
    unposed.matching.library_name = "jumping"
    for words, asked in (({}, ["jumping"]), ({"library": "waves"}, ["waves"])):
        assert bpy.ops.keymark.pose_all(**words) == {"FINISHED"}
        assert given.libraries[-1] == asked
    every = len(registry_files.all_libraries())
    bpy.ops.keymark.pose_all(library="auto")
    assert len(given.libraries[-1]) == every
    active_take(bpy.context.scene).matching.library = "auto"
    bpy.ops.keymark.pose_all()
    assert len(given.libraries[-1]) == every


def test_the_menu_holds_the_registry_and_what_was_chosen(unposed: Group) -> None:
    state = unposed.matching
    assert state.library == "auto" and state.library_name == ""
    state.library_name = "auto"
    assert state.library == "auto"
    state.library = "walking"
    assert state.library_name == "walking"
    state.library_name = "dragging a cart"
    assert state.library == "dragging a cart"
    with pytest.raises(RuntimeError, match="no keyframe library 'dragging a cart'"):
        bpy.ops.keymark.pose_all()
    state.library = "walking"
    assert state.library_name == "walking"


def test_poses_are_found_with_a_library_file(
    unposed: Group,
    wave_motion: Motion,
    tmp_path: Path,
    shown_points: Callable[[bpy.types.Object], np.ndarray],
) -> None:
    steps = tuple(MotionStep(f"Wave {i}", i / 25.0) for i in (0, 6, 12))
    waves = replace(wave_library(wave_motion), motions=(LibraryMotion("wave", steps, 12 / 25.0),))
    write_library(tmp_path / "waves.json", waves)
    assert bpy.ops.keymark.pose_all(library=str(tmp_path / "waves.json")) == {"FINISHED"}
    take = active_take(bpy.context.scene)
    assert len(matched_frames(take)) >= 2 and take.matching.fit > 0.5
    for frame in (1, 13):
        bpy.context.scene.frame_set(frame)
        apart = np.linalg.norm(shown_points(take.armature) - wave_motion.points[frame - 1], axis=-1)
        assert apart.mean() < 0.15
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}


@pytest.mark.parametrize("mode", ["QUATERNION", "AXIS_ANGLE", "ZYX"])
def test_postures_are_keyed_in_any_rotation_mode(
    unposed: Group, given: SimpleNamespace, mode: str, wave_motion: Motion
) -> None:
    for bone in unposed.armature.pose.bones:
        bone.rotation_mode = mode
    unposed.armature.scale = (1.5, 1.5, 1.5)
    bpy.context.view_layer.update()
    assert bpy.ops.keymark.pose_all() == {"FINISHED"}
    take = active_take(bpy.context.scene)
    assert len(matched_frames(take)) == 3 and not posed_frames(take)
    assert np.abs(shown(take, 7).minus(wave_motion.posture[6])[6:]).max() < 1e-4
