"""`keymark check`: finds problems and likely problems of takes, reports them, and writes nothing."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from _synthetic_take import MATRIX_WORLD, drawn_frames, edit_json, true_postures, write_frames, write_shoot
from keymark.core.shoot.check.take_check import TakeCheck
from keymark.core.shoot.discovery import Shoot, ShootTake
from keymark.operators.cli.commands import check as command
from keymark.operators.cli.commands.check import check_text
from keymark.operators.cli.console import program_name
from keymark.operators.cli.main import main

FRAMES = 10
TAKE = "day1/take01"
LONG = "a/name that is much too long for the table"


@pytest.fixture(scope="module")
def pristine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A shoot of three takes that tests must not change."""
    return write_shoot(tmp_path_factory.mktemp("check") / "shoot", 3, FRAMES)


@pytest.fixture(scope="module")
def one_take(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_shoot(tmp_path_factory.mktemp("one") / "shoot", 1, FRAMES)


@pytest.fixture
def shoot(one_take: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(one_take, tmp_path / "shoot"))


@pytest.fixture
def check(capsys: pytest.CaptureFixture[str]) -> Callable[..., tuple[int, dict[str, Any]]]:
    """Run `keymark check --json`; returns the exit status and the object."""

    def run(*words: object) -> tuple[int, dict[str, Any]]:
        status = main(["check", *map(str, words), "--json"])
        return status, json.loads(capsys.readouterr().out)

    return run


def test_a_sound_shoot_is_ready_and_stays_as_it_is(
    pristine: Path, check: Callable[..., Any], capsys: pytest.CaptureFixture[str]
) -> None:
    before = {path: path.stat().st_mtime_ns for path in pristine.rglob("*")}
    status, said = check(pristine)
    assert status == 0 and said["counts"] == {"ready": 3, "look": 0, "fails": 0}
    assert [take["take"] for take in said["takes"]] == [f"day1/take0{number}" for number in (1, 2, 3)]
    for take in said["takes"]:
        assert take["problems"] == take["warnings"] == [] and take["keyframes"] == 4
        assert take["frames"] == FRAMES and take["size"] == [160, 120] and take["fps"] == 30.0
        assert all(seen["found"] == seen["sampled"] == FRAMES for seen in take["markers"].values())
    again, more = check(pristine, "--jobs", 3)
    assert again == 0 and more["takes"] == said["takes"]
    assert {path: path.stat().st_mtime_ns for path in pristine.rglob("*")} == before
    assert main(["check", str(pristine / f"{TAKE}.mp4"), "--quiet"]) == 0
    assert main(["check", str(pristine / "day1" / "take03")]) == 0
    assert "\nready  take03" in capsys.readouterr().out


def no_video(shoot: Path) -> None:
    (shoot / f"{TAKE}.mp4").write_text("no video", encoding="utf-8")


def no_keyframes(shoot: Path) -> None:
    (shoot / f"{TAKE}.keyframes.json").unlink()


def cut_keyframes(shoot: Path) -> None:
    path = shoot / f"{TAKE}.keyframes.json"
    path.write_bytes(path.read_bytes()[:500])


def late_keyframe(shoot: Path) -> None:
    edit_json(shoot / f"{TAKE}.keyframes.json", lambda value: value["keyframes"][-1].update(frame=FRAMES + 5))


def said_of_take(**fields: Any) -> Callable[[Path], None]:
    return lambda shoot: edit_json(shoot / f"{TAKE}.take.json", lambda value: value.update(fields))


BEHIND = [[-1.0, 0, 0, 0], [0, 0, 1.0, -4.0], [0, 1.0, 0, 1.0], [0, 0, 0, 1.0]]


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (no_video, "take01.mp4: cannot be decoded"),
        (no_keyframes, "take01.keyframes.json: no such file; a take needs keyframes"),
        (cut_keyframes, "take01.keyframes.json: line 1"),
        (late_keyframe, f"keyframe {FRAMES + 5} lies outside the clip"),
        (said_of_take(camera={"resolution": [320, 240]}), "camera.resolution is [320, 240]"),
        (said_of_take(camera={"matrix_world": BEHIND}), "behind the camera"),
        (said_of_take(camera={"matrix_world_frames": 5 * [MATRIX_WORLD]}), "matrix_world_frames has 5 poses"),
        (said_of_take(frame_count=12), "frame_count is 12"),
        (said_of_take(library="walkin"), "is 'walking' meant?"),
        (said_of_take(markers={"shin.L": {"color_srgb": [0, 255, 255]}}), "marker shin.L has the color"),
        (said_of_take(actor={"height_m": 17}), "height_m is 17"),
    ],
)
def test_what_would_stop_a_take_is_said(
    shoot: Path, check: Callable[..., Any], spoil: Callable[[Path], None], sentence: str
) -> None:
    spoil(shoot)
    status, said = check(shoot)
    first = said["takes"][0]
    assert status == 1 and first["status"] == "fails"
    assert len(first["problems"]) == 1 and sentence in first["problems"][0]


