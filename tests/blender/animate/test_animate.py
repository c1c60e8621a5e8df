"""*Animate*: from a clip and a height to a take whose every step is there, and what an early end leaves."""

import shutil
from pathlib import Path

import bpy
import numpy as np
import pytest
from _armatures import build_character
from _characters import plain_character
from _synthetic_take import BODY, gliding, true_postures, write_keypoints, write_video
from bpy.types import Object, PropertyGroup
from keymark.core.camera.camera_fields import CameraPlacement
from keymark.core.prior.learning import LibraryMetadata, learn_library
from keymark.operators.animate import NOTHING
from keymark.operators.animate.stages import animate, follow_found_file, turned_copy
from keymark.operators.bridge.footage import read_placement
from keymark.operators.follow.evidence import keypoint_path
from keymark.operators.footage.load_footage import load_into_take
from keymark.operators.library import registry
from keymark.operators.reconstruct.reconstruct import PreviewedJob
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture
def clip(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A bare clip with its keypoints beside it, and one small library."""
    write_video(tmp_path / "hall.mp4", gliding())
    write_keypoints(tmp_path / "hall.keypoints.json", gliding())
    posture, said = true_postures(24), LibraryMetadata("Swaying", "Nobody")
    library = learn_library(BODY, posture, np.arange(24) / 30.0, said)
    monkeypatch.setattr(registry, "all_libraries", lambda: [library])
    return tmp_path / "hall.mp4"


def box(name: str, y_m: float) -> Object:
    bpy.ops.mesh.primitive_cube_add(size=0.4, location=(0.0, y_m, 1.0))
    made = bpy.context.object
    made.name = name
    return made


def only_take() -> PropertyGroup:
    assert len(bpy.context.scene.keymark.takes) == 1
    return active_take(bpy.context.scene)


@pytest.mark.parametrize(
    ("height", "sentence"), [(17.8, "Height is 17.8; meters"), (0.0, "Height is 0; meters")]
)
def test_a_height_that_is_none_is_a_sentence(clip: Path, height: float, sentence: str) -> None:
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.keymark.animate(filepath=str(clip), stature=height)
    assert not bpy.context.scene.keymark.takes


def test_all_steps_are_there_and_the_character_of_a_file_performs(clip: Path, tmp_path: Path) -> None:
    armature = build_character(plain_character())
    file, name = tmp_path / "anna.blend", armature.name
    bpy.data.libraries.write(str(file), {bpy.context.scene})
    bpy.data.batch_remove([armature, armature.data])
    scenes = len(bpy.data.scenes)
    before, behind = box("Before", -1.5), box("Behind", 6.0)
    done = bpy.ops.keymark.animate(
        filepath=str(clip), stature=1.75, character="FILE", character_file=str(file)
    )
    assert done == {"FINISHED"} and len(bpy.data.scenes) == scenes
    take, scene = only_take(), bpy.context.scene
    assert take.name == "hall" and take.stature == pytest.approx(1.75) and take.follow.use_keypoints
    assert [keypoint_path(entry).name for entry in take.follow.files] == ["hall.keypoints.json"]
    assert TakeState(take).found_count >= 3 and (scene.frame_start, scene.frame_end) == (1, 40)
    assert (
        take.motion_action is not None
        and take.finish.action is not None
        and not TakeState(take).final_is_outdated
    )
    (character,) = take.characters
    assert character.armature.name == name and character.results[0].action is not None
    assert before.hide_get() and not behind.hide_get() and not character.armature.hide_get()
    assert "Found: " in take.camera_findings
    assert take.matching.floor == "HEIGHT" and take.matching.floor_height == 0.0
    placement = read_placement(take.camera)
    assert isinstance(placement, CameraPlacement) and 0.5 < placement.height_m < 2.5
    hips = take.armature.matrix_world @ take.armature.pose.bones["pelvis"].head
    assert abs(hips.x) < 0.6 and 0.7 < hips.z < 1.2


class Watching(PreviewedJob):
    """An operator as `modal` drives it, without a window."""

    report = start = finish = lambda self, *_: None


def test_the_actor_shows_the_motion_while_it_is_estimated(clip: Path) -> None:
    take = load_into_take(bpy.context, clip, False)
    follow_found_file(take, clip)
    operator, shown = Watching(), []
    for progress in animate(operator, bpy.context.scene, 1.75, NOTHING, ""):
        if progress.preview is not None and operator.preview is not None:
            operator.watch(progress)
            actor, scene = only_take().armature, bpy.context.scene
            shown.append((progress.stage, actor.animation_data.action, scene.frame_current))
    assert len(shown) >= 3 and {stage for stage, *_ in shown} == {"Estimating the motion"}
    assert {action for _, action, _ in shown} == {None} and len({frame for *_, frame in shown}) >= 3
    take = only_take()
    assert operator.preview is None and take.armature.animation_data.action == take.finish.action


def test_an_early_end_leaves_the_stages_that_are_complete(clip: Path) -> None:
    context = bpy.context
    take = load_into_take(context, clip, False)
    follow_found_file(take, clip)
    job = animate(Watching(), context.scene, 1.75, NOTHING, "")
    stages = []
    for progress in job:
        stages.append((progress.stage, progress.fraction))
        if progress.fraction > 0.72:
            break
    job.close()
    take = only_take()
    assert [fraction for _, fraction in stages] == sorted(fraction for _, fraction in stages)
    assert take.armature is not None and TakeState(take).found_count >= 3 and take.motion_action is None
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"} and take.motion_action is not None


@pytest.mark.parametrize("name", ["", "none.mp4", "words.mp4"])
def test_a_clip_that_is_none_changes_nothing(tmp_path: Path, name: str) -> None:
    (tmp_path / "words.mp4").write_text("no video", encoding="utf-8")
    path = str(tmp_path / name) if name else ""
    with pytest.raises(RuntimeError):
        bpy.ops.keymark.animate(filepath=path, character=NOTHING)
    assert not len(bpy.context.scene.keymark.takes) and not bpy.data.movieclips


def test_the_named_part_is_animated_and_the_take_keeps_it(clip: Path) -> None:
    part = {"is_part": True, "first_frame": 8, "last_frame": 30, "performer": 1}
    bpy.ops.keymark.animate(filepath=str(clip), stature=1.75, character=NOTHING, **part)
    take = only_take()
    assert take.part.inputs == {"shot": (8, 30), "performer": 1}
    assert "in 17 frames" in take.review.unseen
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"} and "in 17 frames" in take.review.unseen
    take.part.last_frame = 300
    with pytest.raises(
        RuntimeError, match="Frames 8 to 300 are not all in hall.mp4, whose frames are 1 to 40"
    ):
        bpy.ops.keymark.reconstruct()


def test_a_turned_copy_is_loaded_upright(clip: Path) -> None:
    copy = turned_copy(clip, 90)
    assert copy == clip.with_name("hall.turned90.mp4") and copy.stat().st_size == clip.stat().st_size
    take = load_into_take(bpy.context, copy, False)
    width, height = bpy.data.movieclips.load(str(clip)).size
    assert tuple(take.clip.size) == (height, width) and width != height


def test_a_picture_on_its_side_is_turned_by_itself(repository: Path, tmp_path: Path) -> None:
    """By `turn4_lying_video_without_a_flag`."""
    source = repository.parent / "shared" / "failing" / "turn4_lying_video_without_a_flag" / "sideways.mp4"
    if not source.is_file():
        pytest.skip("no shared/failing")
    bpy.ops.keymark.animate(filepath=str(shutil.copyfile(source, tmp_path / source.name)), stature=1.76)
    take = only_take()
    assert Path(bpy.path.abspath(take.clip.filepath)).name == "sideways.turned270.mp4"
    assert tuple(take.clip.size) == (320, 240) and take.name == "sideways"
    hips, head = (take.armature.pose.bones[name].head.z for name in ("pelvis", "head"))
    assert 0.8 < hips < 1.0 and head > hips + 0.3
