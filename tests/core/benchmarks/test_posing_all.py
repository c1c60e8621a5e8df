"""The benchmark of no posing at all: limbs on the wrong side, what is measured, and the table."""

import sys
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from _boot import ROOT
from _synthetic_take import true_postures, write_synthetic_take

sys.path.insert(0, str(ROOT / "benchmarks"))

import posing_all as bench  # noqa: E402
from keymark.core.body.human import HUMAN  # noqa: E402
from keymark.core.poses.candidates import Candidate, MatchedFrame  # noqa: E402
from keymark.core.poses.found_poses import FoundPoses  # noqa: E402
from keymark.core.take.seen_take import SeenTake  # noqa: E402
from trials import Trial, read_unposed  # noqa: E402

FRAMES = 24


@pytest.fixture(scope="module")
def trial(tmp_path_factory: pytest.TempPathFactory) -> Trial:
    """A small synthetic take, read without its keyframes."""
    return read_unposed(write_synthetic_take(tmp_path_factory.mktemp("posing_all") / "take", FRAMES))


def found() -> FoundPoses:
    """Postures that stand still."""
    still = true_postures(FRAMES)[[0] * FRAMES]
    frames = tuple(
        MatchedFrame(index, (Candidate(still[index], "Sway", False, 0.6),)) for index in (0, 12, 23)
    )
    return FoundPoses(frames, still, 0.8, 0.0, "so")


def test_a_limb_on_the_wrong_side_counts_where_it_leans(trial: Trial) -> None:
    points, wrist, elbow = (
        np.array(trial.truth),
        *(HUMAN.point_names.index(name) for name in ("wrist.L", "elbow.L")),
    )
    sight = trial.take.camera.sight(trial.truth.mean(axis=1), np.arange(FRAMES))
    truth = np.array(trial.truth)
    truth[:, wrist] = truth[:, elbow] - 0.3 * sight
    points[:, wrist] = truth[:, wrist]
    points[4:9, wrist] = points[4:9, elbow] + 0.3 * sight[4:9]
    wrong = bench.wrong_sides(replace(trial, truth=truth), points)
    forearm = bench.LIMBS.index(("elbow.L", "wrist.L"))
    assert np.flatnonzero(wrong[forearm]).tolist() == [4, 5, 6, 7, 8]
    assert wrong.sum() == 5
    points[4:9, wrist] = points[4:9, elbow] - 0.1 * sight[4:9]  # too short, but on its side
    assert not bench.wrong_sides(replace(trial, truth=truth), points).any()


def test_a_take_is_posed_as_a_whole_and_between_two_frames(
    trial: Trial, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[dict[str, Any]] = []

    def pose(
        seen: SeenTake, _libraries: Any, floor_m: float | None = None, between: Any = None
    ) -> Iterator[Any]:
        yield from ()
        asked.append({"posed": seen.take.keyframe_indices, "between": between, "floor_m": floor_m})
        return found()

    monkeypatch.setattr(bench, "pose_clip", pose)
    sway = bench.measure(trial, ())
    ends = asked[1]["between"]
    assert asked == [
        {"posed": (), "between": None, "floor_m": None},
        {"posed": ends, "between": ends, "floor_m": 0.0},
    ]
    assert 0 <= ends[0] < ends[1] < FRAMES
    assert sway.confidence == 0.6
    lines = bench.table({"sway": sway}).splitlines()
    assert len({line.count("|") for line in lines[2:]}) == 1
    assert lines[-2].split("|")[2:] == lines[-1].split("|")[2:]  # the median of one
