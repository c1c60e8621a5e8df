"""An untrusted .blend: its pose assets are read, and nothing in it runs, with auto-run or without."""

from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.posture import Posture
from keymark.core.prior.library import Library, LibraryPosture
from keymark.operators.bridge.library import add_assets, read_library_blend

RandomPosture = Callable[[int], Posture]


@pytest.fixture
def auto_run() -> Iterator[None]:
    paths = bpy.context.preferences.filepaths
    before = paths.use_scripts_auto_execute
    paths.use_scripts_auto_execute = True
    yield
    paths.use_scripts_auto_execute = before


@pytest.fixture
def library(random_posture: RandomPosture) -> Library:
    postures = (LibraryPosture("A", random_posture(1)),)
    return Library("small", "Small", 1, "A. Person", "CC0-1.0", Actor.from_stature(1.7), postures)


def hostile_blend(path: Path, library: Library, proof: Path) -> None:
    """Pose assets that bring a text to be run on loading and a camera with a driver that writes a file."""
    source = f"open({str(proof)!r}, 'w').close()"
    (action,) = add_assets(library)
    text = bpy.data.texts.new("start.py")
    text.write(source)
    text.use_module = True
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    driver = camera.driver_add("location", 0).driver
    driver.type, driver.expression = "SCRIPTED", f"len([{source}])"
    action["text"], action["camera"] = text, camera
    bpy.data.libraries.write(str(path), {action, text, camera}, fake_user=True)
    bpy.ops.wm.read_homefile(use_empty=True)


def test_pose_assets_are_read_and_nothing_runs_or_stays(
    registered: None, auto_run: None, library: Library, tmp_path: Path
) -> None:
    proof = tmp_path / "ran"
    hostile_blend(tmp_path / "hostile.blend", library, proof)
    before = set(bpy.data.user_map())
    (read,) = read_library_blend(tmp_path / "hostile.blend")
    bpy.context.view_layer.update()
    assert [posture.name for posture in read.postures] == ["A"]
    assert not proof.exists()
    assert set(bpy.data.user_map()) == before
    assert "start.py" not in bpy.data.texts


def test_the_proof_would_be_there_had_it_run(library: Library, tmp_path: Path, auto_run: None) -> None:
    proof = tmp_path / "ran"
    hostile_blend(tmp_path / "hostile.blend", library, proof)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "hostile.blend"), use_scripts=True)
    bpy.ops.wm.read_homefile(use_empty=True)
    assert proof.exists()
