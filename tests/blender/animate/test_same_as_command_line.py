"""*Animate* gives what `keymark animate` does: the same motion, on Blender's floor, of moving cameras too."""

from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from _results import shown
from _synthetic_take import BODY, gliding, true_postures, write_shaken
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.body.rotations import exponential
from keymark.core.prior.learning import LibraryMetadata, learn_library
from keymark.core.take.motion import read_motion
from keymark.operators.bridge.footage_camera import may_move
from keymark.operators.cli.conversion import convert_take
from keymark.operators.cli.main import main
from keymark.operators.library import registry
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


ANKLES = [BODY.skeleton.point_names.index(f"ankle.{side}") for side in "LR"]


def points(posture: Posture) -> np.ndarray:
    """(13, 3) points of the performer [m]."""
    body = Body(Actor.from_stature(1.75))
    return np.asarray(body.points(body.pose(posture)))


def leaning() -> Posture:
    """Somebody who is upright at no moment, by which the camera and the floor would be found."""
    posture = gliding()
    rotations = posture.rotations.copy()
    rotations[:, 0] = exponential(np.array([0.0, 0.8, 0.0])) @ rotations[:, 0]
    return replace(posture, rotations=rotations)


@pytest.mark.parametrize(("posture", "turn_rad"), [(gliding(), 0.0), (gliding(), 0.02), (leaning(), 0.0)])
def test_button_and_command_line_go_the_same_way(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, posture: Posture, turn_rad: float
) -> None:
    write_shaken(tmp_path / "hall.mp4", posture, turn_rad)
    said = LibraryMetadata("Swaying", "Nobody")
    library = learn_library(BODY, true_postures(24), np.arange(24) / 30.0, said)
    monkeypatch.setattr(registry, "all_libraries", lambda: [library])
    monkeypatch.setattr(convert_take, "requested_libraries", lambda _name: (library,))
    clip, out = str(tmp_path / "hall.mp4"), tmp_path / "out"
    bpy.ops.keymark.animate(filepath=clip, stature=1.75, character="NONE")
    take = active_take(bpy.context.scene)
    take.armature.animation_data.action = take.motion_action
    here = [points(shown(take, frame)) for frame in range(1, 41)]
    followed = may_move(take.camera)
    assert main(["animate", clip, "--height", "1.75", "--output", str(out), "--no-report", "--quiet"]) == 0
    there = read_motion(out / "motion.json").points
    assert np.linalg.norm(np.array(here) - there, axis=-1).max() < 1e-3
    assert followed == (turn_rad > 0.0)
    placed = "upright at no two moments" not in take.camera_findings
    assert placed == np.allclose(
        posture.rotations, gliding().rotations
    )  # else the world was moved onto the floor
    assert abs(np.median(there[:, ANKLES, 2].min(axis=1)) - 0.08) < 0.04
    moved = out.rename(tmp_path / "moved")
    Path(clip).rename(tmp_path / "hall_of_before.mp4")
    bpy.ops.wm.open_mainfile(filepath=str(moved / "motion.blend"))
    assert Path(bpy.path.abspath(bpy.context.scene.active_clip.filepath)) == moved / "hall.mp4"
