"""Detect Keypoints: the network on the take's clip, here one that is made for tests."""

import bpy
import pytest
from _fake_network import MiddleNetwork
from keymark.core.take.take import Take
from keymark.operators.follow.detect_keypoints import KEYMARK_OT_detect_keypoints
from keymark.operators.follow.evidence import keypoint_path
from keymark.operators.shell.takes import active_take


@pytest.fixture(autouse=True)
def network(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that sees somebody in the middle of every picture."""
    monkeypatch.setattr("keymark.core.footage.pose_network.PoseNetwork", MiddleNetwork)


def test_what_is_found_is_written_beside_the_clip_and_listed(
    plain: bpy.types.Scene, plain_take: Take
) -> None:
    """Run again, it writes the same file anew; a file of someone else's stays."""
    theirs = plain_take.folder / "clip.keypoints.json"
    theirs.write_text("theirs", encoding="utf-8")
    for _ in range(2):
        assert bpy.ops.keymark.detect_keypoints() == {"FINISHED"}
    (entry,) = active_take(plain).follow.files
    assert keypoint_path(entry) == plain_take.folder / "clip.keypoints2.json"
    assert theirs.read_text(encoding="utf-8") == "theirs"


def test_a_clip_without_anybody_changes_nothing(
    plain: bpy.types.Scene, plain_take: Take, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One sentence, no file, no entry."""
    monkeypatch.setattr(MiddleNetwork, "presence", 0.0)
    before = sorted(plain_take.folder.iterdir())
    with pytest.raises(RuntimeError, match="nobody is seen"):
        bpy.ops.keymark.detect_keypoints()
    assert sorted(plain_take.folder.iterdir()) == before and len(active_take(plain).follow.files) == 0


def test_a_job_that_is_closed_leaves_nothing_behind(plain: bpy.types.Scene, plain_take: Take) -> None:
    """As Esc closes it."""
    job = KEYMARK_OT_detect_keypoints.start(KEYMARK_OT_detect_keypoints, plain)
    for _ in range(3):
        assert next(job).stage == "Detecting keypoints"
    job.close()
    assert not list(plain_take.folder.glob("*keypoints*")) and len(active_take(plain).follow.files) == 0