def swapped(shoot: Path) -> None:
    colors = json.loads((shoot / "shoot.json").read_text(encoding="utf-8"))["markers"]
    markers = {"forearm.L": colors["shin.R"], "shin.R": colors["forearm.L"]}
    said_of_take(markers=markers)(shoot)


def few(shoot: Path) -> None:
    edit_json(shoot / f"{TAKE}.keyframes.json", lambda value: value.update(keyframes=value["keyframes"][::3]))
    said_of_take(fps=5)(shoot)


def elsewhere(shoot: Path) -> None:
    said_of_take(camera={"matrix_world": [[1, 0, 0, 2.2], [0, 0, -1, -4.0], [0, 1, 0, 1.0], [0, 0, 0, 1]]})(
        shoot
    )


def half_dark(shoot: Path) -> None:
    images = list(drawn_frames(true_postures(FRAMES)))
    write_frames(shoot / f"{TAKE}.mp4", [*images[:6], *(np.zeros_like(image) for image in images[6:])])


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (swapped, "markers are seen far from where keyframes and camera put them: forearm.L in "),
        (elsewhere, "seen outside the picture for the most part"),
        (few, "2 keyframes for 10 frames are few: from frame 1 to 10, 1.8 s"),
        (few, "let --keyframes auto find the others"),
        (few, "take01.take.json says 5 frames per second"),
        (half_dark, "4 of 10 sampled frames are black"),
        (said_of_take(actor={"height_m": 1.2}), "the points of 4 of 4 keyframes are up to"),
    ],
)
def test_what_is_likely_to_go_wrong_is_said(
    shoot: Path, check: Callable[..., Any], spoil: Callable[[Path], None], sentence: str
) -> None:
    spoil(shoot)
    status, said = check(shoot)
    first = said["takes"][0]
    assert status == 0 and first["status"] == "look" and first["problems"] == []
    assert any(sentence in warning for warning in first["warnings"]), first["warnings"]


