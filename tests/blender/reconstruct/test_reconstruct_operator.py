"""Reconstruction and proposals in a scene: stored, reused and replaced results."""

import bpy
import numpy as np
import pytest
from keymark.core.take.take import Take
from keymark.operators.shell import results
from keymark.operators.shell.job_progress import time_left
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture
def take(tiny_take: Take, monkeypatch: pytest.MonkeyPatch) -> bpy.types.PropertyGroup:
    """The tiny take in the scene; nothing is remembered of other tests."""
    results.clear_cache()
    bpy.ops.keymark.open_take(filepath=str(tiny_take.folder))
    return active_take(bpy.context.scene)


@pytest.fixture
def passes(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    from keymark.core.markers import reading as read_clip

    counted: list[int] = []
    original = read_clip.detect_markers

    def sight(*arguments):
        counted.append(1)
        return original(*arguments)

    monkeypatch.setattr(read_clip, "detect_markers", sight)
    return counted


def test_the_clip_is_read_once_for_proposals_and_every_method(
    take: bpy.types.PropertyGroup, passes: list[int]
) -> None:
    assert bpy.ops.keymark.propose_keyframes() == {"FINISHED"}
    assert len(take.proposals) >= 2 and results.reading_of(take) is not None
    for method in ("map", "ekf", "interpolation", "map"):
        take.method = method
        assert bpy.ops.keymark.reconstruct() == {"FINISHED"}
        review = results.review_of(take)
        assert review is not None and len(review.frames) == 13
        assert results.reading_of(take).key == take.reading_key
    bpy.ops.keymark.propose_keyframes()
    assert len(passes) == 1
    results.clear_cache()
    bpy.ops.keymark.reconstruct()
    assert len(passes) == 1


def test_another_color_has_the_clip_read_again(take: bpy.types.PropertyGroup, passes: list[int]) -> None:
    bpy.ops.keymark.reconstruct()
    before = take.reading_key
    red, green, blue = take.markers[0].color
    take.markers[0].color = (red, green + 0.01, blue)
    bpy.ops.keymark.reconstruct()
    assert len(passes) == 2 and take.reading_key != before


def test_running_again_replaces_generated_keys_in_the_same_action(take: bpy.types.PropertyGroup) -> None:
    from keymark.operators.bridge.actions import existing_channelbag

    bpy.ops.keymark.reconstruct()
    action, count = take.motion_action, len(bpy.data.actions)

    def values() -> np.ndarray:
        curves = existing_channelbag(action, take.armature).fcurves
        keys = [curve.keyframe_points for curve in curves if curve.data_path.startswith("pose.")]
        return np.array([point.co[1] for points in keys for point in points])

    first, posed = values(), len(existing_channelbag(take.keyframe_action, take.armature).fcurves)
    bpy.ops.keymark.reconstruct()
    assert take.motion_action == action and len(bpy.data.actions) == count
    np.testing.assert_allclose(values(), first, atol=1e-6)
    assert len(existing_channelbag(take.keyframe_action, take.armature).fcurves) == posed


def test_notes_of_the_last_run_stay_readable(take: bpy.types.PropertyGroup) -> None:
    take.camera.data.lens *= 1.12
    bpy.ops.keymark.reconstruct()
    assert any("lens" in note.text for note in take.notes)
    take.camera.data.lens /= 1.12
    bpy.ops.keymark.reconstruct()
    assert not any("lens" in note.text for note in take.notes)


def test_two_takes_keep_their_own_results(take: bpy.types.PropertyGroup) -> None:
    from types import SimpleNamespace

    from keymark.core.progress import run
    from keymark.operators.reconstruct.reconstruct import KEYMARK_OT_reconstruct
    from keymark.operators.shell.takes import add_take

    scene, identifier = bpy.context.scene, take.identifier
    said: list[str] = []
    job = SimpleNamespace(report=lambda kind, text: said.append(text))
    outcome = run(KEYMARK_OT_reconstruct.start(job, scene))
    other = add_take(scene, "Other").identifier
    KEYMARK_OT_reconstruct.finish(job, scene, outcome)
    takes = {one.identifier: one for one in scene.keymark.takes}
    assert takes[identifier].motion_action is not None and takes[other].motion_action is None
    assert not takes[other].review_key
    assert said[-1] == "Reconstructed 13 frames from 3 keyframes"


def test_time_left_is_said_once_it_can_be_told() -> None:
    assert time_left(0.5, 0.5) == time_left(10.0, 0.01) == ""
    assert time_left(10.0, 0.5) == "about 10 s left"
    assert time_left(17.0, 0.28) == "about 40 s left"
    assert time_left(60.0, 0.2) == "about 4 min left"
    assert time_left(100.0, 0.9999) == "about 1 s left"


def test_an_unchanged_take_is_not_estimated_again(take: bpy.types.PropertyGroup) -> None:
    from types import SimpleNamespace

    from keymark.operators.reconstruct.reconstruct import KEYMARK_OT_reconstruct

    bpy.ops.keymark.reconstruct()

    def previews() -> int:
        running = KEYMARK_OT_reconstruct.start(SimpleNamespace(), bpy.context.scene)
        return sum(progress.preview is not None for progress in running)

    assert previews() == 0
    bpy.context.scene.frame_set(5)
    assert previews() == 0
    channels = take.keyframe_action.layers[0].strips[0].channelbag(take.keyframe_action.slots[0])
    curve = channels.fcurves.find('pose.bones["upper_arm.L"].rotation_quaternion', index=1)
    curve.keyframe_points[1].co[1] += 0.05
    curve.update()
    assert previews() > 0


def test_one_keyframe_is_too_few_to_begin_with(take: bpy.types.PropertyGroup) -> None:
    scene, reconstruct = bpy.context.scene, bpy.ops.keymark.reconstruct
    take.keyframe_action = None
    take.armature.animation_data.action = None
    scene.frame_set(scene.frame_start)
    bpy.ops.keymark.store_keyframe()
    with pytest.raises(RuntimeError, match="there is only one"):
        reconstruct()
    scene.frame_set(scene.frame_start + 8)
    bpy.ops.keymark.store_keyframe()
    assert reconstruct.poll()


def test_an_actor_that_is_deleted_meanwhile_is_one_sentence(take: bpy.types.PropertyGroup) -> None:
    from types import SimpleNamespace

    from keymark.core.errors import InputError
    from keymark.core.progress import run
    from keymark.operators.finish.bake_motion import KEYMARK_OT_bake_motion
    from keymark.operators.reconstruct.reconstruct import KEYMARK_OT_reconstruct

    scene, job = bpy.context.scene, SimpleNamespace(report=lambda *_: None)
    take.method = "interpolation"
    bpy.ops.keymark.reconstruct()
    outcomes = [
        (kind, run(kind.start(job, scene))) for kind in (KEYMARK_OT_reconstruct, KEYMARK_OT_bake_motion)
    ]
    actions = len(bpy.data.actions)
    motion = take.motion_action
    take.motion_action = None
    with pytest.raises(InputError, match="motion has been deleted"):
        KEYMARK_OT_bake_motion.finish(job, scene, outcomes[1][1])
    take.motion_action = motion
    bpy.data.objects.remove(take.armature)
    for kind, outcome in outcomes:
        with pytest.raises(InputError, match="has no actor"):
            kind.finish(job, scene, outcome)
    assert len(bpy.data.actions) == actions and take.finish.action is None


def test_too_few_keyframes_are_counted_where_they_count(take: bpy.types.PropertyGroup) -> None:
    take.keyframe_action = bpy.data.actions.new("Elsewhere")
    for frame, said in (
        (40, None),
        (41, r"0 of the 2 keyframes that are needed lie in the footage.* Keys at 40, 41 lie outside"),
        (3, r"1 of the 2 keyframes that are needed lie in the footage.* Keys at 40, 41 lie outside"),
    ):
        bpy.context.scene.frame_set(frame)
        bpy.ops.keymark.store_keyframe()
        if said is not None:
            with pytest.raises(RuntimeError, match=said):
                bpy.ops.keymark.reconstruct()
    assert take.motion_action is None
