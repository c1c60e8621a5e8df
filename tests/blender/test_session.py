"""docs/session.py, run as it stands."""

import importlib.util
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import bpy
import numpy as np
import pytest
from keymark.core.review.score import read_truth
from keymark.operators.bridge.keys import animator_frames
from keymark.operators.shell.take_state import TakeState

pytestmark = [pytest.mark.usefixtures("registered"), pytest.mark.slow]

FRAMES = 118
KEYFRAMES = [1, 9, 16, 24, 31, 43, 54, 67, 81, 95, 107, 118]
FARTHEST_MM = 15.0
"""Between the final motion and the truth; the reconstruction is 8 mm off, keys and feet add a few."""


@pytest.fixture
def script(repository: Path) -> ModuleType:
    """docs/session.py, loaded and not run."""
    spec = importlib.util.spec_from_file_location("session", repository / "docs" / "session.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_documented_session_leads_to_an_asset_and_a_file(
    script: ModuleType,
    tmp_path: Path,
    repository: Path,
    shown_points: Callable[[bpy.types.Object], np.ndarray],
) -> None:
    scene = bpy.context.scene
    take = script.session(scene, tmp_path)
    assert scene.frame_end == FRAMES
    assert [marker.segment for marker in take.markers] == list(script.SLEEVES)
    assert all(marker.found > 0.7 * marker.sampled > 0.0 for marker in take.markers)
    assert len(scene.keymark.takes) == 1
    assert len(take.proposals) == 12
    curve = take.keyframe_action.layers[0].strips[0].channelbags[0].fcurves[0]
    assert [round(frame) for frame in animator_frames(curve)] == KEYFRAMES
    assert take.review.frame_count == FRAMES
    final = take.finish.action
    assert len({take.keyframe_action, take.motion_action, final}) == 3
    assert take.armature.animation_data.action == final
    assert final.asset_data is not None and len(final.slots) == 1
    assert take.finish.keys_after < 0.5 * take.finish.keys_before
    result = take.characters[0].results[0]
    child = take.characters[0].armature
    assert child.animation_data.action == result.action and result.action.asset_data is not None
    assert result.action.name == "aerobic Child" and not TakeState(take).of_earlier(result)
    assert (tmp_path / "session.blend").is_file()
    assert (tmp_path / "motion.bvh").read_text().startswith("HIERARCHY")

    truth = read_truth(repository / "presets" / "demo" / "aerobic" / "truth.json", 1, FRAMES)
    errors = []
    for frame in range(1, FRAMES + 1, 3):
        scene.frame_set(frame)
        errors.append(np.linalg.norm(shown_points(take.armature) - truth[frame - 1], axis=1))
    assert 1000.0 * np.mean(errors) == pytest.approx(0.0, abs=FARTHEST_MM)
