"""Every step of the work is undone by one undo, redone by one redo, and saved in the file."""

import shutil
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from _scene_state import assert_undoable, differences, scene_state
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.operators.bridge.pose import write_posture
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")

Step = tuple[str, Callable[[], object]]


def steps(take: Take, motion: Motion, folder: Path) -> list[Step]:
    """The work from an empty scene to an asset, one operator a step."""
    ops = bpy.ops.keymark

    def pick() -> None:
        """Give every marker the color that it was drawn in."""
        for marker, style in zip(active_take(bpy.context.scene).markers, take.markers, strict=True):
            marker.color = [value / 255.0 for value in style.color_srgb]

    def align() -> None:
        camera = bpy.context.scene.camera
        camera.matrix_world = np.array(take.camera.matrix_world).T.tolist()
        camera.data.lens, camera.data.sensor_width = take.camera.lens_mm, take.camera.sensor_width_mm

    def store(index: int) -> Callable[[], None]:
        def pose_and_store() -> None:
            bpy.context.scene.frame_set(index + 1)
            write_posture(active_take(bpy.context.scene).armature, motion.posture[index])
            ops.store_keyframe()

        return pose_and_store

    return [
        ("load_footage", lambda: ops.load_footage(filepath=str(take.clip))),
        ("keep_lens", ops.keep_lens),
        ("align", align),
        ("add_usual_markers", ops.add_usual_markers),
        ("pick", pick),
        ("check_markers", ops.check_markers),
        ("ignore_region", lambda: ops.ignore_region(path=CORNER, radius=3.0)),
        ("remove_ignored_region", ops.remove_ignored_region),
        ("build_actor", lambda: ops.build_actor(stature=1.72)),
        ("apply_lengths", lambda: (_lengthen(), ops.apply_lengths())),
        ("propose_keyframes", ops.propose_keyframes),
        ("jump_to_proposal", lambda: ops.jump_to_proposal(direction="NEXT")),
        *((f"store_keyframe {index}", store(index)) for index in motion.keyframe_indices),
        ("reconstruct", ops.reconstruct),
        ("show_action", lambda: ops.show_action(which="KEYFRAMES")),
        ("pose_from_motion", lambda: (bpy.context.scene.frame_set(4), ops.pose_from_motion(where="CURRENT"))),
        ("reconstruct again", ops.reconstruct),
        ("bake_motion", ops.bake_motion),
        ("mark_asset", lambda: (_no_catalog(), ops.mark_asset())),
        ("add_performer", ops.add_performer),
        ("open_take", lambda: ops.open_take(filepath=str(take.folder))),
        ("choose", lambda: setattr(bpy.context.scene.keymark, "active_take", 0)),
        ("relocate_clip", lambda: ops.relocate_clip(filepath=str(shutil.copy(take.clip, folder / "b.mp4")))),
        ("remove_take", ops.remove_take),
    ]


CORNER = [{"name": "", "loc": (4.0, 4.0 + number), "time": 0.0} for number in range(3)]
"""A short stroke of the brush, where no marker is."""


def _lengthen() -> None:
    active_take(bpy.context.scene).lengths.forearm_L *= 1.05


def _no_catalog() -> None:
    active_take(bpy.context.scene).finish.catalog = ""


def test_every_step_is_undone_and_redone_and_the_whole_work_is_in_the_file(
    tiny_take: Take, wave_motion: Motion, tmp_path: Path
) -> None:
    assert_undoable(steps(tiny_take, wave_motion, tmp_path))
    before = scene_state()
    blend = tmp_path / "work.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(blend), relative_remap=False)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    assert not len(bpy.context.scene.keymark.takes)
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    assert not differences(before, scene_state())
