"""Detect Keypoints: a user's program on the take's clip, by a detector that is made for tests."""

import shlex
import sys
from pathlib import Path

import bpy
import pytest
from keymark.core.take.take import Take
from keymark.operators.keypoints.detect_keypoints import KEYMARK_OT_detect_keypoints
from keymark.operators.keypoints.keypoint_paths import keypoint_path
from keymark.operators.shell.takes import active_take

FAKE = Path(__file__).resolve().parents[2] / "_fake_detector.py"


def use(monkeypatch: pytest.MonkeyPatch, how: str) -> None:
    """Name the detector in the environment."""
    words = [sys.executable, str(FAKE), how]
    command = f"{shlex.join(words)} {{clip}} {{output}} {{width}} {{height}} {{frames}}"
    monkeypatch.setenv("KEYMARK_DETECTOR", command)


def test_what_a_detector_finds_is_written_beside_the_clip_and_listed(
    plain: bpy.types.Scene, plain_take: Take, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Run again, it writes the same file anew; a file of someone else's stays."""
    use(monkeypatch, "work")
    theirs = plain_take.folder / "clip.keypoints.json"
    theirs.write_text("theirs", encoding="utf-8")
    for _ in range(2):
        assert bpy.ops.keymark.detect_keypoints() == {"FINISHED"}
    (entry,) = active_take(plain).follow.files
    assert keypoint_path(entry) == plain_take.folder / "clip.keypoints2.json"
    assert theirs.read_text(encoding="utf-8") == "theirs"


@pytest.mark.parametrize(
    ("how", "sentence"), [("fail", "no weights"), ("garbage", "unusable"), ("nothing", "wrote no keypoints")]
)
def test_a_detector_that_fails_changes_nothing(
    plain: bpy.types.Scene, plain_take: Take, monkeypatch: pytest.MonkeyPatch, how: str, sentence: str
) -> None:
    """One sentence, no file, no entry."""
    use(monkeypatch, how)
    before = sorted(plain_take.folder.iterdir())
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.keymark.detect_keypoints()
    assert sorted(plain_take.folder.iterdir()) == before and len(active_take(plain).follow.files) == 0


def test_a_job_that_is_closed_leaves_nothing_behind(
    plain: bpy.types.Scene, plain_take: Take, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As Esc closes it, while the program runs."""
    use(monkeypatch, "hang")
    job = KEYMARK_OT_detect_keypoints.start(KEYMARK_OT_detect_keypoints, plain)
    while next(job).stage != "Detecting keypoints":
        pass
    job.close()
    assert not list(plain_take.folder.glob("*keypoints*")) and len(active_take(plain).follow.files) == 0


def test_without_a_detector_the_button_says_so(
    plain: bpy.types.Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And an unusable command is named."""
    monkeypatch.delenv("KEYMARK_DETECTOR", raising=False)
    with pytest.raises(RuntimeError, match="Name a detector in Keymark's preferences first"):
        bpy.ops.keymark.detect_keypoints()
    monkeypatch.setenv("KEYMARK_DETECTOR", "run {nothing}")
    with pytest.raises(RuntimeError, match="KEYMARK_DETECTOR"):
        bpy.ops.keymark.detect_keypoints()
