"""What the tests in Blender share: an empty file for each, actors, postures and a tiny take."""

import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import bpy
import cv2
import keymark
import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import body_pieces
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera
from keymark.core.markers.region_tracks import MarkerStyle
from keymark.core.prior.keyframes import Keyframe
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.core.take.take_file import write_take
from keymark.core.terms.region_model import MarkerPlacement

FRAMES = 13
SIZE = (160, 120)
FPS = 25.0
STYLES = (
    MarkerStyle("trunk", "trunk", (30, 140, 60)),
    MarkerStyle("forearm.L", "forearm.L", (220, 40, 40)),
    MarkerStyle("forearm.R", "forearm.R", (40, 70, 220)),
    MarkerStyle("shin.L", "shin.L", (230, 200, 30)),
    MarkerStyle("shin.R", "shin.R", (200, 50, 200)),
)


@pytest.fixture(autouse=True)
def empty_file() -> None:
    """Every test starts in an empty file with factory settings."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


@pytest.fixture
def registered() -> Iterator[None]:
    """The extension, registered for the test."""
    keymark.register()
    yield
    keymark.unregister()


@pytest.fixture(scope="session")
def body() -> Body:
    """An adult of average proportions."""
    return Body(Actor.from_stature(1.72))


@pytest.fixture
def random_posture() -> Callable[[int], Posture]:
    """A function from a seed to a posture within the skeleton's limits, anywhere in the room."""

    def posture(seed: int) -> Posture:
        rng = np.random.default_rng(seed)
        low, high = HUMAN.limits.T
        vector = rng.uniform(np.where(np.isfinite(low), low, -1.0), np.where(np.isfinite(high), high, 1.0))
        vector[:3] = rng.normal(0.0, 2.0, 3)
        vector[3:6] = rng.normal(0.0, 1.5, 3)
        return Posture.from_vector(HUMAN, vector)

    return posture


@pytest.fixture
def shown_points() -> Callable[[bpy.types.Object], np.ndarray]:
    """A function from an armature to the 13 principal points its bones show in the world."""
    ends = {"head": ("head", "tail"), "shoulder": ("upper_arm", "head"), "elbow": ("forearm", "head")}
    ends |= {"wrist": ("forearm", "tail"), "hip": ("thigh", "head"), "knee": ("shin", "head")}
    ends |= {"ankle": ("shin", "tail")}

    def points(armature_object: bpy.types.Object) -> np.ndarray:
        shown = armature_object.evaluated_get(bpy.context.evaluated_depsgraph_get())
        places = []
        for name in HUMAN.point_names:
            part, _, side = name.partition(".")
            bone, end = ends[part]
            pose_bone = shown.pose.bones[f"{bone}.{side}" if side else bone]
            places.append(shown.matrix_world @ getattr(pose_bone, end))
        return np.array(places)

    return points


@pytest.fixture(scope="session")
def wave_posture() -> Callable[[np.ndarray], Posture]:
    """A function from times 0 to 1 (F,) to a batch of postures: arms and legs swing, the hips rise."""

    def postures(time: np.ndarray) -> Posture:
        names = {name: index for index, name in enumerate(HUMAN.dof_names)}
        vector = np.zeros((len(time), HUMAN.dof_count))
        vector[:, names["pelvis.location_z"]] = 0.95 + 0.03 * np.sin(np.pi * time)
        vector[:, names["shoulder.L.rotation_y"]] = 0.9 - 1.1 * time
        vector[:, names["shoulder.R.rotation_y"]] = -0.9 + 1.1 * time
        vector[:, names["elbow.L.flexion"]] = 0.3 + 0.8 * time
        vector[:, names["elbow.R.flexion"]] = 0.9 - 0.5 * time
        vector[:, names["hip.L.rotation_y"]] = -0.15 - 0.1 * time
        vector[:, names["hip.R.rotation_y"]] = 0.15
        vector[:, names["knee.L.flexion"]] = 0.1 + 0.2 * time
        return Posture.from_vector(HUMAN, vector)

    return postures


