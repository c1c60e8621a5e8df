"""People are found in a clip and followed, by a landmark network whose points lie where they are seen."""

import hashlib
import sys
import threading
import weakref
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import cv2
import numpy as np
import pytest
from _drawn_clip import SHAPE, Drawn, FakeNetwork, draw_people
from keymark.core.detect.keypoint_file import read_keypoints
from keymark.core.detect.keypoints import People
from keymark.core.detect.pose_network import (
    ABOVE,
    CELLS,
    CENTER,
    LAYOUT,
    MODEL,
    MOST_AT_ONCE,
    POINTS,
    SIDE,
    Crop,
    Pose,
    PoseNetwork,
    in_parallel,
)
from keymark.core.detect.pose_tracking import AHEAD, STRETCH, PeopleFinder, find_people
from keymark.core.errors import InputError
from keymark.core.progress import Progress, run
from keymark.core.video.clip import Clip

SIZE = (320, 240)
People3 = list[tuple[float, float, float]]


def drawn(people: Sequence[People3], size: tuple[int, int] = SIZE, fps: float = 30.0) -> Clip:
    """A clip of these."""
    return Clip(
        Path("drawn.mp4"), cast(Any, Drawn([draw_people(size, each) for each in people], fps, size=size))
    )


def seen(people: Sequence[People3], size: tuple[int, int] = SIZE) -> People:
    return run(find_people(drawn(people, size), cast(Any, FakeNetwork())))


def counts(people: People) -> list[int]:
    return [len(frame.pixel) for frame in people.frames]


def test_one_person_is_followed_over_the_ends_of_stretches() -> None:
    frames = STRETCH * 4 + 6
    clip = drawn([[(90.0 + index, 120.0, 50.0)] for index in range(frames)])
    progress: list[Progress] = []
    found = run(find_people(clip, cast(Any, FakeNetwork())), progress.append)
    assert counts(found) == [1] * frames and found.size == SIZE
    truth = np.array([90.0 + frames - 1, 120.0]) + 50.0 * SHAPE
    np.testing.assert_allclose(found.frames[-1].pixel[0], truth, atol=2.0)
    assert [one.fraction for one in progress] == sorted(one.fraction for one in progress)


@pytest.mark.parametrize("frames", [2, 3])
def test_a_clip_of_few_frames(frames: int) -> None:
    assert counts(seen([[(160.0, 120.0, 50.0)]] * frames)) == [1] * frames


@pytest.mark.parametrize(("fps", "every"), [(15.0, 1), (25.0, 2), (50.0, 3), (59.94, 4), (240.0, 16)])
def test_fifteen_pictures_a_second_and_the_last_are_looked_at(fps: float, every: int) -> None:
    frames, looked = 10 * every + 3 * (every > 1), []

    class Noting(FakeNetwork):
        def each(self, asked: Sequence[tuple[np.ndarray, Crop]]) -> list[Pose]:
            looked.extend(id(picture) for picture, _ in asked)
            return super().each(asked)

    people: list[People3] = [[(100.0 + 20.0 * index / fps, 120.0, 50.0)] for index in range(frames)]
    pictures = [draw_people(SIZE, each) for each in people]
    clip = Clip(Path("drawn.mp4"), cast(Any, Drawn(pictures, fps, size=SIZE)))
    found = run(find_people(clip, cast(Any, Noting())))
    assert counts(found) == [1] * frames
    wanted = {id(picture) for picture in [*pictures[::every], pictures[-1]]}
    assert set(looked) == wanted
    truth = people[-1][0][:2] + 50.0 * SHAPE
    np.testing.assert_allclose(found.frames[-1].pixel[0], truth, atol=2.0)


def test_between_looks_everything_moves_on_along_a_curve() -> None:
    angle = np.linspace(0.0, 2.0, 41)
    people: list[People3] = [[(160.0 + 60.0 * np.sin(a), 120.0 - 30.0 * np.cos(a), 40.0)] for a in angle]
    found = seen(people)
    for index in range(3, 38):
        truth = np.array(people[index][0][:2]) + 40.0 * SHAPE
        np.testing.assert_allclose(found.frames[index].pixel[0], truth, atol=2.0)
    assert all(np.isfinite(frame.hint_m).all() and (frame.score > 0.0).all() for frame in found.frames)


