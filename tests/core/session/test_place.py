"""A camera found by the performer alone, the lens that a clip states, and what is said of both."""

import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from _synthetic_take import BODY, SIZE, write_json
from keymark.core.body.body_volume import standing_posture
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera, Lens, lens_of_equivalent
from keymark.core.camera.camera_fields import CameraPlacement
from keymark.core.detect.keypoints import Keypoints
from keymark.core.detect.standing_moments import standing_keypoints, turned_note
from keymark.core.session.described import is_unplaced, lens_of
from keymark.core.session.place import camera_in_words, find_camera
from keymark.core.session.session import FoundCamera
from keymark.core.take.conversion_settings import ConversionSettings
from keymark.core.take.description import describe, keypoints_beside
from keymark.core.video.header import FOCAL_LENGTH, stated_lens_mm

FPS = 30.0
AUTO = ConversionSettings(library="auto")


def seen_by(camera: Camera, places: np.ndarray) -> Keypoints:
    """Keypoints of somebody who stands at places (F, 2) on the floor [m]."""
    standing = [standing_posture(BODY, np.array([x, y, 0.0])) for x, y in places]
    pixel, _ = camera.project(BODY.points(BODY.pose(Posture.stack(standing))))
    shape = pixel.shape[:2]
    names = BODY.skeleton.point_names
    hint = np.full((*shape, 3), np.nan)
    return Keypoints(names, ("drawn",) * len(names), pixel, np.full(shape, 0.9), hint)


def walk(frames: int = 120) -> np.ndarray:
    """Toward the camera and to one side."""
    return np.stack([np.linspace(-0.5, 1.2, frames), np.linspace(2.0, -1.0, frames)], axis=1)


def test_a_walk_shows_the_camera_and_the_world_is_about_the_performer() -> None:
    true = Camera(38.0, 36.0, (640, 480), CameraPlacement(1.15, np.radians(-7.0), 0.0).matrix((2.0, -5.0)))
    uprights = standing_keypoints(seen_by(true, walk()), BODY, FPS)
    put = lens_of(Path("none.mp4"), true.resolution).put(true.resolution)
    camera, fit = find_camera(put, False, uprights)
    assert fit is not None and fit.camera.focal_px == camera.focal_px
    found = CameraPlacement.of(camera.matrix_world)
    assert found.height_m == pytest.approx(1.15, abs=0.12)
    assert np.degrees(found.tilt_rad) == pytest.approx(-7.0, abs=2.0)
    location, sight = camera.rays(uprights.lower_px)
    ground = location + ((uprights.lower_m - location[2]) / sight[:, 2])[:, None] * sight
    assert np.median(ground[:, :2], axis=0) == pytest.approx([0.0, 0.0], abs=1e-9)
    known, _ = find_camera(replace(put, lens_mm=38.0), True, uprights)
    assert known.lens_mm == pytest.approx(38.0, rel=0.02)


@pytest.mark.parametrize(
    ("turns", "words"),
    [
        (0, None),
        (1, ("left of", "on its side", "transpose=1")),
        (2, ("below", "upside down", "hflip,vflip")),
        (3, ("right of", "on its side", "transpose=2")),
    ],
)
def test_a_picture_on_its_side_is_told_by_who_stands_in_it(turns: int, words: tuple[str, ...] | None) -> None:
    camera = Camera(38.0, 36.0, (640, 480), CameraPlacement(1.15, 0.0, 0.0).matrix((2.0, -5.0)))
    upright = seen_by(camera, walk())
    pixel = upright.pixel
    for _ in range(turns):  # to the left, as by np.rot90
        pixel = np.stack([pixel[..., 1], -pixel[..., 0]], axis=-1)
    note = turned_note(replace(upright, pixel=pixel))
    assert note is None if words is None else all(word in (note or "") for word in words)
    half = np.where(np.arange(len(pixel))[:, None, None] % 2 == 0, pixel, upright.pixel)
    assert turned_note(replace(upright, pixel=half)) is None  # who lies half of the time


def test_somebody_who_never_stands_leaves_the_camera_as_it_was_put() -> None:
    lens = lens_of(Path("none.mp4"), SIZE)
    put = lens.put(SIZE)
    camera, fit = find_camera(put, False, standing_keypoints(seen_by(put, walk(1)), BODY, FPS))
    assert fit is None and camera is put
    said = camera_in_words(FoundCamera(fit, lens, 1))
    assert "assumed to be level at 1.4 m" in said and "stands upright at no two moments" in said


