"""The benchmark of corrections: which keyframe is next, what is found anew, and when it is enough."""

import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import pytest
from _boot import ROOT
from _synthetic_take import true_postures, write_synthetic_take

sys.path.insert(0, str(ROOT / "benchmarks"))

import posing_economy as bench  # noqa: E402
from keymark.core.posing.candidates import Candidate, MatchedFrame  # noqa: E402
from keymark.core.posing.found_poses import FoundPoses  # noqa: E402
from keymark.core.review.score import Score  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402
from trials import Trial, read_unposed  # noqa: E402

FRAMES = 24
CONFIDENCE = {0: 0.9, 8: 0.3, 16: 0.2, 23: 0.7}


@pytest.fixture(scope="module")
def trial(tmp_path_factory: pytest.TempPathFactory) -> Trial:
    """A small synthetic take, read without its keyframes."""
    return read_unposed(write_synthetic_take(tmp_path_factory.mktemp("economy") / "take", FRAMES))


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """What is asked of `pose_clip`, whose postures stand still and are surer around every posed keyframe."""
    questions: list[dict[str, Any]] = []
    still = true_postures(FRAMES)[[0] * FRAMES]

    def pose(
        take: Take,
        _reading: object,
        _libraries: object,
        floor_m: float | None = None,
        between: tuple[int, int] | None = None,
        frames: Sequence[int] | None = None,
    ) -> Iterator[Any]:
        yield from ()
        questions.append({"posed": take.keyframe_indices, "between": between, "frames": frames})
        more = 0.0 if frames is None else 0.25
        found = tuple(
            MatchedFrame(index, (Candidate(still[index], "Sway", False, min(1.0, CONFIDENCE[index] + more)),))
            for index in (CONFIDENCE if frames is None else frames)
        )
        return FoundPoses(found, still, 0.8, 0.0, "so")

    monkeypatch.setattr(bench, "pose_clip", pose)
    return questions


def test_the_most_doubtful_is_posed_next_and_those_around_it_are_found_anew(
    trial: Trial, asked: list[dict[str, Any]]
) -> None:
    """Until all are posed; no keyframe is scored, and the motion gets better."""
    found = bench.measure(trial, ())
    assert asked == [
        {"posed": (), "between": None, "frames": None},
        {"posed": (0, 16), "between": (0, 23), "frames": (8, 23)},  # the first is too far off, and holds
        {"posed": (8, 16), "between": (0, 8), "frames": (0,)},
    ]  # nothing is left around the last two
    assert [score.keyframes for score in found.scores] == [4] * 5
    assert (found.doubtful, found.first_sure, found.frames) == (2, 1, FRAMES)
    assert found.scores[-1].mpjpe < found.scores[0].mpjpe
    assert f"| {found.corrections:.1f} |" in bench.table({"sway": found})


@pytest.mark.parametrize(
    ("errors", "corrections"),
    [((90.0, 40.0, 35.0, 30.0), 2), ((30.0, 40.0, 30.0), 2), ((30.0, 30.0), 0), ((33.0, 34.0, 30.0), 0)],
)
def test_corrections_are_enough_where_the_error_stays_low(
    errors: tuple[float, ...], corrections: int
) -> None:
    """Not where it is low by chance once, and higher after the next."""
    score = Score(10, 2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, None, None)
    scores = tuple(replace(score, mpjpe=error) for error in errors)
    assert bench.Measured(10, 0, scores, 0, 0.1, 0.1).corrections == corrections
