"""The whole way from a take to a motion, and notes on it."""

import json
import os
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from _recorded import assert_recorded
from _synthetic_take import BODY, SIZE, true_postures, write_synthetic_take
from keymark.core.api import reconstruct
from keymark.core.detect.keypoints import People
from keymark.core.errors import InputError
from keymark.core.estimate.notes import evidence_notes
from keymark.core.estimate.reconstruct import Reconstruction
from keymark.core.progress import Progress, run
from keymark.core.review.score import read_truth, score_points
from keymark.core.take.conversion_settings import METHODS
from keymark.core.take.take import Take, with_evidence
from keymark.core.take.take_file import read_take
from threadpoolctl import threadpool_info, threadpool_limits


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Take:
    return read_take(write_synthetic_take(tmp_path_factory.mktemp("take"), frames=24, keyframe_every=8))


@pytest.fixture(scope="module")
def made(take: Take) -> Callable[[str], tuple[Reconstruction, list[Progress]]]:
    """What a method makes of it, and the steps that it told."""

    @cache
    def by(method: str) -> tuple[Reconstruction, list[Progress]]:
        seen: list[Progress] = []
        return run(reconstruct(take, method), seen.append), seen

    return by


@pytest.fixture(scope="module")
def mapped(made: Callable[[str], tuple[Reconstruction, list[Progress]]]) -> Reconstruction:
    return made("map")[0]


@pytest.mark.parametrize("method", METHODS)
def test_every_method_gives_every_frame_the_posture_recorded(
    made: Callable[[str], tuple[Reconstruction, list[Progress]]], method: str
) -> None:
    result, seen = made(method)
    motion = result.motion
    assert_recorded(f"take by {method}", motion.points, share=1e-4)
    assert_recorded(f"take by {method}, sigma", motion.sigma_m, share=1e-3)
    assert motion.method == method
    assert motion.points.shape == (24, 13, 3) and np.isfinite(motion.points).all()
    assert np.isfinite(motion.sigma_m).all() == (method != "interpolation")
    fractions = [step.fraction for step in seen]
    assert fractions == sorted(fractions) and fractions[0] == 0.0 and fractions[-1] == 1.0
    error = np.linalg.norm(motion.points - BODY.points(BODY.pose(true_postures(24))), axis=-1)
    assert error.mean() < 0.04


def test_a_clip_read_before_gives_the_same_motion_without_the_clip(
    take: Take, mapped: Reconstruction, tmp_path: Path
) -> None:
    found = mapped.reading
    seen: list[Progress] = []
    again = run(reconstruct(replace(take, clip=tmp_path / "gone"), "map", found), seen.append)
    assert again.reading is found
    assert np.array_equal(again.motion.points, mapped.motion.points)
    assert [step.fraction for step in seen] == sorted(step.fraction for step in seen)
    with pytest.raises(ValueError, match="not of the take's markers"):
        run(reconstruct(replace(take, markers=take.markers[:2]), "map", found))
    with pytest.raises(InputError, match="frame_count"):
        run(reconstruct(replace(take, frame_count=25), "map", found))


def test_a_misstated_lens_is_told_and_made_good(take: Take, mapped: Reconstruction) -> None:
    stated = replace(take.camera, lens_mm=1.09 * take.camera.lens_mm)
    right, wrong = mapped, run(reconstruct(replace(take, camera=stated)))
    assert not any("lens" in note for note in right.notes)
    assert any(f"instead of {stated.lens_mm:.1f} mm as stated" in note for note in wrong.notes)
    truth = BODY.points(BODY.pose(true_postures(24)))
    errors = [np.linalg.norm(result.motion.points - truth, axis=-1).mean() for result in (right, wrong)]
    assert errors[1] < errors[0] + 0.005