@pytest.fixture(scope="session")
def wave_motion(body: Body, wave_posture: Callable[[np.ndarray], Posture]) -> Motion:
    """A motion of FRAMES frames from scene frame 1."""
    posture = wave_posture(np.linspace(0.0, 1.0, FRAMES))
    points = body.points(body.pose(posture))
    covariance = np.broadcast_to(1e-4 * np.eye(3), (FRAMES, 13, 3, 3))
    time_s = np.arange(FRAMES) / FPS
    return Motion(body, FPS, 1, time_s, posture, points, covariance, (0, 6, FRAMES - 1), "map")


@pytest.fixture(scope="session")
def camera() -> Camera:
    """A camera in front of the actor."""
    stand = np.array([[1.0, 0, 0, 0.1], [0, 0, -1, -4.2], [0, 1, 0, 1.0], [0, 0, 0, 1]])
    return Camera(35.0, 36.0, SIZE, stand)


def _draw(body: Body, posture: Posture, camera: Camera) -> np.ndarray:
    """One frame of a performer in garments, (height, width, 3) blue, green, red."""
    image = np.full((SIZE[1], SIZE[0], 3), 110, np.uint8)
    pose = body.pose(posture)
    worn = [(piece, style) for style in STYLES for piece in MarkerPlacement.usual(style.segment).pieces(body)]
    for limb in body_pieces(body):
        garments = [(piece, style.color_srgb) for piece, style in worn if piece.segment == limb.segment]
        for piece, color in [(limb, (60, 60, 60)), *garments]:
            rims = [
                pose.place(piece.joint, center + side * width * across)
                for center, widths in ((piece.start, piece.half_widths[0]), (piece.end, piece.half_widths[1]))
                for width, across in zip(widths, (piece.lateral, piece.sagittal), strict=True)
                for side in (-1.0, 1.0)
            ]
            pixels, _ = camera.project(np.stack(rims))
            outline = cv2.convexHull(np.round(16.0 * pixels - 8.0).astype(np.int32))
            cv2.fillConvexPoly(image, outline, color[::-1], cv2.LINE_AA, shift=4)
    return image


@pytest.fixture(scope="session")
def drawn_take(
    tmp_path_factory: pytest.TempPathFactory, body: Body, camera: Camera, wave_motion: Motion
) -> Take:
    """What `tiny_take` is a copy of; tests must not change it."""
    folder = tmp_path_factory.mktemp("drawn")
    writer = cv2.VideoWriter(str(folder / "clip.mp4"), cv2.VideoWriter_fourcc(*"mp4v"), FPS, SIZE)
    assert writer.isOpened()
    for frame in range(FRAMES):
        writer.write(_draw(body, wave_motion.posture[frame], camera))
    writer.release()
    keyframes = tuple(Keyframe(i, wave_motion.posture[i]) for i in wave_motion.keyframe_indices)
    take = Take(folder, folder / "clip.mp4", FPS, 1, FRAMES, camera, body, STYLES, keyframes)
    write_take(take, folder)
    return take


@pytest.fixture
def tiny_take(tmp_path: Path, drawn_take: Take) -> Take:
    """A take of FRAMES frames on disk, drawn from `wave_motion`, with three exact keyframes."""
    folder = Path(shutil.copytree(drawn_take.folder, tmp_path / "tiny"))
    return replace(drawn_take, folder=folder, clip=folder / drawn_take.clip.name)


@pytest.fixture
def opened(registered: None, tiny_take: Take) -> bpy.types.Scene:
    """The scene with the tiny take opened."""
    assert bpy.ops.keymark.open_take(filepath=str(tiny_take.folder / "take.json")) == {"FINISHED"}
    return bpy.context.scene


@pytest.fixture
def unposed_scene(opened: bpy.types.Scene) -> bpy.types.Scene:
    """The scene with the tiny take opened, and its actor deleted."""
    take = opened.keymark.takes[opened.keymark.active_take]
    bpy.data.objects.remove(take.armature)
    take.armature = take.keyframe_action = None
    return opened
