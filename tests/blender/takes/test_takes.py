"""Several takes and performers in one scene."""

from dataclasses import replace
from pathlib import Path

import bpy
import pytest
from keymark.core.take.take import Take
from keymark.core.take.take_file import write_take
from keymark.operators.shell.take_state import TakeState, digest_of
from keymark.operators.shell.takes import active_take, unique_name

pytestmark = pytest.mark.usefixtures("registered")


def open_take(take: Take, times: int = 1) -> bpy.types.Scene:
    for _ in range(times):
        assert bpy.ops.keymark.open_take(filepath=str(take.folder)) == {"FINISHED"}
    return bpy.context.scene


@pytest.mark.parametrize(
    ("name", "others", "free"),
    [
        ("walk", [], "walk"),
        ("walk", ["walk"], "walk.001"),
        ("walk.001", ["walk", "walk.001"], "walk.002"),
        ("walk", ["walk", "walk.001", "run"], "walk.002"),
        ("v1.5", ["v1.5"], "v1.5.001"),
    ],
)
def test_names_are_made_unique(name: str, others: list[str], free: str) -> None:
    assert unique_name(name, others) == free


def test_a_take_opened_twice_has_everything_twice_but_the_clip(tiny_take: Take) -> None:
    takes = open_take(tiny_take, times=2).keymark.takes
    assert takes[0].clip == takes[1].clip
    for name in ("identifier", "armature", "camera", "keyframe_action"):
        assert getattr(takes[0], name) != getattr(takes[1], name)
    for take, name in zip(takes, ("tiny", "tiny.001"), strict=True):
        assert (take.name, take.armature.name) == (name, f"{name} Actor")
        assert take.keyframe_action.name == f"{name} Actor Keyframes"
    takes[1].name = "tiny"
    assert takes[1].name == "tiny.001"
    takes[1].name = " "
    assert takes[1].name == "Take"


def test_switching_brings_clip_camera_rate_and_range(tiny_take: Take, tmp_path: Path) -> None:
    scene = open_take(tiny_take)
    folder = tmp_path / "later"
    folder.mkdir()
    (folder / "clip.mp4").write_bytes(tiny_take.clip.read_bytes())
    later = replace(tiny_take, folder=folder, clip=folder / "clip.mp4", frame_start=101)
    write_take(later, folder)
    bpy.ops.keymark.open_take(filepath=str(folder))
    first, second = scene.keymark.takes
    scene.frame_set(105)
    for index, take, extent in ((0, first, (1, 13)), (1, second, (101, 113)), (0, first, (1, 13))):
        scene.keymark.active_take = index
        assert (scene.camera, scene.active_clip) == (take.camera, take.clip)
        assert (scene.frame_start, scene.frame_end) == extent
        assert extent[0] <= scene.frame_current <= extent[1]


def test_takes_of_one_clip_keep_the_animators_range(tiny_take: Take) -> None:
    scene = open_take(tiny_take)
    scene.frame_end = 7
    bpy.ops.keymark.add_performer()
    scene.keymark.active_take = 0
    assert scene.frame_end == 7


def test_switching_selects_the_takes_actor_but_not_from_under_the_animator(tiny_take: Take) -> None:
    scene = open_take(tiny_take)
    bpy.ops.keymark.add_performer()
    bpy.ops.keymark.build_actor()
    actors = [take.armature for take in scene.keymark.takes]
    for index in (0, 1, 0):
        scene.keymark.active_take = index
        assert bpy.context.view_layer.objects.active == actors[index]
        assert list(bpy.context.view_layer.objects.selected) == [actors[index]]
    bpy.ops.object.mode_set(mode="POSE")
    scene.keymark.active_take = 1
    assert bpy.context.view_layer.objects.active == actors[0]
    bpy.ops.object.mode_set(mode="OBJECT")


def test_another_performer_shares_clip_and_camera_only(tiny_take: Take) -> None:
    bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip))
    scene = bpy.context.scene
    bpy.ops.keymark.build_actor()
    bpy.ops.keymark.add_performer()
    first, second = scene.keymark.takes
    assert second == active_take(scene)
    assert (second.clip, second.camera) == (first.clip, first.camera)
    assert second.guessed_lens_mm == first.guessed_lens_mm > 0.0
    assert second.armature is None and len(second.markers) == 0
    bpy.ops.keymark.keep_lens()
    assert first.guessed_lens_mm == 0.0
    bpy.ops.keymark.add_performer()
    assert [take.name for take in scene.keymark.takes] == ["tiny", "tiny Performer 2", "tiny Performer 3"]


