"""docs/shoots.md: every file in it is readable, and every command in it runs."""

import re
import shlex
from pathlib import Path

import pytest
from _synthetic_take import BODY, true_postures, write_images, write_keyframes, write_video
from keymark.core.take.description import describe
from keymark.core.take.take_file import read_take
from keymark.operators.cli.main import main

FRAMES = 12
CLIPS = ("day1/clip01", "day1/clip02", "day2/clip01", "day2/clip02")
POSED = ("day1/clip01", "day2/clip02")


@pytest.fixture(scope="module")
def page(repository: Path) -> str:
    """The page's text."""
    return (repository / "docs" / "shoots.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, page: str) -> Path:
    """The page's tree, with the page's files in it."""
    root = tmp_path_factory.mktemp("page")
    posture = true_postures(FRAMES)
    points = BODY.points(BODY.pose(posture))
    for name in CLIPS:
        (root / "shoot" / name).parent.mkdir(parents=True, exist_ok=True)
        write_video(root / "shoot" / f"{name}.mp4", posture)
    for name in POSED:
        write_keyframes(root / "shoot" / f"{name}.keyframes.json", points, 5)
    jump = root / "shoot" / "day2" / "jump"
    write_images(jump / "frames", posture)
    write_keyframes(jump / "keyframes.json", points, 5)
    for name, text in re.findall(r"^```jsonl? (\S+)\n(.*?)^```", page, flags=re.MULTILINE | re.DOTALL):
        (root / name).write_text(text, encoding="utf-8")
    return root


def test_its_commands_run(
    folder: Path, page: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    lines = re.findall(r"^keymark (.*)$", page, flags=re.MULTILINE)
    said = {}
    for line in lines:
        if not line.startswith("batch"):  # which has tests of its own
            said[line] = main(shlex.split(line)), "".join(capsys.readouterr())
    assert said["new shoot"][0] == 2 and "never replaced" in said["new shoot"][1]
    status, text = said["check shoot"]
    assert status == 1 and text.count("\nfails") == 1 and "clip02.keyframes.json: no such file" in text
    assert re.search(r"^ready +day1/clip01 +12 +160x120 +30 +4 +100%", text, flags=re.MULTILINE)
    assert said["check shoot/tonight.jsonl"][0] == 0 == said["check shoot/day2/jump"][0]


def test_fields_come_from_the_nearest_file(folder: Path) -> None:
    first = read_take(folder / "shoot" / "day1" / "clip01.mp4")
    moved = read_take(folder / "shoot" / "day2" / "clip01.mp4", keyframes_required=False)
    assert first.camera.matrix_world[0, 3] == 0.0 and moved.camera.matrix_world[0, 3] == 0.2
    assert moved.camera.lens_mm == 40.0 and moved.camera.resolution == (160, 120)
    glove = describe(folder / "shoot" / "day2" / "clip02.mp4")
    assert glove.settings.library is None and glove.settings.floor_m == 0.0
    colors = {style.name: style.color_srgb for style in read_take(glove.path).markers}
    assert colors["forearm.L"] == (225, 55, 55) and colors["trunk"] == (40, 150, 70)
    assert read_take(folder / "shoot" / "day2" / "jump").fps == 30.0


def test_the_table_names_every_field(page: str) -> None:
    from keymark.core.shoot.discovery import KNOWN_FIELDS as LISTED
    from keymark.core.take.description import KNOWN_FIELDS

    fields = re.findall(r"^\| `([\w$]+)` \|", page, flags=re.MULTILINE)
    assert set(fields) == {*KNOWN_FIELDS, *LISTED} - {"take"}
