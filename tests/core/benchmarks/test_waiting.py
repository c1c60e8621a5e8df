"""The benchmark of what people wait for: its enlarged clip, its table, and the page that has it."""

import json
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest
from _boot import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))

import waiting  # noqa: E402
from enlarged_take import KEYPOINTS, enlarged, fit, shown  # noqa: E402
from keymark.core.footage.clips.clip import Clip  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402
from keymark.core.take.take_file import read_take  # noqa: E402

SIZE = (640, 360)
FRAMES = 130
SHORT = 118
CELL = waiting.Cell(7.25, 9.0, 411.6)


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> Take:
    """The demonstration, half as large again in a wide picture, and a little longer."""
    return read_take(enlarged(waiting.DEMO, SIZE, FRAMES, tmp_path_factory.mktemp("waiting") / "large"))


def test_an_enlarged_take_shows_the_same_performer_larger(large: Take) -> None:
    small = read_take(waiting.DEMO)
    points = small.body.points(small.body.pose(small.keyframes[2].posture))
    factor, margin = fit(small.camera.resolution, SIZE)
    assert factor == 1.5 and margin == (80.0, 0.0)
    expected = factor * small.camera.project(points)[0] + np.array(margin)
    np.testing.assert_allclose(large.camera.project(points)[0], expected, atol=1e-6)


def test_an_enlarged_clip_has_the_pictures_of_the_take(large: Take) -> None:
    images = [image for _, _, image in Clip.open(large.clip).frames()]
    originals = [image for _, _, image in Clip.open(waiting.DEMO / "clip.mp4").frames()]
    assert len(images) == large.frame_count == FRAMES
    assert (images[0].shape[1], images[0].shape[0]) == SIZE
    for index, original in ((10, 10), (SHORT + 3, SHORT - 4)):
        seen = cv2.resize(images[index][:, 80:560], (320, 240), interpolation=cv2.INTER_AREA).astype(float)
        apart = [np.abs(seen - other).mean() for other in originals]
        assert abs(int(np.argmin(apart)) - original) <= 1 and min(apart) < 8.0
    left = images[0][:, 10:70].astype(float)
    assert np.abs(left.mean(axis=1) - images[0][:, 80:84].mean(axis=1)).mean() < 8.0


def test_keyframes_and_keypoints_come_along(large: Take) -> None:
    small = read_take(waiting.DEMO)
    before = {keyframe.index: keyframe.posture for keyframe in small.keyframes}
    for keyframe in large.keyframes:
        posture = before[shown(keyframe.index, SHORT)]
        np.testing.assert_allclose(keyframe.posture.translation, posture.translation, atol=1e-6)
    assert max(large.keyframe_indices) >= SHORT
    said, moved = (
        json.loads((folder / KEYPOINTS).read_text(encoding="utf-8"))
        for folder in (waiting.DEMO, large.folder)
    )
    assert moved["size"] == list(SIZE) and len(moved["frames"]) == len(moved["world"]) == FRAMES
    x, y, score = said["frames"][SHORT - 2][0]
    assert moved["frames"][SHORT + 1][0] == pytest.approx([1.5 * x + 80.0, 1.5 * y, score])
    assert moved["world"][SHORT + 1] == said["world"][SHORT - 2]


def test_the_table_has_a_row_a_step_and_a_column_a_clip() -> None:
    slow = waiting.Cell(200.0, 300.0, 1000.0)
    batch = waiting.Cell(20.0, 40.0, 500.0, takes=4)
    small = {**dict.fromkeys(waiting.ROWS, CELL), waiting.BATCH: batch, waiting.BY_HAND: "0 s"}
    large = {**dict.fromkeys(waiting.ROWS, slow), waiting.BATCH: waiting.LEFT_OUT, "bake": waiting.FAILED}
    lines = waiting.table({"small": small, "sixty": large}, "said").splitlines()
    rows = lines[4:-1]
    assert len(rows) == len(waiting.ROWS) and len({line.count("|") for line in lines[2:]}) == 1
    assert "| 7.2 s, 412 MB | 3 min 20 s, 1000 MB |" in rows[list(waiting.ROWS).index("pose_all")]
    assert rows[list(waiting.ROWS).index("bake")].endswith("| failed |")
    assert "| 5.0 s, 500 MB | not measured |" in rows[-1]
    assert lines[-1].endswith("| 720 | not measured |")


def test_every_row_is_measured_by_something() -> None:
    import waiting_steps

    others = {waiting.DETECT, waiting.BY_HAND, waiting.CONVERT, waiting.BATCH}
    assert set(waiting.ROWS) - others == set(waiting_steps.STEPS)


def test_a_step_that_fails_leaves_the_others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:

    def run_step(step: str, *words: object) -> dict[str, float]:
        if step == "bake":
            raise subprocess.CalledProcessError(1, step)
        return {"seconds": 1.0, "processor_s": 1.0, "peak_mb": 1.0}

    monkeypatch.setattr(waiting, "run_step", run_step)
    monkeypatch.setattr(waiting, "ROWS", {step: "" for step in ("bake", "retarget")})
    found = waiting.measure("small", tmp_path)
    assert found == {
        "bake": waiting.FAILED,
        "retarget": waiting.Cell(1.0, 1.0, 1.0),
    }


def test_decoding_is_measured_in_a_process_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "clip.mp4").write_bytes((waiting.DEMO / "clip.mp4").read_bytes())
    cell = waiting.measured("decode", waiting.CLIPS["small"], tmp_path)
    assert isinstance(cell, waiting.Cell)
    assert cell.seconds > 0.0 and 20.0 < cell.peak_mb < 400.0


def test_the_table_takes_its_place_in_the_page() -> None:
    page = waiting.PAGE.read_text(encoding="utf-8")
    once = waiting.placed(page, "a table")
    assert f"{waiting.BEGIN}\na table\n{waiting.END}" in once
    assert waiting.placed(once, "another") == waiting.placed(page, "another")
    assert once.partition(waiting.BEGIN)[0] == page.partition(waiting.BEGIN)[0]
    with pytest.raises(SystemExit, match="times: begin"):
        waiting.placed("no marks", "a table")
