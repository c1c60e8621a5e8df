"""The turntable's operators, scripted as an animator would press them."""

from pathlib import Path

import bpy
import pytest
from keymark.core.take.take import Take
from keymark.operators.footage.camera_view import viewports
from keymark.operators.shell.takes import active_take, add_take

pytestmark = pytest.mark.usefixtures("registered")

DATA = ("objects", "cameras", "actions", "collections")


@pytest.fixture
def take(tiny_take: Take) -> bpy.types.PropertyGroup:
    """The tiny take, opened in a file with the usual editors."""
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    bpy.ops.keymark.open_take(filepath=str(tiny_take.folder))
    return active_take(bpy.context.scene)


def counts() -> dict[str, int]:
    """How many of each kind of data there are."""
    return {kind: len(getattr(bpy.data, kind)) for kind in DATA}


def test_set_up_again_it_replaces_and_removed_it_leaves_nothing(take: bpy.types.PropertyGroup) -> None:
    """The views are known to the take while they are there."""
    for camera in [data for data in bpy.data.cameras if not data.users]:
        bpy.data.cameras.remove(camera)
    before = counts()
    assert bpy.ops.keymark.set_up_turntable() == {"FINISHED"}
    with_views = counts()
    assert with_views["objects"] == before["objects"] + 5
    assert bpy.ops.keymark.set_up_turntable(side="RIGHT", follow=False, lens=35.0) == {"FINISHED"}
    assert counts() == with_views
    assert take.turntable.side.data.lens == pytest.approx(35.0)
    assert take.turntable.collection.name == f"{take.name} Turntable"
    assert bpy.ops.keymark.remove_turntable() == {"FINISHED"}
    assert counts() == before
    assert take.turntable.collection is None


def test_each_viewport_looks_through_the_camera_asked_for(take: bpy.types.PropertyGroup) -> None:
    """The scene keeps the footage's camera; removing the views brings the footage back."""
    scene = bpy.context.scene
    spaces = list(viewports(bpy.context.window_manager))
    assert spaces
    bpy.ops.keymark.set_up_turntable()
    bpy.ops.keymark.show_view(view="SIDE")
    assert scene.camera == take.camera
    assert all(space.use_local_camera and space.camera == take.turntable.side for space in spaces)
    assert all(space.region_3d.view_perspective == "CAMERA" for space in spaces)
    bpy.ops.keymark.show_view(view="FOOTAGE")
    assert not any(space.use_local_camera for space in spaces)
    bpy.ops.keymark.show_view(view="TURNING")
    bpy.ops.keymark.remove_turntable()
    assert not any(space.use_local_camera for space in spaces)


def test_footage_is_shown_even_where_the_scene_has_another_camera(take: bpy.types.PropertyGroup) -> None:
    """Rendering a view needs it as the scene's camera."""
    scene = bpy.context.scene
    bpy.ops.keymark.set_up_turntable()
    scene.camera = take.turntable.turning
    bpy.ops.keymark.show_view(view="FOOTAGE")
    assert {space.camera for space in viewports(bpy.context.window_manager)} == {take.camera}
    bpy.ops.keymark.remove_turntable()
    assert scene.camera == take.camera


def test_a_reference_lies_behind_the_view_chosen_for_it_alone(
    take: bpy.types.PropertyGroup, tiny_take: Take
) -> None:
    """Chosen before the views are there or after; its offset counts from the footage's first frame."""
    folder = tiny_take.folder
    copy = folder / "side.mp4"
    copy.write_bytes(Path(tiny_take.clip).read_bytes())
    clip = bpy.data.movieclips.load(str(copy))
    take.clip.frame_start = 3
    views = take.turntable
    views.reference = clip
    views.reference_offset = 4
    bpy.ops.keymark.set_up_turntable()
    assert clip.frame_start == 7
    assert views.side.data.background_images[0].clip == clip
    views.side.data.background_images[0].offset = (0.1, 0.0)
    views.reference_offset = -2
    assert clip.frame_start == 1
    assert views.side.data.background_images[0].offset[0] == pytest.approx(0.1)
    views.reference_view = "FRONT"
    assert [len(camera.data.background_images) for camera in (views.front, views.side)] == [1, 0]
    views.reference = None
    assert len(views.front.data.background_images) == 0
    assert take.clip.frame_start == 3


def test_what_is_missing_is_said(take: bpy.types.PropertyGroup) -> None:
    """As tooltips, and as an error for a view that is not there."""
    with pytest.raises(RuntimeError, match="Set up the turntable first"):
        bpy.ops.keymark.remove_turntable()
    with pytest.raises(RuntimeError, match="no camera for the view Side"):
        bpy.ops.keymark.show_view(view="SIDE")
    add_take(bpy.context.scene, "Empty")
    with pytest.raises(RuntimeError, match="Build the actor first"):
        bpy.ops.keymark.set_up_turntable()
    with pytest.raises(RuntimeError, match="Load the footage"):
        bpy.ops.keymark.show_view(view="FOOTAGE")


def test_two_takes_have_views_of_their_own(take: bpy.types.PropertyGroup) -> None:
    """Removing one's leaves the other's."""
    scene = bpy.context.scene
    bpy.ops.keymark.set_up_turntable()
    other = add_take(scene, "Other")
    first = scene.keymark.takes[0]
    other.clip, other.camera, other.armature = first.clip, first.camera, first.armature
    bpy.ops.keymark.set_up_turntable()
    assert other.turntable.front != first.turntable.front
    bpy.ops.keymark.remove_turntable()
    assert first.turntable.front.name in scene.objects
    assert other.turntable.front is None
