"""Matching in a scene with a library that the animator names."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from _found import made_up_frames, shown, wave_library
from keymark.core.library.library import LibraryMotion, MotionStep
from keymark.core.library.library_file import write_library
from keymark.core.posing import match_clip as matching
from keymark.core.posing.found_poses import FoundPoses
from keymark.core.progress import Progress
from keymark.core.take.motion import Motion
from keymark.operators.library import registry_files
from keymark.operators.shell.keyed_frames import keyframes_of, matched_frames, posed_frames
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")

Group = bpy.types.PropertyGroup


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch, wave_motion: Motion) -> dict[str, object]:
    """A stand-in for matching, and what it was asked for; its `frames` may be changed."""
    record: dict[str, object] = {"frames": {0: 0.9, 6: 0.3, 12: 0.7}, "fit": 0.75}

    def match(take, reading, library, floor_m=None, keyframe_count=None):  # noqa: ANN001, ANN202
        record.update(library=library.identifier, floor_m=floor_m)
        yield Progress("Matching Waves", 0.5)
        frames, said = made_up_frames(wave_motion, record["frames"]), "Waves explains some of the footage"
        return FoundPoses(frames, wave_motion.posture, record["fit"], 0.02, said, library=library.identifier)

    monkeypatch.setattr(matching, "match_clip", match)
    monkeypatch.setattr(registry_files, "load_registered", lambda name: wave_library(wave_motion, name))
    return record


def test_a_named_library_alone_is_matched(
    unposed: Group, asked: dict[str, object], capfd: pytest.CaptureFixture[str]
) -> None:
    """Its postures are keyed as found; how many of them are doubtful, and that it may not fit, is said."""
    assert bpy.ops.keymark.match_library(library="waves", floor="HEIGHT", floor_height=0.4) == {"FINISHED"}
    take = active_take(bpy.context.scene)
    assert (asked["library"], asked["floor_m"]) == ("waves", pytest.approx(0.4))
    assert (matched_frames(take), posed_frames(take)) == ((1.0, 7.0, 13.0), ())
    assert {match.library for match in take.matching.matches} == {"waves"}
    assert "probably shows something else" in take.matching.reason
    assert "3 keyframes found, 1 of them doubtful" in capfd.readouterr().out
    asked["fit"] = 0.95
    bpy.ops.keymark.match_library(library="waves")
    assert active_take(bpy.context.scene).matching.reason == "Waves explains some of the footage"


def test_matching_again_replaces_what_was_found(unposed: Group, asked: dict[str, object]) -> None:
    """Frames that are found no longer are keyed no longer."""
    bpy.ops.keymark.match_library(library="waves")
    asked["frames"] = {3: 0.9, 9: 0.9}
    bpy.ops.keymark.match_library(library="waves")
    take = active_take(bpy.context.scene)
    assert keyframes_of(take) == matched_frames(take) == (4.0, 10.0)
    assert len(bpy.data.actions) == 1


def test_what_is_found_near_a_posed_keyframe_moves_beside_it(
    unposed: Group, asked: dict[str, object]
) -> None:
    """There it tells how the performer differs from the library."""
    bpy.context.scene.frame_set(7)
    bpy.ops.keymark.store_keyframe()
    bpy.ops.keymark.match_library(library="waves")
    take = active_take(bpy.context.scene)
    assert (posed_frames(take), matched_frames(take)) == ((7.0,), (1.0, 4.0, 13.0))


def test_the_menu_holds_the_registry_and_what_was_chosen(unposed: Group) -> None:
    """All in one entry are none of it; a library that only another machine has is listed as missing."""
    state = unposed.matching
    first = state.library
    assert first and first != "auto"
    state.library_name = "auto"  # as earlier versions stored it
    assert state.library == first
    state.library = "walking"
    assert state.library_name == "walking"
    state.library_name = "dragging a cart"
    assert state.library == "dragging a cart"
    with pytest.raises(RuntimeError, match="no keyframe library 'dragging a cart'"):
        bpy.ops.keymark.match_library()
    state.library = "walking"
    assert state.library_name == "walking"


def test_footage_is_matched_with_a_library_file(
    unposed: Group,
    wave_motion: Motion,
    tmp_path: Path,
    shown_points: Callable[[bpy.types.Object], np.ndarray],
) -> None:
    """End to end: the library's postures are keyed where the performer stood in the drawn clip."""
    steps = tuple(MotionStep(f"Wave {i}", i / 25.0) for i in (0, 6, 12))
    waves = replace(wave_library(wave_motion), motions=(LibraryMotion("wave", steps, 12 / 25.0),))
    write_library(tmp_path / "waves.json", waves)
    assert bpy.ops.keymark.match_library(library=str(tmp_path / "waves.json")) == {"FINISHED"}
    take = active_take(bpy.context.scene)
    assert len(matched_frames(take)) >= 2 and take.matching.fit > 0.5
    for frame in (1, 13):
        bpy.context.scene.frame_set(frame)
        apart = np.linalg.norm(shown_points(take.armature) - wave_motion.points[frame - 1], axis=-1)
        assert apart.mean() < 0.15
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}


@pytest.mark.parametrize("mode", ["QUATERNION", "AXIS_ANGLE", "ZYX"])
def test_postures_are_keyed_in_any_rotation_mode(
    unposed: Group, asked: dict[str, object], mode: str, wave_motion: Motion
) -> None:
    """On a scaled actor, too: it shows the found postures, and they count as found."""
    for bone in unposed.armature.pose.bones:
        bone.rotation_mode = mode
    unposed.armature.scale = (1.5, 1.5, 1.5)
    bpy.context.view_layer.update()
    assert bpy.ops.keymark.match_library(library="waves") == {"FINISHED"}
    take = active_take(bpy.context.scene)
    assert len(matched_frames(take)) == 3 and not posed_frames(take)
    assert np.abs(shown(take, 7).minus(wave_motion.posture[6])[6:]).max() < 1e-4
