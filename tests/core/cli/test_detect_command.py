"""`keymark detect`: one clip, a take, a shoot; where the command comes from; what is written and what not."""

import json
import shlex
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from _command_line import one_line, tree
from _shoot import write_shoot, write_video
from _synthetic_take import SIZE, true_postures, write_synthetic_take
from keymark.core.footage.keypoints.keypoint_file import read_keypoints
from keymark.core.take.take_file import read_take
from keymark.operators.cli.main import main

FRAMES = 8
FAKE = Path(__file__).parents[2] / "_fake_detector.py"
SCRIPT = Path(__file__).parents[3] / "__main__.py"


def command(how: str) -> str:
    """The fake detector as a command."""
    return shlex.join([sys.executable, str(FAKE), how]) + " {clip} {output} {width} {height} {frames}"


@pytest.fixture(autouse=True)
def no_detector(monkeypatch: pytest.MonkeyPatch) -> None:
    """The environment names none."""
    monkeypatch.delenv("KEYMARK_DETECTOR", raising=False)


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    """A clip that nothing describes."""
    file = tmp_path / "clips" / "walk.mp4"
    file.parent.mkdir()
    write_video(file, true_postures(FRAMES), seed=1)
    return file


def test_a_bare_clip_gets_its_file_beside_it(clip: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A clip needs no description; the text says what was found and where it is."""
    assert main(["detect", str(clip), "--detector", command("work")]) == 0
    file = clip.with_name("walk.keypoints.json")
    assert f"a person in 7 of 8 frames: {file}" in capsys.readouterr().out
    assert read_keypoints(file, FRAMES, SIZE, 30.0, 1).most_people == 1
    assert set(tree(clip.parent)) == {"walk.mp4", "walk.keypoints.json"}


def test_a_take_gets_its_file_in_its_folder_with_its_own_frame_numbers(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The command may come from the environment; images are a clip too."""
    take = write_synthetic_take(tmp_path / "take", FRAMES)
    fields = json.loads((take / "take.json").read_text())
    (take / "take.json").write_text(json.dumps({**fields, "frame_start": 101}))
    monkeypatch.setenv("KEYMARK_DETECTOR", command("work"))
    assert main(["detect", str(take), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["seen_frames"] == FRAMES - 1 and said["keypoints"] == str(take / "keypoints.json")
    written = json.loads((take / "keypoints.json").read_text())
    assert (
        written["frame_start"] == 101 and written["size"] == list(SIZE) and len(written["frames"]) == FRAMES
    )


def test_a_file_that_is_there_stays_unless_it_is_to_be_replaced(
    clip: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Before the detector runs; another name is another file."""
    file = clip.with_name("walk.keypoints.json")
    file.write_text("mine")
    assert main(["detect", str(clip), "--detector", command("hang"), "--quiet"]) == 2
    assert "is there already" in one_line(capsys.readouterr().err) and file.read_text() == "mine"
    other = tmp_path / "other.json"
    assert main(["detect", str(clip), "--detector", command("work"), "--output", str(other), "--quiet"]) == 0
    assert other.is_file() and file.read_text() == "mine"
    assert main(["detect", str(clip), "--detector", command("fail"), "--replace", "--quiet"]) == 1
    assert file.read_text() == "mine"
    assert main(["detect", str(clip), "--detector", command("work"), "--replace", "--quiet"]) == 0
    assert read_keypoints(file, FRAMES, SIZE).most_people == 1


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        (["--detector", command("fail")], 1, "ended with exit status 3"),
        (["--detector", command("hang"), "--time-limit", "0.01"], 1, "stopped after 0.01 minutes"),
        (["--detector", command("nothing")], 1, "wrote no keypoints"),
        (["--detector", command("garbage")], 2, "wrote what is unusable"),
        (["--detector", command("short")], 2, "wrote what is unusable"),
        (
            ["--detector", "/nowhere/detector {clip}"],
            2,
            "--detector: the program '/nowhere/detector' is nowhere",
        ),
        (["--detector", "true"], 2, "has no {clip}"),
        ([], 2, "no detector is named"),
        (["--detector", "true {clip}", "--time-limit", "0"], 2, "--time-limit is 0"),
        (["--detector", "true {clip}", "--time-limit", "nan"], 2, "--time-limit is nan"),
        (["--detector", "true {clip}", "--output", "/nowhere/file.json"], 2, "cannot be written"),
    ],
)
def test_what_fails_is_one_sentence_and_changes_nothing(
    clip: Path, capsys: pytest.CaptureFixture[str], words: list[str], status: int, said: str
) -> None:
    """1 where the program failed, 2 where the command or its keypoints are unusable."""
    before = clip.read_bytes()
    assert main(["detect", str(clip), *words, "--quiet"]) == status
    assert said in one_line(capsys.readouterr().err)
    assert clip.read_bytes() == before and not list(clip.parent.glob("*.json"))


def test_a_shoot_goes_on_after_failures_and_leaves_what_is_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Every take in turn; status 1 and the names of those that failed."""
    shoot = write_shoot(tmp_path / "shoot", 3, FRAMES)
    day = shoot / "day1"
    (day / "take02.keypoints.json").write_text("mine")
    (day / "take01.mp4").write_bytes(b"no video")
    assert main(["detect", str(shoot), "--detector", command("work"), "--json"]) == 1
    said, error = capsys.readouterr()
    assert "1 of 3 takes failed: day1/take01" in one_line(error)
    outcomes = json.loads(said)
    assert (outcomes["detected"], outcomes["there_already"], outcomes["failed"]) == (1, 1, 1)
    assert [take["error"] is None for take in outcomes["takes"]] == [False, True, True]
    assert (day / "take03" / "keypoints.json").is_file()
    assert (day / "take02.keypoints.json").read_text() == "mine"
    assert main(["detect", str(shoot), "--detector", command("work"), "--output", "x.json"]) == 2
    assert "--output is one file" in one_line(capsys.readouterr().err)
    assert main(["detect", str(tmp_path / "nowhere"), "--detector", command("work")]) == 2


def test_clips_need_no_description(clip: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A folder of bare clips, before there is any shoot.json."""
    shutil.copyfile(clip, clip.with_name("run.mp4"))
    assert main(["detect", str(clip.parent), "--detector", command("work")]) == 0
    assert "2 takes: 2 detected, 0 there already, 0 failed" in capsys.readouterr().out
    names = {"run.keypoints.json", "run.mp4", "walk.keypoints.json", "walk.mp4"}
    assert set(tree(clip.parent)) == names


def test_a_take_that_names_its_keypoints_gets_them_there(tmp_path: Path) -> None:
    """So that the conversion reads what was detected."""
    take = write_synthetic_take(tmp_path / "take", FRAMES)
    fields = json.loads((take / "take.json").read_text())
    (take / "take.json").write_text(json.dumps({**fields, "keypoints": "found.json"}))
    assert main(["detect", str(take), "--detector", command("work"), "--quiet"]) == 0
    assert (take / "found.json").is_file() and not (take / "keypoints.json").exists()
    assert len(read_take(take, whole=True).keypoints) == 1


def test_ctrl_c_ends_the_program_too(clip: Path) -> None:
    """SIGINT to the command line alone, as a farm sends it: its program does not go on."""
    boot = (
        # A shell that starts tests in the background has them ignore the signal.
        "import signal, sys; signal.signal(signal.SIGINT, signal.default_int_handler);"
        "sys.path.insert(0, sys.argv.pop(1)); import _boot; _boot.load_package();"
        "from keymark.operators.cli.main import main; sys.exit(main(sys.argv[1:]))"
    )
    words = [sys.executable, "-c", boot, str(FAKE.parent), "detect", str(clip), "--detector", command("hang")]
    started = clip.with_name("started")
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        while process.poll() is None and not (started.exists() and started.read_text()):
            pass
        process.send_signal(signal.SIGINT)
        _, error = process.communicate(timeout=60)
    assert process.returncode == 130 and "interrupted" in one_line(error)
    assert not Path(f"/proc/{started.read_text()}").exists()
    assert not list(clip.parent.glob("*.json"))