def test_pictures_are_let_go_of_once_they_were_looked_at() -> None:
    alive: list[weakref.ref[np.ndarray]] = []
    most = 0
    with PeopleFinder(drawn([[]] * 2), lambda: (cast(Any, FakeNetwork()), None)) as finder:
        for index in range(6 * STRETCH):
            picture = draw_people(SIZE, [(160.0, 120.0, 50.0)])
            finder.add(index, picture)
            alive = [one for one in [*alive, weakref.ref(picture)] if one() is not None]
            most = max(most, len(alive))
        assert len(finder.people().frames) == 6 * STRETCH
    assert STRETCH <= most <= STRETCH + AHEAD + 4


def test_somebody_who_comes_and_goes_is_seen_meanwhile_alone() -> None:
    there = range(30, 129)
    people: list[People3] = [[(160.0, 120.0, 50.0)] if index in there else [] for index in range(160)]
    assert counts(seen(people)) == [int(index in there) for index in range(160)]


def test_two_people_are_told_apart_and_a_tiny_one_is_left_out() -> None:
    people: list[People3] = [
        [(100.0 + 0.3 * index, 120.0, 45.0), (220.0, 120.0, 40.0), (300.0, 30.0, 6.0)] for index in range(60)
    ]
    assert set(counts(seen(people))) == {2}


def test_a_passer_by_of_another_size_who_meets_nobody_is_left_out() -> None:
    people: list[People3] = [[(160.0, 120.0, 40.0)]] * 61 + [[]] * 9
    people += [[(120.0 + 4 * index, 120.0, 80.0)] for index in range(26)]
    assert counts(seen(people)) == [1] * 61 + [0] * 35


def test_points_beyond_the_picture_are_not_seen() -> None:
    found = seen([[(20.0, 120.0, 50.0)]] * 5).frames[2]
    outside = np.isnan(found.pixel[0]).any(axis=1)
    assert outside.any() and not outside.all() and (found.score[0][outside] == 0.0).all()


class CutNetwork(FakeNetwork):
    """Sees a disc as a chest: shoulders in its middle, hips below, of which it is never sure."""

    def _pose(self, center: np.ndarray, radius: float, presence: float) -> Pose:
        pose, middle = super()._pose(center, radius, presence), np.asarray(center, dtype=float)
        hips = middle + [0.0, 0.8 * radius]
        at = [LAYOUT.names.index(name) for name in ("shoulder.L", "shoulder.R")]
        pose.pixel[at], pose.pixel[HIPS_DOWN] = middle, hips + [0.0, 0.4 * radius]
        pose.score[HIPS_DOWN] = 0.05
        return replace(pose, crop=replace(pose.crop, center=hips))


HIPS_DOWN = [i for i, name in enumerate(LAYOUT.names) if name.startswith(("hip", "knee", "ankle", "heel"))]


def test_somebody_who_is_cut_at_the_waist_is_followed_by_the_shoulders() -> None:
    clip = drawn([[(100.0 + index, 205.0, 50.0)] for index in range(STRETCH + 5)])
    found = run(find_people(clip, cast(Any, CutNetwork())))
    assert counts(found) == [1] * (STRETCH + 5)
    assert np.isnan(found.frames[9].pixel[0, HIPS_DOWN]).all()


def test_two_who_become_one_are_one() -> None:
    people: list[People3] = [[(100.0, 120.0, 40.0), (220.0, 120.0, 40.0)]] * 4
    people += [[(160.0, 120.0, 40.0)]] * 40
    assert counts(seen(people))[8:] == [1] * 36


