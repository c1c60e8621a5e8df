"""What Keymark keeps in a file: its versions, other scenes and files, links, overrides and undo."""

from pathlib import Path

import bpy
import keymark
import pytest
from keymark.core.take.take import Take
from keymark.operators.shell.takes import VERSION, active_take, add_take
from keymark.operators.takes.upgrade import ensure_unique_identifiers, is_newer

RIG = "tiny Actor"


def open_take(take: Take) -> bpy.types.PropertyGroup:
    assert bpy.ops.keymark.open_take(filepath=str(take.folder)) == {"FINISHED"}
    return active_take(bpy.context.scene)


def save_and_reopen(path: Path) -> bpy.types.Scene:
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return bpy.context.scene


def wear_red(take: bpy.types.PropertyGroup) -> None:
    bpy.ops.keymark.add_marker()
    take.markers[0].segment, take.markers[0].color = "forearm.L", (220 / 255, 40 / 255, 40 / 255)


@pytest.fixture
def rig_file(registered: None, tiny_take: Take, tmp_path: Path) -> Path:
    """A .blend whose rig has keyframes, and an empty file in which it is to be used."""
    open_take(tiny_take)
    path = tmp_path / "rig.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return path


def rig_of(file: Path, clip: Path, link: bool = False) -> bpy.types.Object:
    """The rig of another file, appended or linked, in a scene with the footage."""
    with bpy.data.libraries.load(str(file), link=link) as (_source, target):
        target.objects = [RIG]
    bpy.ops.keymark.load_footage(filepath=str(clip))
    return target.objects[0]


@pytest.mark.usefixtures("registered")
def test_a_file_says_its_version_and_keeps_its_takes(tiny_take: Take, tmp_path: Path) -> None:
    identifier = open_take(tiny_take).identifier
    scene = save_and_reopen(tmp_path / "scene.blend")
    take = active_take(scene)
    assert (scene.keymark.version, take.identifier, len(take.markers)) == (VERSION, identifier, 5)
    assert take.armature.animation_data.action == take.keyframe_action
    assert not is_newer(scene)


@pytest.mark.usefixtures("registered")
def test_what_a_newer_keymark_wrote_is_left_alone(tiny_take: Take, tmp_path: Path) -> None:
    take = open_take(tiny_take)
    take.identifier = ""  # as if it meant something else by then
    bpy.context.scene.keymark.version = VERSION + 1
    scene = save_and_reopen(tmp_path / "scene.blend")
    assert is_newer(scene)
    assert active_take(scene).identifier == ""
    add_take(scene, "Another")
    assert scene.keymark.version == VERSION + 1


def test_switching_the_extension_off_and_on_keeps_everything(tiny_take: Take) -> None:
    keymark.register()
    identifier = open_take(tiny_take).identifier
    keymark.unregister()
    keymark.register()
    take = active_take(bpy.context.scene)
    assert (take.identifier, len(take.markers), take.armature.name) == (identifier, 5, RIG)
    keymark.unregister()


def test_an_appended_rig_is_an_actor(rig_file: Path, tiny_take: Take) -> None:
    rig, scene = rig_of(rig_file, tiny_take.clip), bpy.context.scene
    scene.collection.objects.link(rig)
    take = active_take(scene)
    take.armature, take.keyframe_action = rig, rig.animation_data.action
    keys = len(take.keyframe_action.layers[0].strips[0].channelbags[0].fcurves[0].keyframe_points)
    scene.frame_set(4)
    assert bpy.ops.keymark.store_keyframe() == {"FINISHED"}
    curve = take.keyframe_action.layers[0].strips[0].channelbags[0].fcurves[0]
    assert len(curve.keyframe_points) == keys + 1
    wear_red(take)
    take.method = "interpolation"
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}


def test_a_linked_rig_asks_for_an_override(rig_file: Path, tiny_take: Take) -> None:
    rig, scene = rig_of(rig_file, tiny_take.clip, link=True), bpy.context.scene
    scene.collection.objects.link(rig)
    active_take(scene).armature = rig
    for operator in (bpy.ops.keymark.store_keyframe, bpy.ops.keymark.show_action):
        with pytest.raises(RuntimeError, match="make a library override of it first"):
            operator()


def test_a_library_override_is_an_actor(rig_file: Path, tiny_take: Take, tmp_path: Path) -> None:
    before, scene = rig_file.read_bytes(), bpy.context.scene
    rig = rig_of(rig_file, tiny_take.clip, link=True).override_create(remap_local_usages=True)
    scene.collection.objects.link(rig)
    take = active_take(scene)
    take.armature = rig
    for frame in (1, 13):
        scene.frame_set(frame)
        assert bpy.ops.keymark.store_keyframe() == {"FINISHED"}
    assert take.keyframe_action.library is None
    wear_red(take)
    take.method = "interpolation"
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}
    assert rig.animation_data.action == take.motion_action
    take = active_take(save_and_reopen(tmp_path / "using.blend"))
    assert take.armature.override_library is not None
    assert take.armature.animation_data.action == take.motion_action
    assert take.armature.animation_data.action_slot is not None
    assert rig_file.read_bytes() == before


@pytest.mark.usefixtures("registered")
def test_a_full_copy_of_the_scene_is_worked_on_apart(tiny_take: Take) -> None:
    first = open_take(tiny_take)
    first.method = "interpolation"
    bpy.ops.scene.new(type="FULL_COPY")
    copied = active_take(bpy.context.scene)
    first = active_take(bpy.data.scenes["Scene"])
    assert copied.armature != first.armature
    assert copied.armature.name in bpy.context.scene.objects
    assert copied.camera == bpy.context.scene.camera != first.camera
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}
    assert copied.motion_action is not None
    assert first.motion_action is None
    assert first.armature.animation_data.action == first.keyframe_action
    ensure_unique_identifiers(bpy.data.scenes)  # as when the file is opened the next time
    assert copied.identifier != first.identifier
