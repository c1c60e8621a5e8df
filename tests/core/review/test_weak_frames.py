"""Frames worth another keyframe."""

from dataclasses import replace

import numpy as np
import pytest
from keymark.core.review.weak_frames import (
    FRAMES_PER_NAMED,
    NEAREST_FRAMES,
    FrameEvidence,
    Reason,
    find_weak_frames,
)

FRAMES, MARKERS = 121, 3


def evidence(confidence: float = 0.4) -> FrameEvidence:
    """All frames alike: every marker seen where it belongs, even speed."""
    return FrameEvidence(
        squared_error=np.ones(FRAMES),
        confidence=np.full(FRAMES, confidence),
        quality=np.ones((FRAMES, MARKERS)),
        misfit=np.zeros((FRAMES, MARKERS)),
        speed=np.ones(FRAMES),
    )


def test_the_middle_of_the_widest_gap_comes_first_unless_an_error_outweighs_it() -> None:
    worst = find_weak_frames(evidence(), [0, 20, 40, 100, 120])[0]
    assert worst.index == pytest.approx(70, abs=1)
    assert worst.reason is Reason.FAR and worst.marker is None and worst.strength == 1.0
    uncertain = evidence()
    uncertain.squared_error[5:16] = 30.0
    assert 5 <= find_weak_frames(uncertain, [0, 20, 120])[0].index <= 15


def test_believed_frames_are_not_named() -> None:
    assert find_weak_frames(evidence(0.95), [0, 120]) == ()
    known = evidence()
    known.confidence[:60] = 0.95
    assert {frame.index >= 60 for frame in find_weak_frames(known, [0, 120])} == {True}


def test_weak_frames_are_few_spread_and_in_order_of_worth() -> None:
    noisy = replace(evidence(), squared_error=np.random.default_rng(2).uniform(0.5, 2.0, FRAMES))
    keyframes = [0, 60, 120]
    found = find_weak_frames(noisy, keyframes)
    assert 3 <= len(found) <= FRAMES // FRAMES_PER_NAMED
    places = sorted([*keyframes, *(frame.index for frame in found)])
    assert np.diff(places).min() >= NEAREST_FRAMES
    strengths = [frame.strength for frame in found]
    assert strengths == sorted(strengths, reverse=True)


def test_each_reason_is_told_where_it_holds() -> None:
    keyframes = [0, 30, 60, 90, 120]
    told = evidence()
    told.squared_error[:] = 0.01
    for middle in (15, 45, 75, 105):
        told.squared_error[middle - 4 : middle + 5] = 1.0
    told.quality[5:26, 2] = 0.0
    told.misfit[5:26, 2] = np.nan
    told.misfit[35:56, 1] = 9.0
    told.speed[65:86] = 4.0
    reasons = {round(frame.index / 30 - 0.5): frame for frame in find_weak_frames(told, keyframes)}
    assert (reasons[0].reason, reasons[0].marker) == (Reason.HIDDEN, 2)
    assert (reasons[1].reason, reasons[1].marker) == (Reason.FOOTAGE, 1)
    assert (reasons[2].reason, reasons[2].marker) == (Reason.FAST, None)
    assert (reasons[3].reason, reasons[3].marker) == (Reason.FAR, None)


def test_a_body_point_is_told_where_its_keypoints_are_the_reason() -> None:
    told = replace(evidence(), points=("wrist.L", "knee.R"))
    told.squared_error[:] = 0.01
    for middle in (30, 90):
        told.squared_error[middle - 4 : middle + 5] = 1.0
    told.quality[20:41, 2] = 0.0
    told.misfit[80:101, 1] = 9.0
    reasons = {frame.index // 60: frame for frame in find_weak_frames(told, [0, 60, 120])[:2]}
    assert (reasons[0].reason, reasons[0].point, reasons[0].marker) == (Reason.HIDDEN, "knee.R", None)
    assert (reasons[1].reason, reasons[1].point, reasons[1].marker) == (Reason.FOOTAGE, "wrist.L", None)


def test_a_method_without_evidence_or_uncertainty_is_judged_by_coverage() -> None:
    none = np.zeros((FRAMES, 0))
    assert find_weak_frames(replace(evidence(), quality=none, misfit=none), [0, 120])[0].reason is Reason.FAR
    unknown = replace(evidence(), confidence=np.full(FRAMES, np.nan))
    assert find_weak_frames(unknown, [0, 120])[0].index == pytest.approx(60, abs=1)


def test_frames_before_the_first_and_after_the_last_keyframe_count() -> None:
    found = {frame.index for frame in find_weak_frames(evidence(), [60])}
    assert min(found) < 50 and max(found) > 70
