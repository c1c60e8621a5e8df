"""The actor follows a running job, and everything is as before when it ends."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from keymark.core.body.posture import Posture
from keymark.core.progress import Preview, Progress
from keymark.core.take.take import Take
from keymark.operators.reconstruct.live_preview import LivePreview
from keymark.operators.reconstruct.reconstruct import KEYMARK_OT_reconstruct
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")
FRAMES = np.arange(1.0, 14.0)


@pytest.fixture
def actor(tiny_take: Take) -> bpy.types.Object:
    bpy.ops.keymark.open_take(filepath=str(tiny_take.folder))
    bpy.context.scene.frame_set(6)
    actor = active_take(bpy.context.scene).armature
    actor.pose.bones["head"].rotation_quaternion = (0.9, 0.1, 0.0, 0.0)
    return actor


@pytest.fixture
def one(tiny_take: Take) -> Posture:
    """A batch of one posture."""
    return Posture.stack([tiny_take.keyframes[0].posture])


def state(actor: bpy.types.Object) -> tuple[object, ...]:
    data = actor.animation_data
    pose = [tuple(bone.matrix_basis.col[k]) for bone in actor.pose.bones for k in range(4)]
    scene = bpy.context.scene
    return data.action, data.action_slot, scene.frame_current, scene.frame_subframe, pose


def test_the_actor_goes_through_the_frames_and_back(
    actor: bpy.types.Object, tiny_take: Take, shown_points: Callable[[bpy.types.Object], np.ndarray]
) -> None:
    before = state(actor)
    posture = tiny_take.keyframes[1].posture
    preview = LivePreview(bpy.context.scene, actor, FRAMES)
    batch = Posture.stack([posture.plus(np.full(34, 0.01 * k)) for k in range(5)])
    seen = []
    for _ in range(6):
        preview.show(Preview(3, batch))
        place = bpy.context.scene.frame_current - 4
        seen.append(place)
        expected = tiny_take.body.points(tiny_take.body.pose(batch[place]))
        np.testing.assert_allclose(shown_points(actor), expected, atol=1e-4)
    assert seen == [0, 1, 2, 3, 4, 0]
    assert actor.animation_data.action is None
    preview.end()
    assert state(actor) == before
    preview.end()


def test_a_file_saved_meanwhile_holds_nothing_of_the_preview(
    actor: bpy.types.Object, one: Posture, tmp_path: Path
) -> None:
    before = state(actor)
    preview = LivePreview(bpy.context.scene, actor, FRAMES)
    preview.show(Preview(9, one))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"), copy=True)
    assert state(actor) == before
    preview.show(Preview(9, one))
    assert bpy.context.scene.frame_current == 10
    preview.end()
    assert state(actor) == before
    assert not any(getattr(handler, "__self__", None) is preview for handler in bpy.app.handlers.save_pre)


def test_a_preview_of_what_was_removed_ends_quietly(actor: bpy.types.Object, one: Posture) -> None:
    preview = LivePreview(bpy.context.scene, actor, FRAMES)
    preview.show(Preview(0, one))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    preview.end()
    assert not bpy.data.armatures and bpy.context.scene.frame_current == 1
    assert not any(getattr(handler, "__self__", None) is preview for handler in bpy.app.handlers.save_pre)


@pytest.mark.parametrize("method", ["map", "ekf"])
def test_a_reconstruction_hands_out_what_it_has_found(actor: bpy.types.Object, method: str) -> None:
    active_take(bpy.context.scene).method = method
    before = state(actor)
    job = SimpleNamespace()
    running = KEYMARK_OT_reconstruct.start(job, bpy.context.scene)
    watched = 0
    for progress in running:
        assert isinstance(progress, Progress)
        KEYMARK_OT_reconstruct.watch(job, progress) if progress.preview else None
        watched += progress.preview is not None
        if watched == 3:
            break
    running.close()
    assert watched and state(actor) != before
    KEYMARK_OT_reconstruct.unwatch(job)
    assert state(actor) == before


def test_what_is_undone_meanwhile_is_not_the_preview(actor: bpy.types.Object, one: Posture) -> None:
    bpy.ops.ed.undo_push(message="Before")
    actor.location.x = 1.0
    bpy.ops.ed.undo_push(message="Moved")
    before = actor.animation_data.action.name, bpy.context.scene.frame_current
    preview = LivePreview(bpy.context.scene, actor, FRAMES)
    preview.show(Preview(9, one))
    held = []
    bpy.app.handlers.undo_pre.append(lambda *_: held.append(preview._changes))
    try:
        bpy.ops.ed.undo()
    finally:
        bpy.app.handlers.undo_pre.pop()
    assert held == [None]
    actor = active_take(bpy.context.scene).armature
    assert (actor.animation_data.action.name, bpy.context.scene.frame_current) == before
    assert actor.location.x == 0.0
    preview.show(Preview(9, one))
    preview.end()
    for name in ("save_pre", "undo_pre", "redo_pre"):
        handlers = getattr(bpy.app.handlers, name)
        assert not any(getattr(handler, "__self__", None) is preview for handler in handlers)
