"""The detector that comes along, with a network of straw in MediaPipe's place."""

import ast
import importlib.util
import json
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from _shoot import write_video
from _synthetic_take import SIZE, true_postures, write_images
from keymark.core.footage.keypoints.keypoint_file import read_keypoints

FRAMES = 5
POINTS = 33
KNEE = 25
"""The left one, of BlazePose's points."""


@pytest.fixture
def network(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """A stand-in for MediaPipe that sees one person in all frames but the third; the calls it got."""
    calls: list[dict[str, Any]] = []

    class Pose:
        def __init__(self, **options: Any) -> None:
            self.count = 0
            calls.append(options)

        def process(self, picture: np.ndarray) -> SimpleNamespace:
            self.count += 1
            calls[0]["shape"], calls[0]["first"] = picture.shape, picture[0, 0].tolist()
            if self.count == 3:
                return SimpleNamespace(pose_landmarks=None, pose_world_landmarks=None)
            point = SimpleNamespace(x=0.25, y=0.5, z=-0.1, visibility=0.9)
            marks = SimpleNamespace(landmark=[point] * POINTS)
            return SimpleNamespace(pose_landmarks=marks, pose_world_landmarks=marks)

    models = tmp_path / "mediapipe" / "modules" / "pose_landmark"
    models.mkdir(parents=True)
    (models / "pose_landmark_full.tflite").touch()
    fake = ModuleType("mediapipe")
    fake.__file__ = str(tmp_path / "mediapipe" / "__init__.py")
    fake.solutions = SimpleNamespace(pose=SimpleNamespace(Pose=Pose))  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "mediapipe", fake)
    monkeypatch.setattr("importlib.metadata.version", lambda name: "0.10.14")
    return calls


@pytest.fixture
def program(repository: Path) -> Callable[..., int]:
    """The program's `main`."""
    file = repository / "detectors" / "mediapipe_pose.py"
    spec = importlib.util.spec_from_file_location("mediapipe_pose", file)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return lambda *words: module.main([str(word) for word in words])


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    """A short clip."""
    write_video(tmp_path / "clip.mp4", true_postures(FRAMES), seed=1)
    return tmp_path / "clip.mp4"


def test_it_writes_what_keymark_reads(
    network: list[dict[str, Any]],
    program: Callable[..., int],
    clip: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Pixels, scores, hints of depth, nobody in one frame; a line a frame on standard output."""
    output = tmp_path / "keypoints.json"
    assert program(clip, "--output", output) == 0
    assert capsys.readouterr().out.splitlines()[-1] == f"frame {FRAMES}/{FRAMES}"
    people = read_keypoints(output, FRAMES, SIZE, 30.0, 1)
    assert people.source == "MediaPipe Pose 0.10.14, landmark model full" and people.notes == ()
    assert [len(frame.pixel) for frame in people.frames] == [1, 1, 0, 1, 1]
    knee = people.names.index("knee.L")
    first = people.frames[0]
    assert first.pixel[0, knee] == pytest.approx([0.25 * SIZE[0], 0.5 * SIZE[1]])
    assert first.score[0, knee] == pytest.approx(0.9)
    assert first.hint_m[0, knee] == pytest.approx([0.25, 0.5, -0.1])
    assert network[0]["shape"] == (SIZE[1], SIZE[0], 3) and network[0]["static_image_mode"] is False
    assert {file.name for file in tmp_path.iterdir() if file.is_file()} == {"clip.mp4", "keypoints.json"}


def test_a_region_is_searched_alone_and_images_are_a_clip(
    network: list[dict[str, Any]], program: Callable[..., int], tmp_path: Path
) -> None:
    """Points are told in the whole picture; the options reach the network."""
    write_images(tmp_path / "frames", true_postures(FRAMES))
    output = tmp_path / "keypoints.json"
    words = ("--region", 40, 20, 80, 60, "--still-images", "--no-smoothing", "--no-world", "--frame-start", 7)
    assert program(tmp_path / "frames", "--output", output, *words) == 0
    written = json.loads(output.read_text())
    assert written["frames"][0][KNEE] == [40 + 0.25 * 80, 20 + 0.5 * 60, 0.9]
    assert written["frame_start"] == 7 and "world" not in written and "fps" not in written
    assert network[0]["shape"] == (60, 80, 3)
    assert network[0]["static_image_mode"] is True and network[0]["smooth_landmarks"] is False


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        (["nowhere.mp4", "--output", "out.json"], 2, "no such file"),
        (["{clip}"], 2, "--output"),
        (["{clip}", "--output", "out.json", "--model", "heavy"], 2, "pose_landmark_heavy.tflite is missing"),
        (
            ["{clip}", "--output", "out.json", "--region", "0", "0", "999", "9"],
            2,
            "lie within 160 x 120",
        ),
        (["{clip}", "--output", "out.json", "--tracking-confidence", "2"], 2, "not between 0 and 1"),
        (["{folder}", "--output", "out.json"], 2, "holds no images"),
        (["{clip}", "--output", "nowhere/out.json"], 1, "cannot be written"),
    ],
)
def test_what_fails_is_one_sentence_and_writes_nothing(
    network: list[dict[str, Any]],
    program: Callable[..., int],
    clip: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    words: list[str],
    status: int,
    said: str,
) -> None:
    """On standard error, by which Keymark tells why."""
    monkeypatch.chdir(clip.parent)
    (clip.parent / "empty").mkdir()
    filled = [word.format(clip=clip, folder=clip.parent / "empty") for word in words]
    assert program(*filled) == status
    error = capsys.readouterr().err.splitlines()
    assert len(error) == 1 and error[0].startswith("mediapipe_pose.py: ") and said in error[0]
    assert not list(clip.parent.glob("*.json"))


def test_it_stands_alone(repository: Path) -> None:
    """It imports nothing of Keymark, and no network at its top, so that its help needs none."""
    tree = ast.parse((repository / "detectors" / "mediapipe_pose.py").read_text(encoding="utf-8"))
    modules = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    modules |= {node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert not [name for name in modules if name.startswith("keymark")]
    top = {alias.name for node in tree.body if isinstance(node, ast.Import) for alias in node.names}
    assert not top & {"cv2", "mediapipe", "numpy"}
