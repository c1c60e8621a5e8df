"""A folder of takes through Blender's own command line: two Blenders at work, one of which is killed."""

import json
import os
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from _synthetic_take import write_shoot
from installed_blender import Blender

NAMES = ("day1/take01", "day1/take02", "day1/take03")
PROCESSES = Path("/proc")
OPENED = """
import bpy
from pathlib import Path
rig = next(o for o in bpy.data.objects if o.type == "ARMATURE")
first, last = rig.animation_data.action.frame_range
clip = bpy.context.scene.camera.data.background_images[0].clip
print("ANSWER", int(first), int(last), Path(bpy.path.abspath(clip.filepath)).exists())
"""
GATHERED = "import bpy; print('ANSWER', sorted(a.name for a in bpy.data.actions if a.asset_data))"
REPEATED = ("motion.json", "motion.bvh")
"""What two runs give alike to the last byte: a .blend holds addresses, and the record its digest."""


def results(folder: Path) -> dict[str, bytes]:
    """Every file of the takes' results by its way."""
    files = {str(file.relative_to(folder)): file for name in NAMES for file in (folder / name).rglob("*")}
    return {way: file.read_bytes() for way, file in files.items() if file.is_file()}


def workers(user: Path) -> Iterator[int]:
    """The processes that work for a batch with this user folder."""
    for entry in PROCESSES.iterdir():
        if entry.name.isdigit():
            try:
                words = (entry / "cmdline").read_bytes().split(b"\0")
                mine = os.fsencode(str(user)) in (entry / "environ").read_bytes()
            except OSError:  # it has ended meanwhile, or is not ours
                continue
            if mine and words[0].endswith(b"blender") and b"worker" in words:
                yield int(entry.name)


@pytest.fixture(scope="module")
def shoot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three small takes."""
    return write_shoot(tmp_path_factory.mktemp("shoot") / "shoot")


@pytest.fixture(scope="module")
def undisturbed(blender: Blender, shoot: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What a batch with one worker makes of it."""
    output = tmp_path_factory.mktemp("undisturbed") / "out"
    done = blender.run("--command", "keymark", "batch", shoot, "--output", output, "--jobs", "1", "--json")
    assert done.returncode == 0, done.stdout + done.stderr
    said = json.loads(done.stdout)
    assert [(take["take"], take["status"]) for take in said["takes"]] == [(n, "converted") for n in NAMES]
    return output


def test_every_take_is_there_and_summed_up(undisturbed: Path) -> None:
    for name in NAMES:
        files = {file.name for file in (undisturbed / name).iterdir()}
        assert {"motion.json", "motion.blend", "motion.bvh", "conversion.json"} <= files
    rows = [json.loads(line) for line in (undisturbed / "summary.jsonl").read_text("utf-8").splitlines()]
    assert [(row["take"], row["status"]) for row in rows] == [(name, "converted") for name in NAMES]
    page = (undisturbed / "summary.html").read_text(encoding="utf-8")
    assert all(name.rpartition("/")[2] in page for name in NAMES)


def test_a_result_opens_with_its_clip(undisturbed: Path, blender: Blender) -> None:
    done = blender.run(
        "-b", undisturbed / NAMES[0] / "motion.blend", "--python-exit-code", "1", "--python-expr", OPENED
    )
    assert "ANSWER 1 8 True" in done.stdout, done.stdout + done.stderr


@pytest.mark.skipif(not PROCESSES.is_dir(), reason="the workers are found among the processes in /proc")
def test_a_killed_worker_costs_nothing(
    blender: Blender, shoot: Path, undisturbed: Path, tmp_path: Path
) -> None:
    words = [*blender.command, "--command", "keymark", "batch", str(shoot), "--output", str(tmp_path / "out")]
    own = {
        "BLENDER_USER_RESOURCES": str(blender.user),
        "XDG_CACHE_HOME": str(blender.user / "cache"),
        "KEYMARK_TEST": str(tmp_path),  # by which its workers are known
    }
    with subprocess.Popen(
        [*words, "--jobs", "2"],
        env={**os.environ, **own},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    ) as batch:
        assert batch.stdout is not None
        said = ""
        for line in batch.stdout:
            said += line
            if "converted" in line:
                break
        killed = list(workers(tmp_path))
        for process in killed:
            os.kill(process, signal.SIGKILL)
        said += batch.stdout.read()
        assert batch.wait() == 0, said
    assert killed, said
    alike = [
        {way: data for way, data in results(folder).items() if Path(way).name in REPEATED}
        for folder in (tmp_path / "out", undisturbed)
    ]
    assert results(tmp_path / "out").keys() == results(undisturbed).keys()
    assert len(alike[0]) == len(NAMES) * len(REPEATED) and alike[0] == alike[1]


def test_motions_are_gathered(blender: Blender, undisturbed: Path, tmp_path: Path) -> None:
    library = tmp_path / "library.blend"
    done = blender.run("--command", "keymark", "merge", undisturbed, "--output", library, "--name", "Shoot")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "day1" in (tmp_path / "blender_assets.cats.txt").read_text(encoding="utf-8")
    done = blender.run("-b", library, "--python-exit-code", "1", "--python-expr", GATHERED)
    (answer,) = [line for line in done.stdout.splitlines() if line.startswith("ANSWER")]
    assert answer == f"ANSWER {[name.replace('/', ' ') for name in NAMES]}"


def test_a_shoot_is_checked(blender: Blender, shoot: Path) -> None:
    before = sorted(shoot.rglob("*"))
    done = blender.run("--command", "keymark", "check", shoot)
    assert done.returncode == 0, done.stdout + done.stderr
    assert all(name in done.stdout for name in NAMES)
    assert sorted(shoot.rglob("*")) == before
