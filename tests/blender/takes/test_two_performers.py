"""Two performers in one clip, each in colors of their own, as two takes of one scene."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import bpy
import cv2
import numpy as np
import pytest
from keymark.core.body.body_volume import body_pieces, marker_parts
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera
from keymark.operators.bridge.pose import write_posture
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")

FRAMES, SIZE = 9, (240, 160)
COLORS = (
    {"trunk": (30, 140, 60), "forearm.L": (220, 40, 40), "shin.R": (200, 50, 200)},
    {"trunk": (40, 70, 220), "forearm.L": (230, 200, 30), "shin.R": (40, 190, 200)},
)
"""The colors of each performer's markers."""
POSITIONS_X_M = (-0.75, 0.75)


def draw(image: np.ndarray, body: Body, posture: Posture, camera: Camera, colors: dict) -> None:
    pose = body.pose(posture)
    worn = {part: colors[segment] for segment in colors for part in marker_parts(segment)}
    for piece in body_pieces(body):
        ends, depth = camera.project(
            np.stack([pose.place(piece.joint, point) for point in (piece.start, piece.end)])
        )
        width = round(2.0 * float(piece.half_widths.mean()) * camera.focal_px / float(depth.mean()))
        start, end = (tuple(round(16.0 * float(value)) for value in point) for point in ends)
        color = worn.get(piece.segment, (60, 60, 60))[::-1]
        cv2.line(image, start, end, color, max(2, width), cv2.LINE_AA, shift=4)


@pytest.fixture
def performances(wave_posture: Callable[[np.ndarray], Posture]) -> list[Posture]:
    """The two motions: the same movement side by side, the second one backwards."""
    time = np.linspace(0.0, 1.0, FRAMES)
    return [
        replace(posture, translation=posture.translation + [x_m, 0.0, 0.0])
        for posture, x_m in zip((wave_posture(time), wave_posture(1.0 - time)), POSITIONS_X_M, strict=True)
    ]


@pytest.fixture
def clip(tmp_path: Path, body: Body, camera: Camera, performances: list[Posture]) -> Path:
    path = tmp_path / "two.mp4"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"mp4v"), 25.0, SIZE)
    assert writer.isOpened()
    for frame in range(FRAMES):
        image = np.full((SIZE[1], SIZE[0], 3), 110, np.uint8)
        for posture, colors in zip(performances, COLORS, strict=True):
            draw(image, body, posture[frame], replace(camera, resolution=SIZE), colors)
        writer.write(image)
    writer.release()
    return path


def test_each_is_found_by_their_own_colors(
    clip: Path,
    body: Body,
    camera: Camera,
    performances: list[Posture],
    shown_points: Callable[[bpy.types.Object], np.ndarray],
) -> None:
    scene = bpy.context.scene
    bpy.ops.keymark.load_footage(filepath=str(clip))
    scene.camera.matrix_world = np.array(camera.matrix_world).T.tolist()
    scene.camera.data.lens = camera.lens_mm
    bpy.ops.keymark.add_performer()
    for index, colors in enumerate(COLORS):
        scene.keymark.active_take = index
        take = active_take(scene)
        bpy.ops.keymark.build_actor(stature=1.72)
        for segment, color in colors.items():
            bpy.ops.keymark.add_marker()
            take.markers[-1].segment = take.markers[-1].name = segment
            take.markers[-1].color = [value / 255.0 for value in color]
        for frame in (0, 4, 8):
            scene.frame_set(frame + 1)
            write_posture(take.armature, performances[index][frame])
            bpy.ops.keymark.store_keyframe()
    for index in (0, 1):
        scene.keymark.active_take = index
        assert bpy.ops.keymark.reconstruct() == {"FINISHED"}
    for take, truth in zip(scene.keymark.takes, performances, strict=True):
        points = body.points(body.pose(truth))
        errors = []
        for frame in range(FRAMES):
            scene.frame_set(frame + 1)
            errors.append(np.linalg.norm(shown_points(take.armature) - points[frame], axis=1))
        assert np.mean(errors) < 0.04
