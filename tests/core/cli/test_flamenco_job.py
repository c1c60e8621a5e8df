"""The Flamenco job type: that a Manager would take it, and the tasks it makes."""

import json
import shutil
import subprocess
from pathlib import Path, PurePosixPath
from types import SimpleNamespace
from typing import Any

import pytest
from keymark.core.files.paths import VIDEOS
from keymark.core.shoot.discovery import find_takes
from keymark.operators.cli.main import build_parser

NODE = shutil.which("node")
pytestmark = pytest.mark.skipif(NODE is None, reason="there is no Node, in which the job type is compiled")

SETTINGS = {
    "shoot": "/mnt/shoots/walk",
    "output": "/mnt/results/walk",
    "tasks": 12,
    "program": "{blender}",
    "name": "Walk",
}


@pytest.fixture
def script(repository: Path) -> Path:
    return repository / "presets" / "flamenco" / "keymark_convert.js"


def compiled(script: Path, settings: dict[str, Any], name: str = "A job") -> dict[str, Any]:
    """The tasks that a Manager makes of a job.

    Raises:
        ValueError: It does not take the job; the text says why.
    """
    stand_in = Path(__file__).parents[2] / "farm" / "flamenco_stand_in.js"
    done = subprocess.run(
        [str(NODE), str(stand_in), str(script)],
        input=json.dumps({"name": name, "settings": settings}),
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=60,
    )
    if done.returncode != 0:
        raise ValueError(done.stderr)
    return dict(json.loads(done.stdout))


def words(task: dict[str, Any]) -> list[str]:
    """The arguments that a task passes to its program."""
    (command,) = task["commands"]
    assert command["name"] == "exec" and command["parameters"]["exe"]
    return list(command["parameters"]["args"])


def options(task: dict[str, Any]) -> dict[str, Any]:
    found = words(task)
    assert found[:2] == ["--command", "keymark"]
    return vars(build_parser(found[2]).parse_args(found[2:]))


def test_every_task_has_its_share_and_the_merge_waits_for_all(script: Path) -> None:
    tasks = compiled(script, SETTINGS)["tasks"]
    *converting, merging = tasks
    assert [task["name"] for task in converting] == [f"convert-{part:02d}" for part in range(1, 13)]
    shares = [options(task) for task in converting]
    assert [share["part"] for share in shares] == [f"{part}/12" for part in range(1, 13)]
    assert {(share["shoot"], share["output"], share["jobs"]) for share in shares} == {
        (Path("/mnt/shoots/walk"), Path("/mnt/results/walk"), 1)
    }
    assert {(share["library"], share["failed_takes"]) for share in shares} == {(None, "pass")}
    assert merging["dependencies"] == [task["name"] for task in converting]
    merge = options(merging)
    assert merge["results"] == Path("/mnt/results/walk") and merge["name"] == "Walk"
    assert merge["output"] == Path("/mnt/results/walk/asset_library/Walk.blend")
    assert {task["type"] for task in tasks} == {"blender"}
    assert {task["commands"][0]["parameters"]["exe"] for task in tasks} == {"{blender}"}


def test_choices_reach_the_command_line(script: Path) -> None:
    chosen = {**SETTINGS, "tasks": 1, "method": "ekf", "library": "walking", "merge": False, "go_on": False}
    (task,) = compiled(script, {**chosen, "program": "/opt/keymark"})["tasks"]
    share = options(task)
    assert (share["method"], share["library"], share["failed_takes"]) == ("ekf", "walking", "fail")
    assert task["name"] == "convert-1" and task["commands"][0]["parameters"]["exe"] == "/opt/keymark"
    assert share["keyframes"] is None
    every = options(compiled(script, {**SETTINGS, "keyframes": "auto"})["tasks"][0])
    assert (every["keyframes"], every["library"]) == ("auto", None)
    own = {**SETTINGS, "library": "walking", "own_library_path": "/mnt/anna.json"}
    assert options(compiled(script, own)["tasks"][0])["library"] == "/mnt/anna.json"
    said = {**SETTINGS, "library": "as the takes say", "own_library": "", "own_library_path": ""}
    said["keyframes"] = "as the takes say"
    share = options(compiled(script, said)["tasks"][0])
    assert (share["keyframes"], share["library"]) == (None, None)
    plain = {**SETTINGS, "keypoints": "pose.json", "evidence": "keypoints,contours"}
    share = options(compiled(script, plain)["tasks"][0])
    assert share["keypoints"] == [Path("pose.json")] and share["evidence"] == ("keypoints", "contours")
    assert options(compiled(script, said)["tasks"][0])["evidence"] is None