def test_a_large_picture_is_found_in_its_own_pixels() -> None:
    found = seen([[(1300.0, 900.0, 350.0)]] * 2, (2600, 1800)).frames[0]
    np.testing.assert_allclose(np.nanmean(found.pixel[0] - 350.0 * SHAPE, axis=0), (1300.0, 900.0), atol=6.0)


def test_a_clip_without_anybody_is_one_sentence() -> None:
    with pytest.raises(InputError, match=r"drawn.mp4: nobody is seen in any of its 60 frames"):
        seen([[]] * 60)
    with pytest.raises(InputError, match="holds no frame"):
        seen([])


needs_model = pytest.mark.skipif(not MODEL.is_file(), reason="tools/fetch_model.py was not run")


def bare() -> PoseNetwork:
    return PoseNetwork.__new__(PoseNetwork)


def answer(place: tuple[float, float]) -> list[Any]:
    """What the network gives where all points are at one place, but the upper one 50 px above it."""
    points = np.zeros((POINTS, 5), dtype=np.float32)
    points[:, :2] = place
    points[ABOVE, 1] -= 50.0
    heat = np.full((POINTS, CELLS, CELLS), -20.0, dtype=np.float32)
    world = np.tile(np.array([1.0, 0.0, 0.5], dtype=np.float32), (POINTS, 1))
    return [points, 0.9, heat, world]


def test_points_and_hints_are_turned_with_the_crop() -> None:
    crop = Crop(np.array([200.0, 100.0]), 2.0 * SIDE, np.pi / 2)
    points, presence, heat, world = answer((SIDE / 2 + 10.0, SIDE / 2))
    pose = bare().postprocess((points, presence, heat, world), crop)
    np.testing.assert_allclose(pose.pixel, np.tile([200.0, 120.0], (len(LAYOUT.names), 1)), atol=1e-9)
    np.testing.assert_allclose(pose.hint_m, np.tile([0.0, 1.0, 0.5], (len(LAYOUT.names), 1)), atol=1e-6)
    np.testing.assert_allclose(pose.crop.center, [200.0, 120.0], atol=1e-9)
    assert pose.crop.angle == pytest.approx(np.pi / 2) and pose.crop.side == pytest.approx(250.0)
    assert (pose.score == 0.5).all() and pose.presence == 0.9


def test_a_heat_map_moves_its_point_where_it_has_a_peak() -> None:
    points, presence, heat, world = answer((100.0, 100.0))
    number = LAYOUT.numbers[3]
    heat[number, 24, 27], heat[LAYOUT.numbers[4], 24, 27] = 20.0, -1.0
    pose = bare().postprocess((points, presence, heat, world), Crop(np.full(2, SIDE / 2), SIDE))
    np.testing.assert_allclose(pose.pixel[3], (108.0, 96.0), atol=1e-3)
    np.testing.assert_allclose(pose.pixel[4], (100.0, 100.0), atol=1e-9)


def test_the_input_shows_the_crop_red_first() -> None:
    picture = np.zeros((400, 400, 3), dtype=np.uint8)
    picture[150:160, 250:260, 0] = 255  # blue
    crop = Crop(np.array([220.0, 170.0]), 300.0, 0.4)
    blob = bare().preprocess(picture, crop)
    assert blob.shape == (1, 3, SIDE, SIDE) and blob.max() == pytest.approx(1.0) and not blob[0, :2].any()
    rows, columns = np.nonzero(blob[0, 2] > 0.5)
    middle = crop.matrix @ [columns.mean() + 0.5, rows.mean() + 0.5, 1.0]
    np.testing.assert_allclose(middle, (255.0, 155.0), atol=0.5)


def test_a_missing_or_damaged_file_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot be read .*fetch_model.py"):
        PoseNetwork(tmp_path / "none.onnx")
    broken = tmp_path / "broken.onnx"
    broken.write_bytes(b"ONNX" * 1000)
    with pytest.raises(InputError, match=r"is damaged or another one; install"):
        PoseNetwork(broken)


