"""`--network`: a network of one's own in `animate`, `batch` and `detect`, and its file gone afterward."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from _command_line import one_line
from _networks import DOTTED_SIZE, DotNetwork, dotted_clip, instant_hmr
from _synthetic_take import BODY, true_postures, write_json
from keymark.core.detect.families.instant_hmr import LAYOUT
from keymark.core.detect.keypoint_file import read_keypoints
from keymark.core.detect.pose_network import LAYOUT as OWN
from keymark.core.prior.learning import LibraryMetadata, learn_library
from keymark.core.session import see
from keymark.core.take.motion import read_motion
from keymark.operators.cli.batch.outcomes import BatchOutcomes
from keymark.operators.cli.batch.worker import run_job
from keymark.operators.cli.batch.worker_process import Job
from keymark.operators.cli.commands import batch, detect
from keymark.operators.cli.conversion import convert_take
from keymark.operators.cli.main import main

FRAMES, SIZE, FPS = 24, DOTTED_SIZE, 30.0

pytestmark = pytest.mark.usefixtures("no_blender")


@pytest.fixture
def clip(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A clip of somebody's points, each a dot, whom a stand-in for Keymark's own network sees."""
    file = tmp_path / "clips" / "dots.avi"
    file.parent.mkdir()
    dotted_clip(file, LAYOUT)
    for module in (see, detect):
        monkeypatch.setattr(module, "PoseNetwork", lambda: DotNetwork(LAYOUT))
    monkeypatch.setattr("keymark.core.detect.closer_look._there", lambda _network: None)
    learned = learn_library(
        BODY, true_postures(24), np.arange(24) / 30.0, LibraryMetadata("Swaying", "Nobody")
    )
    monkeypatch.setattr(convert_take, "requested_libraries", lambda _name: (learned,))
    return file


def test_a_network_looks_beside_keymarks_and_its_file_is_not_needed_again(
    clip: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    network = instant_hmr(tmp_path / "body.onnx", LAYOUT.numbers)
    out, again = tmp_path / "out", tmp_path / "again"
    words = ["--no-report", "--quiet"]
    assert main(["animate", str(clip), "--network", str(network), "--output", str(out), *words]) == 0
    kept = json.loads((out / "keypoints.json").read_text(encoding="utf-8"))
    assert kept["second"]["detector"] == "InstantHMR, 70 points, 224 x 224" and kept["second"]["motion"]
    people = read_keypoints(out / "keypoints.json", FRAMES, SIZE, FPS, 1)
    assert people.names == (*OWN.names, *LAYOUT.names)
    network.unlink()
    assert main(["convert", str(out), "--output", str(again), *words]) == 0
    one, other = (read_motion(folder / "motion.json") for folder in (out, again))
    np.testing.assert_allclose(one.points, other.points, atol=1e-3)
    capsys.readouterr()
    assert main(["animate", str(clip), "--network", str(network), "--output", str(again), *words]) == 2
    assert "body.onnx: no such file" in one_line(capsys.readouterr().err)


def test_detect_writes_what_both_have_seen(clip: Path, tmp_path: Path) -> None:
    network = instant_hmr(tmp_path / "flat.onnx", LAYOUT.numbers, deep=False)
    assert main(["detect", str(clip), "--network", str(network), "--quiet"]) == 0
    people = read_keypoints(clip.with_name("dots.keypoints.json"), FRAMES, SIZE, FPS, 1)
    assert people.second is not None and not people.second.motion
    both = [number for number, name in enumerate(people.names) if name == "knee.L"]
    knees = np.array([frame.pixel[0, both] for frame in people.frames])
    assert len(both) == 2 and np.isfinite(knees).all()
    np.testing.assert_allclose(knees[:, 0], knees[:, 1], atol=0.5)


class HereInPlaceOfWorkers:
    """A pool that does the jobs in this process, as they reach a worker."""

    def __init__(self, jobs: Sequence[Job], _words: object, outcomes: BatchOutcomes, *_more: object) -> None:
        self.jobs, self.outcomes = jobs, outcomes

    def run(self, _workers: int) -> None:
        """Do one after the other."""
        for job in self.jobs:
            done = run_job(Job.from_line(job.to_line().strip()), lambda _message: None)
            self.outcomes.job_finished(job, done)


def test_a_batch_hands_the_file_to_its_workers(
    clip: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(batch, "require_blender", lambda _needing: None)
    monkeypatch.setattr(batch, "WorkerPool", HereInPlaceOfWorkers)
    write_json(clip.parent / "shoot.json", {"actor": {"height_m": 1.75}, "keyframes": "auto"})
    network, out = instant_hmr(tmp_path / "body.onnx", LAYOUT.numbers), tmp_path / "out"
    words = ["batch", str(clip.parent), "--output", str(out), "--network", str(network)]
    assert main([*words, "--quiet"]) == 0
    kept = json.loads((out / "dots" / "keypoints.json").read_text(encoding="utf-8"))
    assert kept["second"]["detector"] == "InstantHMR, 70 points, 224 x 224"
    network.write_bytes(network.read_bytes()[:1000])
    assert main([*words, "--again", "--quiet"]) == 1
    assert "body.onnx: is no ONNX file, or a damaged one" in capsys.readouterr().err