def test_another_clip_for_one_performer_leaves_the_others_camera(tiny_take: Take, tmp_path: Path) -> None:
    bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip))
    bpy.ops.keymark.add_performer()
    other = tmp_path / "other.mp4"
    other.write_bytes(tiny_take.clip.read_bytes())
    bpy.ops.keymark.load_footage(filepath=str(other))
    first, second = bpy.context.scene.keymark.takes
    assert first.camera != second.camera
    assert first.camera.data.background_images[0].clip == first.clip != second.clip


def test_two_performers_are_reconstructed_independently(tiny_take: Take) -> None:
    scene = open_take(tiny_take, times=2)
    for index in (0, 1):
        scene.keymark.active_take = index
        active_take(scene).method = "interpolation"
        assert bpy.ops.keymark.reconstruct() == {"FINISHED"}
    first, second = scene.keymark.takes
    assert first.motion_action != second.motion_action
    names = [take.motion_action.name for take in (first, second)]
    assert names == ["tiny Actor Motion", "tiny.001 Actor Motion"]
    before = first.armature.animation_data.action, len(first.keyframe_action.slots)
    scene.frame_set(4)
    second.armature.pose.bones["forearm.L"].rotation_euler.x = 1.0
    bpy.ops.keymark.store_keyframe()
    bpy.ops.keymark.reconstruct()
    assert (first.armature.animation_data.action, len(first.keyframe_action.slots)) == before


def test_a_take_is_removed_from_the_list_alone(tiny_take: Take) -> None:
    scene = open_take(tiny_take, times=2)
    kept = len(bpy.data.objects), len(bpy.data.actions), len(bpy.data.movieclips)
    assert bpy.ops.keymark.remove_take() == {"FINISHED"}
    assert active_take(scene).name == "tiny"
    assert scene.camera == active_take(scene).camera
    assert (len(bpy.data.objects), len(bpy.data.actions), len(bpy.data.movieclips)) == kept
    bpy.ops.keymark.remove_take()
    assert len(scene.keymark.takes) == 0
    with pytest.raises(RuntimeError, match="no take to remove"):
        bpy.ops.keymark.remove_take()


def test_a_take_is_removed_with_its_data_but_not_anothers(tiny_take: Take) -> None:
    scene = open_take(tiny_take, times=2)
    first = scene.keymark.takes[0]
    camera, armature = first.camera, first.armature
    bpy.ops.keymark.remove_take(delete_data=True)
    assert {each for each in bpy.data.objects} == {camera, armature}
    assert len(bpy.data.armatures) == len(bpy.data.cameras) == len(bpy.data.actions) == 1
    assert len(bpy.data.movieclips) == 1
    bpy.ops.keymark.remove_take(delete_data=True)
    assert len(bpy.data.objects) == len(bpy.data.actions) == len(bpy.data.movieclips) == 0


def test_the_next_step_follows_what_is_there(tiny_take: Take) -> None:
    scene = bpy.context.scene
    bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip))
    take, said = active_take(scene), []

    def says(words: str) -> bool:
        said.append(TakeState(take).next[1])
        return words in said[-1]

    assert says("where the camera stood")
    bpy.ops.keymark.keep_camera()
    assert says("choose what to follow")
    bpy.ops.keymark.add_marker()
    assert says("pick the markers' colors")
    take.markers[0].color = (0.1, 0.5, 0.2)
    assert says("build the actor")
    bpy.ops.keymark.build_actor()
    assert says("pose all keyframes")
    for frame in (1, 5):
        take.proposals.add().frame = frame
    for frame in (1, 5):
        assert says("pose all keyframes")
        scene.frame_set(frame)
        bpy.ops.keymark.store_keyframe()
    assert says("reconstruct")
    take.motion_action = bpy.data.actions.new("Motion")
    assert says("review, then a character")
    take.review.confidence = 0.28
    assert says("pose more keyframes")
    take.review.weak_frames.add().frame = 3
    assert says("pose the weak frames")
    scene.frame_set(3)
    bpy.ops.keymark.store_keyframe()
    assert says("reconstruct again")
    take.review.confidence = 0.8
    assert says("review, then a character")
    take.finish.action, take.finish.made_from = take.keyframe_action, digest_of(take.motion_action)
    assert says("export")
    take.clip_state.missing = True
    assert says("find the clip")
    assert max(map(len, said)) < 36