def test_a_missing_runtime_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    weights = tmp_path / "weights.onnx"
    weights.write_bytes(b"ONNX")
    listed = tmp_path / "SHA256SUMS"
    listed.write_text(f"{hashlib.sha256(b'ONNX').hexdigest()}  weights.onnx\n", encoding="utf-8")
    monkeypatch.setattr("keymark.core.detect.network_file.CHECKSUMS", listed)
    monkeypatch.setitem(sys.modules, "onnxruntime", None)
    with pytest.raises(InputError, match=r"^onnxruntime, .* cannot be loaded .*; install Keymark's zip"):
        PoseNetwork(weights)


@needs_model
def test_the_performer_of_the_demonstration_is_found(repository: Path) -> None:
    take = repository / "presets" / "demo" / "aerobic"
    clip = Clip.open(take / "clip.mp4")
    images = list(clip.source.at(range(6)))

    short = Clip(clip.path, cast(Any, Drawn([image for _, image in images], size=clip.size)))
    found = run(find_people(short, PoseNetwork()))
    usual = read_keypoints(take / "keypoints.json", None, clip.size)
    both = [name for name in found.names if name in usual.names]
    own, theirs = [[names.index(name) for name in both] for names in (found.names, usual.names)]
    for index, frame in enumerate(found.frames):
        assert len(frame.pixel) == 1 and np.isfinite(frame.hint_m).all()
        off = np.linalg.norm(frame.pixel[0][own] - usual.frames[index].pixel[0][theirs], axis=1)
        assert np.nanmedian(off) < 8.0


@needs_model
def test_looks_at_once_say_what_looks_one_by_one_do(repository: Path) -> None:
    clip = Clip.open(repository / "presets" / "demo" / "aerobic" / "clip.mp4")
    picture = next(image for _, image in clip.source.at(range(1)))
    asked = [(picture, Crop(np.array([160.0, 120.0]), side)) for side in (276.0, 250.0, 230.0)]
    network, threads = PoseNetwork(), cv2.getNumThreads()
    try:
        cv2.setNumThreads(2)
        together = network.each(asked)
        assert cv2.getNumThreads() == 2
        for pose, one in zip(together, asked, strict=True):
            assert (pose.pixel == network(*one).pixel).all()
    finally:
        cv2.setNumThreads(threads)


@needs_model
def test_an_empty_room_shows_nobody() -> None:
    network = PoseNetwork()
    noise = np.random.default_rng(0).integers(0, 255, (240, 320, 3), dtype=np.uint8)
    for picture in (noise, np.full((240, 320, 3), 120, dtype=np.uint8)):
        assert network(picture, Crop(np.array([160.0, 120.0]), 276.0)).presence < 0.5
    assert CENTER < ABOVE < POINTS


@needs_model
def test_a_mirror_image_is_as_deep(repository: Path) -> None:
    clip = Clip.open(repository / "presets" / "demo" / "aerobic" / "clip.mp4")
    network, sums = PoseNetwork(), []
    for _, picture in clip.source.at(range(0, 100, 20)):
        pose = network(picture, Crop(np.array([160.0, 120.0]), 276.0))
        turned = Crop(pose.crop.center * [-1.0, 1.0] + [clip.size[0], 0.0], pose.crop.side, -pose.crop.angle)
        both = network.each([(picture, pose.crop), (np.ascontiguousarray(picture[:, ::-1]), turned)])
        sides = [[LAYOUT.names.index(f"{joint}.{side}") for joint in ("hip", "shoulder")] for side in "LR"]
        sums.append(sum(one.hint_m[sides[0], 2] - one.hint_m[sides[1], 2] for one in both))
    # As the large network has them the hips' sum is .1 m, the shoulders' -.1.
    assert np.abs(np.mean(sums, axis=0)).max() < 0.04, sums


def test_all_looks_share_a_few_threads_whose_memory_they_use_again() -> None:
    names = {name for _ in range(9) for name in in_parallel(lambda _: threading.current_thread().name, "ab")}
    assert 1 <= len(names) <= MOST_AT_ONCE
