"""The zip that users install, in the Blender they install it into."""

import json
import math
import tomllib
from pathlib import Path

import pytest
from installed_blender import Blender

QUESTION = (
    "import cv2, scipy; print('ANSWER', cv2.__version__, scipy.__version__, cv2.__file__, scipy.__file__)"
)


@pytest.fixture(scope="module")
def converted(blender: Blender, demo_take: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder that converting the demonstration take by Blender's command line leaves."""
    output = tmp_path_factory.mktemp("converted") / "out"
    done = blender.run("--command", "keymark", "convert", demo_take, "--output", output)
    assert done.returncode == 0, done.stdout + done.stderr
    return output


def test_the_zip_installs_without_a_complaint(bare_blender: Blender, package: Path) -> None:
    done = bare_blender.install(package)
    assert done.returncode == 0
    assert "incompatible" not in done.stdout + done.stderr
    assert "Traceback" not in done.stderr
    assert (bare_blender.user / "extensions" / "user_default" / "keymark" / "core" / "errors.py").is_file()


def test_the_zip_holds_no_workshop(blender: Blender) -> None:
    installed = {item.name for item in (blender.user / "extensions" / "user_default" / "keymark").iterdir()}
    assert {"__init__.py", "blender_manifest.toml", "core", "operators", "presets", "LICENSE"} <= installed
    workshop = {"tests", "tools", "docs", "benchmarks", "Makefile", "pyproject.toml", "setup.py", "out"}
    assert not installed & workshop
    assert [name for name in installed if name.startswith(".")] == []


def test_the_libraries_are_those_of_the_zip(blender: Blender, repository: Path) -> None:
    done = blender.run("-b", "--python-exit-code", "1", "--python-expr", QUESTION)
    (answer,) = [line for line in done.stdout.splitlines() if line.startswith("ANSWER")]
    _, opencv, scipy, *files = answer.split(" ")
    project = tomllib.loads((repository / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    pins = dict(line.split("==") for line in project["dependencies"] if "==" in line)
    assert scipy == pins["scipy"]
    assert pins["opencv-python-headless"].startswith(opencv)
    assert all(Path(file).is_relative_to(blender.user) for file in files)


def test_the_command_explains_itself(blender: Blender) -> None:
    done = blender.run("--command", "keymark", "--help")
    assert done.returncode == 0, done.stderr
    assert "convert" in done.stdout


def test_a_take_is_converted(converted: Path, demo_take: Path) -> None:
    motion = json.loads((converted / "motion.json").read_text(encoding="utf-8"))
    take = json.loads((demo_take / "take.json").read_text(encoding="utf-8"))
    assert motion["fps"] == pytest.approx(take["fps"])
    assert motion["frame_start"] == take["frame_start"]
    assert len(motion["points"]) == len(motion["sigma_m"]) == 13
    for name, points in motion["points"].items():
        assert len(points) == len(motion["sigma_m"][name]) == take["frame_count"]
        assert all(len(point) == 3 and all(map(math.isfinite, point)) for point in points)
        assert all(0.0 < sigma < 1.0 for sigma in motion["sigma_m"][name])


def test_the_motion_opens_in_blender(converted: Path, demo_take: Path, blender: Blender) -> None:
    script = (
        "import bpy; rig = next(o for o in bpy.data.objects if o.type == 'ARMATURE'); "
        "camera = bpy.context.scene.camera; "
        "print('ANSWER', *rig.animation_data.action.frame_range, len(camera.data.background_images))"
    )
    done = blender.run("-b", converted / "motion.blend", "--python-exit-code", "1", "--python-expr", script)
    assert done.returncode == 0, done.stdout + done.stderr
    (answer,) = [line for line in done.stdout.splitlines() if line.startswith("ANSWER")]
    first, last, backgrounds = map(float, answer.split(" ")[1:])
    take = json.loads((demo_take / "take.json").read_text(encoding="utf-8"))
    assert (first, last) == (take["frame_start"], take["frame_start"] + take["frame_count"] - 1)
    assert backgrounds == 1


def test_the_bvh_has_every_frame(converted: Path, demo_take: Path) -> None:
    lines = (converted / "motion.bvh").read_text(encoding="utf-8").splitlines()
    take = json.loads((demo_take / "take.json").read_text(encoding="utf-8"))
    assert lines[0] == "HIERARCHY"
    (count,) = [int(line.split()[1]) for line in lines if line.startswith("Frames:")]
    assert count == take["frame_count"]
    assert len(lines) - 1 - next(n for n, line in enumerate(lines) if line.startswith("Frame Time:")) == count


def test_a_take_without_a_clip_is_refused_in_one_line(
    blender: Blender, demo_take: Path, tmp_path: Path
) -> None:
    take, output = tmp_path / "take", tmp_path / "out"
    take.mkdir()
    for name in ("take.json", "keyframes.json"):
        (take / name).write_bytes((demo_take / name).read_bytes())
    done = blender.run("--command", "keymark", "convert", take, "--output", output)
    assert done.returncode == 2, done.stdout + done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert "clip" in done.stderr
    assert not output.exists()


def test_removing_leaves_nothing_behind(bare_blender: Blender, package: Path) -> None:
    assert bare_blender.install(package).returncode == 0
    done = bare_blender.run("--command", "extension", "remove", "keymark")
    assert done.returncode == 0, done.stdout + done.stderr
    extensions = bare_blender.user / "extensions"
    assert not (extensions / "user_default" / "keymark").exists()
    assert list(extensions.glob(".local/lib/python*/site-packages/cv2")) == []


def test_the_shipped_libraries_come_with_it(blender: Blender, repository: Path) -> None:
    done = blender.run("--command", "keymark", "library", "list", "--json")
    assert done.returncode == 0, done.stdout + done.stderr
    listed = {row["identifier"]: row for row in json.loads(done.stdout)["libraries"]}
    shipped = {file.stem for file in (repository / "presets" / "keyframes").glob("*.json")}
    assert "walking" in shipped and shipped <= set(listed)
    assert all(listed[name]["problem"] == "" and listed[name]["postures"] >= 10 for name in shipped)


def test_nothing_is_written_into_its_own_folder(blender: Blender, converted: Path, package: Path) -> None:
    assert (converted / "motion.json").is_file()
    assert blender.changed_files(package) == set()
