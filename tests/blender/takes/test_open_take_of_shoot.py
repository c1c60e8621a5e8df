"""Takes of a shoot in Blender: clips without a folder open like folders, and are saved to stand alone."""

import json
from pathlib import Path

import bpy
import pytest
from _synthetic_take import write_shoot
from keymark.core.errors import InputError
from keymark.core.shoot.discovery import take_path
from keymark.core.take.take_file import read_take
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    """A clip of a shoot, with a description of its own that says next to nothing."""
    shoot = write_shoot(tmp_path / "shoot", 1, 8)
    (shoot / "day1" / "take01.take.json").write_text(
        '{"actor": {"height_m": 1.76}, "hands": false}', encoding="utf-8"
    )
    return shoot / "day1" / "take01.mp4"


@pytest.mark.parametrize("chosen", ["take01.mp4", "take01.take.json"])
def test_a_clip_of_a_shoot_opens_and_is_saved_to_stand_alone(clip: Path, chosen: str, tmp_path: Path) -> None:
    bpy.ops.keymark.open_take(filepath=str(clip.with_name(chosen)))
    take = active_take(bpy.context.scene)
    assert (take.name, len(take.markers), take.stature) == ("take01", 5, pytest.approx(1.76, abs=0.01))
    bpy.ops.keymark.save_take(directory=str(tmp_path / "saved"))
    alone, before = read_take(tmp_path / "saved"), read_take(clip)
    assert [keyframe.index for keyframe in alone.keyframes] == [k.index for k in before.keyframes]
    assert alone.clip.read_bytes() == clip.read_bytes()
    assert alone.camera.matrix_world == pytest.approx(before.camera.matrix_world, abs=1e-6)
    assert {style.name for style in alone.markers} == {style.name for style in before.markers}
    saved = json.loads((tmp_path / "saved" / "take.json").read_text(encoding="utf-8"))
    assert "actor" in saved and saved["hands"] is take.follow.use_hands is False


def test_the_description_beside_a_clip_can_be_dropped(clip: Path) -> None:
    bpy.ops.keymark.open_dropped(filepath=str(clip.with_name("take01.take.json")))
    assert active_take(bpy.context.scene).name == "take01"


def test_a_file_means_one_take(clip: Path) -> None:
    assert take_path(clip) == take_path(clip.with_name("take01.take.json")) == clip
    assert take_path(clip.parent / "take.json") == clip.parent
    clip.unlink()
    with pytest.raises(InputError, match="0 clips beside it are called take01"):
        take_path(clip.with_name("take01.take.json"))


def test_a_take_is_never_saved_where_it_would_hide_others(clip: Path, tmp_path: Path) -> None:
    bpy.ops.keymark.open_take(filepath=str(clip))
    with pytest.raises(RuntimeError, match="holds other takes, as take01.mp4"):
        bpy.ops.keymark.save_take(directory=str(clip.parent))
    assert not (clip.parent / "take.json").exists()
    for _ in range(2):
        bpy.ops.keymark.save_take(directory=str(tmp_path / "takes" / "one"))
    with pytest.raises(RuntimeError, match="holds other takes, as one"):
        bpy.ops.keymark.save_take(directory=str(tmp_path / "takes"))
