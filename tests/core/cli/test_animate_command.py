"""`keymark animate`: from a bare clip and a height to a take with its motion, and what is refused."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from _drawn_clip import KnownPeople
from _synthetic_take import (
    BODY,
    drawn_frames,
    gliding,
    true_postures,
    write_frames,
    write_json,
    write_keypoints,
    write_video,
)
from keymark.core.detect.keypoint_file import read_keypoints
from keymark.core.prior.learning import LibraryMetadata, learn_library
from keymark.core.prior.library import write_library
from keymark.core.session import see
from keymark.core.shoot.discovery import find_takes
from keymark.core.take import read_footage
from keymark.core.take.motion import read_motion
from keymark.core.take.take_file import read_take
from keymark.operators.cli.conversion import convert_take
from keymark.operators.cli.main import main

FRAMES = 40

pytestmark = pytest.mark.usefixtures("no_blender")


@pytest.fixture(scope="module")
def pristine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with one bare clip and its keypoints."""
    folder = tmp_path_factory.mktemp("bare")
    write_video(folder / "hall.mp4", gliding(FRAMES))
    write_keypoints(folder / "hall.keypoints.json", gliding(FRAMES))
    return folder


@pytest.fixture
def clip(pristine: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    learned = learn_library(
        BODY, true_postures(24), np.arange(24) / 30.0, LibraryMetadata("Swaying", "Nobody")
    )
    monkeypatch.setattr(convert_take, "requested_libraries", lambda _name: (learned,))
    write_library(tmp_path / "swaying.json", learned)
    return Path(shutil.copytree(pristine, tmp_path / "bare")) / "hall.mp4"


def animate(clip: Path, out: Path, *more: object) -> int:
    return main(["animate", str(clip), "--output", str(out), "--no-report", *map(str, more)])


def test_a_clip_and_a_height_give_a_take_with_its_motion(
    clip: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert animate(clip, out, "--height", 1.75, "--json") == 0
    said = json.loads(capsys.readouterr().out)
    keypoints, camera, actor, poses = said["notes"][:4]
    assert keypoints == "Keypoints: read from hall.keypoints.json"
    assert camera.startswith("Camera: ") and "a guess, as of a webcam" in camera
    assert actor == "Actor: 1.75 m tall, of average proportions" and poses.startswith("Poses: ")
    motion = read_motion(out / "motion.json")
    assert len(motion.points) == FRAMES
    files = {Path(file).name for file in said["files"]}
    assert {"take.json", "keypoints.json", "keyframes.json", "hall.mp4", "motion.blend"} <= files
    take = read_take(out)
    assert take.clip == out / "hall.mp4" and len(take.keyframes) and take.keypoints
    assert take.body.actor.stature_m == pytest.approx(1.75, abs=0.01)
    fields = json.loads((out / "take.json").read_text(encoding="utf-8"))
    assert fields["//found"] == said["notes"][:4] and fields["floor_m"] == 0.0
    hips = motion.points[:, [7, 8], :2].mean(axis=1)
    assert np.linalg.norm(np.median(hips, axis=0)) < 0.35
    again = tmp_path / "again"
    assert main(["convert", str(out), "--output", str(again), "--no-report", "--quiet"]) == 0
    assert len(read_motion(again / "motion.json").points) == FRAMES
    assert sorted(file.name for file in clip.parent.iterdir()) == ["hall.keypoints.json", "hall.mp4"]


def test_a_second_run_replaces_what_the_first_has_made(clip: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert animate(clip, out, "--quiet") == 0
    renamed = clip.rename(clip.with_name("room.mp4"))
    shutil.move(clip.with_suffix(".keypoints.json"), renamed.with_suffix(".keypoints.json"))
    assert animate(renamed, out, "--quiet") == 0
    assert (out / "room.mp4").is_file() and not (out / "hall.mp4").exists()
    assert "assumed" in json.loads((out / "take.json").read_text(encoding="utf-8"))["//found"][2]


def test_without_keypoints_they_are_detected(
    clip: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = clip.with_suffix(".keypoints.json")
    found = read_keypoints(file, FRAMES, (160, 120), 30.0, 1)
    file.unlink()

    monkeypatch.setattr(see, "PoseNetwork", SimpleNamespace)
    monkeypatch.setattr(see, "PeopleFinder", lambda *_given: KnownPeople(found))
    assert animate(clip, tmp_path / "out", "--height", 1.75, "--quiet") == 0
    fields = json.loads((tmp_path / "out" / "take.json").read_text(encoding="utf-8"))
    assert fields["//found"][0] == f"Keypoints: somebody in {FRAMES} of {FRAMES} frames, by drawn"
    assert fields["keypoints"] == ["keypoints.json"]


@pytest.mark.parametrize(
    ("height", "sentence"),
    [
        ("178", "178; meters from 0.5 to 3 are valid; 178 centimeters are 1.78"),
        ("0", "is 0; meters"),
        ("nan", "is nan"),
    ],
)
def test_a_height_that_is_none_is_refused(
    clip: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], height: str, sentence: str
) -> None:
    assert animate(clip, tmp_path / "out", "--height", height) == 2
    error = capsys.readouterr().err
    assert sentence in error and len(error.splitlines()) == 1 and not (tmp_path / "out").exists()


def damaged(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    model = folder / "model.onnx"
    model.write_bytes(b"ONNX")
    network = see.PoseNetwork
    monkeypatch.setattr(see, "PoseNetwork", lambda: network(model))
    write_frames(folder / "clip.mp4", list(drawn_frames(true_postures(5))))
    return folder / "clip.mp4"


def picture(folder: Path, _monkeypatch: pytest.MonkeyPatch) -> Path:
    file = folder / "photo.png"
    import cv2

    cv2.imwrite(str(file), next(drawn_frames(true_postures(1))))
    return file


def of_one_frame(folder: Path, _monkeypatch: pytest.MonkeyPatch) -> Path:
    write_frames(folder / "clip.mp4", list(drawn_frames(true_postures(1))))
    return folder / "clip.mp4"


def too_long(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    write_frames(folder / "clip.mp4", list(drawn_frames(true_postures(8))))
    monkeypatch.setattr(read_footage, "LONGEST_FRAMES", 6)
    monkeypatch.setattr(see, "PoseNetwork", lambda: pytest.fail("the network was read"))
    return folder / "clip.mp4"


def take(folder: Path, _monkeypatch: pytest.MonkeyPatch) -> Path:
    write_json(folder / "take.json", {})
    return folder


def nothing(folder: Path, _monkeypatch: pytest.MonkeyPatch) -> Path:
    return folder / "none.mp4"


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (damaged, "is damaged or another one"),
        (picture, "photo.png: is a single picture; it must be a video"),
        (of_one_frame, "clip.mp4: is a single picture; it must be a video"),
        (too_long, "clip.mp4: has more than 6 frames, 0 minutes; it must be shorter: cut it, as with ffmpeg"),
        (take, "is a take, which keymark convert is for"),
        (nothing, "none.mp4"),
    ],
)
def test_bad_input_is_refused_in_a_sentence_and_nothing_is_written(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    make: Callable[[Path, pytest.MonkeyPatch], Path],
    sentence: str,
) -> None:
    folder = tmp_path / "bad"
    folder.mkdir()
    monkeypatch.setattr(convert_take, "requested_libraries", lambda _name: ())
    assert animate(make(folder, monkeypatch), tmp_path / "out") == 2
    error = capsys.readouterr().err
    assert sentence in error and len(error.splitlines()) == 1 and not (tmp_path / "out").exists()


def test_a_shoot_of_bare_clips_needs_nothing_but_heights(
    clip: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = clip.parent
    assert main(["new", str(folder)]) == 0
    assert "  actor.height_m\n" in (said := capsys.readouterr().out) and "camera." not in said
    shoot = json.loads((folder / "shoot.json").read_text(encoding="utf-8"))
    assert "camera" not in shoot and shoot["keyframes"] == "auto" and "floor_m" not in shoot
    write_json(folder / "shoot.json", {"root": True, "actor": {"height_m": 1.75}, "keyframes": "auto"})
    assert main(["check", str(folder), "--json"]) == 0
    (checked,) = json.loads(capsys.readouterr().out)["takes"]
    assert "keypoints" in checked["evidence"] and checked["status"] == "ready"
    assert main(["convert", str(clip), "--output", str(tmp_path / "out"), "--no-report", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["notes"][1].startswith("Camera: ")
    assert read_take(tmp_path / "out").keypoints
    shutil.move(tmp_path / "out", folder / "earlier")
    assert [take.name for take in find_takes(folder).takes] == ["hall"]
    assert [take.name for take in find_takes(folder / "earlier").takes] == ["."]