def test_linear_algebra_keeps_to_one_thread_while_the_job_runs_and_only_then(take: Take) -> None:

    def threads() -> set[int]:
        return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}

    with threadpool_limits(limits=2, user_api="blas"):
        before = threads()
        job = reconstruct(take)
        while next(job).stage != "Estimating the motion":
            pass
        assert threads() <= {1}  # none where the libraries know nothing of threads
        job.close()
        assert threads() == before


def test_closing_the_job_midway_leaves_nothing_behind(take: Take) -> None:
    before = sorted(take.folder.rglob("*"))
    job = reconstruct(take)
    for _ in range(5):
        next(job)
    job.close()
    assert sorted(take.folder.rglob("*")) == before
    assert run(reconstruct(take, "interpolation")).motion.points.shape[0] == 24


def test_an_unknown_method_and_too_few_keyframes_are_refused_in_a_sentence(take: Take) -> None:
    with pytest.raises(InputError, match="map, ekf, interpolation"):
        run(reconstruct(take, "magic"))
    with pytest.raises(InputError, match="at least 2"):
        run(reconstruct(replace(take, keyframes=take.keyframes[:1])))


def test_a_clip_that_is_cut_off_is_converted_as_far_as_it_goes_and_said_so(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = write_synthetic_take(tmp_path / "take", frames=24, keyframe_every=8)
    images = [cv2.imread(str(file)) for file in sorted((folder / "frames").iterdir())]
    writer = cv2.VideoWriter(str(folder / "clip.avi"), cv2.VideoWriter.fourcc(*"MJPG"), 30.0, SIZE)
    for image in images:
        writer.write(image)
    writer.release()
    os.truncate(folder / "clip.avi", int(0.8 * (folder / "clip.avi").stat().st_size))
    for name, change in (
        ("take.json", lambda value: (value.update(clip="clip.avi"), value.pop("frame_count"))),
        ("keyframes.json", lambda value: value.update(keyframes=value["keyframes"][:2])),
    ):
        value = json.loads((folder / name).read_text(encoding="utf-8"))
        change(value)
        (folder / name).write_text(json.dumps(value), encoding="utf-8")
    result = run(reconstruct(read_take(folder)))
    assert 12 <= result.reading.tracks.frame_count < 24 and np.isfinite(result.motion.points).all()
    assert any("clip.avi claims 24 frames" in note and "cut off" in note for note in result.notes)
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("name", ["walk", "reach", "aerobic", "real_balance"])
def test_footage_beats_the_interpolation_of_hand_posed_keyframes(
    take_folder: Callable[[str], Path], name: str
) -> None:
    folder = take_folder(name)
    take = read_take(folder, folder / "keyframes_noisy.json")
    result: Reconstruction = run(reconstruct(take))
    frames = result.reading.tracks.frame_count
    truth = read_truth(folder / "truth.json", take.frame_start, frames)
    ours, prior = (
        score_points(points, truth, result.motion.keyframe_indices, take.camera).mpjpe
        for points in (result.motion.points, result.interpolation.points)
    )
    assert ours < 0.8 * prior


@pytest.mark.parametrize(
    ("kinds", "checked"),
    [
        (("markers",), "the actor's lengths and the markers' segments"),
        (("keypoints",), "the actor's lengths and whom the keypoints show"),
        (("markers", "keypoints"), "lengths, the markers' segments and whom the keypoints show"),
        (("contours",), "the actor's lengths and the poses"),
    ],
)
def test_doubtful_keyframes_send_people_to_what_the_take_has(
    kinds: tuple[str, ...], checked: str, tmp_path: Path
) -> None:
    take = read_take(write_synthetic_take(tmp_path / "take", 8, 4))
    people = People(("nose",), "a detector", take.camera.resolution, ())
    take = with_evidence(replace(take, keypoints=(people,)), kinds)
    evidence = SimpleNamespace(
        model=SimpleNamespace(camera=take.camera),
        posing_scale=9.0,
        distrust=[1.0] * len(take.markers),
    )
    (note,) = evidence_notes(take, evidence)
    assert note.endswith(checked)