def test_a_mistake_of_all_is_said_once(
    pristine: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shoot = Path(shutil.copytree(pristine, tmp_path / "shoot"))
    edit_json(shoot / "shoot.json", lambda value: value["actor"].update(height_m=None))
    no_video(shoot)
    assert main(["check", str(shoot)]) == 1
    said = capsys.readouterr()
    assert said.out.count("height_m is still to be filled in") == 1 and "In all takes:" in said.out
    own = said.out.partition("fails  day1/take01")[2].splitlines()[1]
    assert own.strip().startswith("! ") and "cannot be decoded" in own
    assert "3 takes: 0 ready, 0 to look at, 3 that would not convert" in said.out
    assert said.err == f"{program_name()}: 3 of 3 takes would not convert\n"


def test_defaults_count_where_a_shoot_says_nothing(shoot: Path, check: Callable[..., Any]) -> None:
    no_keyframes(shoot)
    assert check(shoot)[0] == 1
    for words, library in ((["--library", "waving"], "waving"), (["--keyframes", "auto"], "auto")):
        status, said = check(shoot, *words)
        assert status == 0 and {take["library"] for take in said["takes"]} == {library}
        assert said["takes"][0]["status"] == "ready"


def test_a_take_without_keyframes_is_told_how_to_get_some(shoot: Path, check: Callable[..., Any]) -> None:
    no_keyframes(shoot)
    (problem,) = check(shoot)[1]["takes"][0]["problems"]
    assert "--keyframes auto" in problem and '"keyframes": "auto"' in problem
    edit_json(shoot / "shoot.json", lambda value: value.update(keyframes="auto"))
    assert check(shoot)[0] == 0


@pytest.mark.parametrize("jobs", ["1", "2"])
def test_what_nobody_thought_of_stops_one_take_and_ctrl_c_all(
    pristine: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, jobs: str
) -> None:
    raised: list[BaseException] = [ZeroDivisionError("two\nlines")]

    def fail(take: ShootTake, *_more: object) -> TakeCheck:
        if take.name == TAKE:
            raise raised[0]
        return TakeCheck(take.name, (), ())

    monkeypatch.setattr(command, "check_take", fail)
    assert main(["check", str(pristine), "--jobs", jobs]) == 1
    said = capsys.readouterr()
    assert "take01.mp4: the check failed unexpectedly (ZeroDivisionError: two lines)" in said.out
    assert (
        said.out.count("\nready") == 2 and said.err == f"{program_name()}: 1 of 3 takes would not convert\n"
    )
    raised[0] = KeyboardInterrupt()
    assert main(["check", str(pristine), "--jobs", jobs]) == 130
    assert capsys.readouterr().err == f"{program_name()}: interrupted; nothing was written\n"


def test_sentences_are_broken_to_the_terminal() -> None:
    shoot = Shoot(Path("shoot"), ())
    check = TakeCheck("one", ("a word " * 30,), ())
    whole, broken = check_text(shoot, [check]).splitlines(), check_text(shoot, [check], 70).splitlines()
    assert max(map(len, whole)) > 200 and max(map(len, broken[:6])) <= 70
    assert broken[2].startswith("       ! a word") and broken[3].startswith("         word")


def test_the_table_fits_the_terminal() -> None:
    shoot = Shoot(Path("shoot"), ())
    checks = [TakeCheck(name, (), (), frames=77) for name in ("a/short", LONG)]
    lines = check_text(shoot, checks, 60).splitlines()
    assert max(map(len, lines)) <= 60
    assert lines[2] == f"ready  {LONG}" and lines[3].strip().startswith("77")
    assert lines[1].index("77") == lines[3].index("77")
    assert len(check_text(shoot, checks).splitlines()) == 5


def test_what_three_takes_share_is_said_once() -> None:
    shoot = Shoot(Path("shoot"), ())
    checks = [TakeCheck(f"take{number}", ("no camera",) if number < 3 else (), ()) for number in range(9)]
    said = check_text(shoot, checks)
    assert said.count("! no camera") == 1 and "In 3 takes (take0, take1, take2):" in said


def test_an_unusable_shoot_is_one_line_and_status_two(
    shoot: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "bad.jsonl").write_text("[]", encoding="utf-8")
    shutil.copy(shoot / f"{TAKE}.mp4", shoot / "day1" / "take01.mkv")
    for words, sentence in (
        ([tmp_path / "none"], "no such"),
        ([tmp_path / "empty"], "keymark new"),
        ([tmp_path / "bad.jsonl"], "line 1"),
        ([shoot], "have one name"),
        ([shoot, "--jobs", "0"], "--jobs is 0"),
    ):
        assert main(["check", *map(str, words)]) == 2
        error = capsys.readouterr().err
        assert sentence in error and len(error.splitlines()) == 1