def test_what_is_found_and_what_is_assumed_is_said_apart() -> None:
    true = Camera(38.0, 36.0, (640, 480), CameraPlacement(1.15, np.radians(-7.0), 0.0).matrix((0.0, -5.0)))
    uprights = standing_keypoints(seen_by(true, walk()), BODY, FPS)
    lens = Lens(38.0, 36.0, "as described", True)
    _, fit = find_camera(lens.put(true.resolution), True, uprights)
    said = camera_in_words(FoundCamera(fit, lens, len(uprights)))
    found, _, assumed = said.partition("assumed: ")
    assert "height 1.1" in found and "±" in found and "±" not in assumed
    assert "lens 38.0 mm (as described)" in assumed and f"by {len(uprights)} moments" in said


def box(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I4s", 8 + len(content), kind) + content


def metadata(value: bytes, kind: int, full: bool) -> bytes:
    names = [b"com.apple.quicktime.make", FOCAL_LENGTH]
    keys = struct.pack(">II", 0, len(names)) + b"".join(box(b"mdta", name) for name in names)
    items = {1: (1, b"Apple"), 2: (kind, value)}
    listed = b"".join(
        box(struct.pack(">I", number), box(b"data", struct.pack(">II", sort, 0) + raw))
        for number, (sort, raw) in items.items()
    )
    return box(b"meta", (b"\0" * 4 if full else b"") + box(b"keys", keys) + box(b"ilst", listed))


@pytest.mark.parametrize(("value", "kind"), [(b"\x1b", 22), (struct.pack(">f", 27.0), 23), (b"27.00mm", 1)])
@pytest.mark.parametrize("full", [True, False])
def test_the_lens_that_a_phone_states_is_read(tmp_path: Path, value: bytes, kind: int, full: bool) -> None:
    track = box(b"trak", box(b"tkhd", b"\0" * 20) + metadata(value, kind, full))
    file = tmp_path / "phone.mov"
    file.write_bytes(box(b"ftyp", b"qt  ") + box(b"mdat", b"\7" * 99) + box(b"moov", track))
    assert stated_lens_mm(file) == 27.0
    lens = lens_of(file, (1920, 1080))
    assert lens.is_known and lens.source == "the clip states 27 mm"
    assert lens.lens_mm == pytest.approx(27.0 * np.hypot(16, 9) / 16 * 36.0 / np.hypot(36, 24))


@pytest.mark.parametrize(
    "content", [b"", b"\0" * 64, b"\0\0\0\x10moovabc", box(b"moov", box(b"meta", b"\xff" * 30))]
)
def test_a_file_that_states_no_lens_or_is_damaged_says_nothing(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "clip.mp4").write_bytes(content)
    assert stated_lens_mm(tmp_path / "clip.mp4") is None
    assert stated_lens_mm(tmp_path) is None and stated_lens_mm(tmp_path / "none.mp4") is None


def test_an_equivalent_is_of_the_diagonal() -> None:
    lens_mm, sensor_mm = lens_of_equivalent(50.0, (3000, 2000))
    assert (lens_mm, sensor_mm) == pytest.approx((50.0, 36.0))
    assert lens_of_equivalent(50.0, (2000, 3000)) == pytest.approx((50.0, 24.0))


def test_only_what_nobody_has_said_or_posed_is_found(tmp_path: Path) -> None:
    clip = tmp_path / "one.mp4"
    clip.touch()
    bare = describe(clip, {"actor": {"height_m": 1.7}}, "--height")
    assert is_unplaced(bare, AUTO) and bare.inherits and bare.clip == clip
    assert not is_unplaced(bare, ConversionSettings())
    assert not is_unplaced(bare, replace(AUTO, keyframes=clip))
    assert not is_unplaced(bare, replace(AUTO, evidence=("contours",)))
    for camera, expected in (
        ({"lens_mm": 30.0, "sensor_width_mm": 36.0}, True),
        ({"height_m": 1.2}, False),
        ({"height_m": None}, False),
        ({"matrix_world": []}, False),
    ):
        write_json(tmp_path / "one.take.json", {"camera": camera, "actor": {"height_m": 1.7}})
        assert is_unplaced(describe(clip), AUTO) is expected


def test_keypoints_beside_a_clip_are_its_own_or_those_of_the_only_clip(tmp_path: Path) -> None:
    clip, plain, own = (tmp_path / name for name in ("a.mp4", "keypoints.json", "a.keypoints.json"))
    clip.touch()
    assert keypoints_beside(clip) is None
    plain.touch()
    assert keypoints_beside(clip) == plain
    (tmp_path / "b.mp4").touch()
    assert keypoints_beside(clip) is None
    own.touch()
    assert keypoints_beside(clip) == own