def test_paths_count_as_blender_has_resolved_them(script: Path) -> None:
    resolved = {"shoot": "//clips", "output": "//out", "shoot_path": r"F:\clips", "output_path": r"F:\out"}
    tasks = compiled(script, {**SETTINGS, **resolved})["tasks"]
    assert words(tasks[0])[2:6] == ["batch", r"F:\clips", "--output", r"F:\out"]
    assert r"F:\out\asset_library\Walk.blend" in words(tasks[-1])


@pytest.mark.parametrize(
    ("name", "file"), [("", "A job"), ("a/b: c?", "a-b- c-"), ("Été 2", "Été 2"), ("  ", "shoot")]
)
def test_the_library_has_a_name_that_every_system_allows(script: Path, name: str, file: str) -> None:
    merge = options(compiled(script, {**SETTINGS, "name": name})["tasks"][-1])
    assert merge["output"].name == f"{file}.blend" and merge["name"] == file


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"tasks": 0}, "Tasks is 0; it must be 1 or more"),
        ({"tasks": -3}, "Tasks is -3; it must be 1 or more"),
        ({"shoot": ""}, "shoot is ''; it must be the folder of the takes"),
        ({"shoot": "//clips"}, "shoot is '//clips'; it must be"),
        (
            {"keyframes": "auto", "library": "walking"},
            "Keyframes is auto and the library is walking; it must be one of them",
        ),
        ({"output": "//out"}, "output is '//out'; it must be the folder for the results"),
    ],
)
def test_unusable_settings_are_refused_with_a_sentence(
    script: Path, change: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(ValueError, match="^") as refused:
        compiled(script, {**SETTINGS, **change})
    assert str(refused.value).startswith(sentence)


def test_the_number_of_tasks_follows_the_folder(script: Path, tmp_path: Path) -> None:
    setting = next(one for one in compiled(script, SETTINGS)["jobType"]["settings"] if one["key"] == "tasks")
    for name in ("a/clip.mp4", "a/take.json", "b/one.MOV", "b/two.mp4", "b/notes.txt", "c/d/three.mkv"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("{}", encoding="utf-8")
    (tmp_path / "shoot.json").write_text("{}", encoding="utf-8")
    names = {
        "Path": Path,
        "abspath": lambda path: Path(path),
        "settings": SimpleNamespace(shoot=str(tmp_path)),
    }
    assert eval(setting["eval"], {}, names) == len(find_takes(tmp_path).takes) == 4
    names["settings"] = SimpleNamespace(shoot="")
    assert eval(setting["eval"], {}, names) == 0
    assert all(f"'{ending}'" in setting["eval"] for ending in VIDEOS)


def test_paths_are_made_absolute_when_the_job_is_submitted(script: Path) -> None:
    settings = {one["key"]: one for one in compiled(script, SETTINGS)["jobType"]["settings"]}
    here = PurePosixPath("/project")
    given = SimpleNamespace(shoot="clips", output="", own_library="anna.json")
    names = {"abspath": lambda path: here / path, "settings": given, "jobname": "Night"}
    found = {
        key: eval(settings[key]["eval"], {}, names)
        for key in ("shoot_path", "output_path", "own_library_path", "name")
    }
    expected = {"shoot_path": "/project/clips", "output_path": "", "own_library_path": "/project/anna.json"}
    assert found == {**expected, "name": "Night"}
    assert all(settings[key]["visible"] == "web" for key in expected)


def test_the_libraries_to_choose_from_are_those_that_come_with_keymark(
    script: Path, repository: Path
) -> None:
    settings = {one["key"]: one for one in compiled(script, SETTINGS)["jobType"]["settings"]}
    shipped = sorted(
        json.loads(file.read_text(encoding="utf-8"))["identifier"]
        for file in (repository / "presets" / "keyframes").glob("*.json")
    )
    assert settings["library"]["choices"] == ["as the takes say", *shipped]
