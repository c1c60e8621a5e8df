"""Damaged, rotated or cut footage is read frame for frame as Blender shows it."""

from collections.abc import Callable, Sequence
from pathlib import Path

import bpy
import cv2
import numpy as np
import pytest
from _footage import FRAMES, H264, encode, ffmpeg, number_of, overwritten, write_numbered_take
from keymark.core.video.clip import Clip
from keymark.operators.bridge.result_files import load_footage

LOOKED_AT = (1, 5, 12, 20, 24)
SHORT_GROUPS = (*H264, "-g", "8", "-bf", "2", "-movflags", "+faststart")


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_numbered_take(tmp_path_factory.mktemp("drawn"))


def shown(clip: bpy.types.MovieClip, frames: Sequence[int], folder: Path) -> list[np.ndarray]:
    """The clip's pictures at scene frames, through the compositor."""
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = clip.size
    scene.render.resolution_percentage = 100
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.view_settings.view_transform = "Standard"
    if hasattr(scene, "compositing_node_group"):
        tree = bpy.data.node_groups.new("Shown", "CompositorNodeTree")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        scene.compositing_node_group = tree
        output = tree.nodes.new("NodeGroupOutput")
    else:
        scene.use_nodes = True
        tree = scene.node_tree
        tree.nodes.clear()
        output = tree.nodes.new("CompositorNodeComposite")
    source = tree.nodes.new("CompositorNodeMovieClip")
    source.clip = clip
    tree.links.new(source.outputs["Image"], output.inputs[0])
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    pictures = []
    for frame in frames:
        scene.frame_set(frame)
        scene.render.filepath = str(folder / f"shown{frame}.png")
        bpy.ops.render.render(write_still=True)
        pictures.append(cv2.imread(scene.render.filepath))
    return pictures


def plain(drawn: Path, path: Path) -> None:
    encode(drawn, path, *SHORT_GROUPS)


def damaged(drawn: Path, path: Path) -> None:
    overwritten(encode(drawn, path, *SHORT_GROUPS), 0.55, 2500)


def turned(drawn: Path, path: Path) -> None:
    whole = encode(drawn, path.with_name("whole.mp4"), *SHORT_GROUPS)
    ffmpeg("-display_rotation", "90", "-i", whole, "-c", "copy", path)


def mirrored(drawn: Path, path: Path) -> None:
    """The file asks for left and right to be swapped."""
    whole = encode(drawn, path.with_name("whole.mp4"), *SHORT_GROUPS)
    ffmpeg("-display_hflip", "-i", whole, "-c", "copy", path)


def trimmed(drawn: Path, path: Path) -> None:
    whole = encode(drawn, path.with_name("whole.mp4"), *H264, "-g", "48")
    ffmpeg("-ss", "0.2", "-i", whole, "-c", "copy", path)


def late(drawn: Path, path: Path) -> None:
    encode(drawn, path, *SHORT_GROUPS, "-output_ts_offset", "2")


@pytest.mark.parametrize("make", [plain, damaged, turned, mirrored, trimmed, late])
def test_blender_shows_the_frames_that_are_read(
    drawn: Path, tmp_path: Path, make: Callable[[Path, Path], None]
) -> None:
    bpy.ops.wm.read_homefile(use_empty=True)
    path = tmp_path / "clip.mp4"
    make(drawn, path)
    read = [image for _, _, image in Clip.open(path).frames()]
    clip = load_footage(path)
    assert tuple(clip.size) == (read[0].shape[1], read[0].shape[0])
    frames = [frame for frame in LOOKED_AT if frame <= len(read)]
    assert len(read) == FRAMES or make is trimmed
    for frame, picture in zip(frames, shown(clip, frames, tmp_path), strict=True):
        if read[frame - 1].any():
            difference = np.abs(picture.astype(int) - read[frame - 1].astype(int))
            assert difference.mean() < 4.0, (frame, number_of(picture), number_of(read[frame - 1]))
