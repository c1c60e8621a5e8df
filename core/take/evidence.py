"""Kinds of evidence that the estimate of a take is held against, beside its keyframes."""

from dataclasses import replace

import numpy as np

from ..errors import InputError
from ..files.fields import listed
from .evidence_kinds import CONTOURS, DEPTH_HINTS, EVIDENCE, KEYPOINTS, MARKERS
from .take import Take

__all__ = (
    *("CONTOURS", "DEPTH_HINTS", "EVIDENCE", "KEYPOINTS", "MARKERS"),
    *("check_evidence", "evidence_of", "with_evidence"),
)

REMEDIES = {
    MARKERS: "markers must say which are worn",
    KEYPOINTS: "a file of them must be given, as keymark detect writes it",
    DEPTH_HINTS: "none of its files of keypoints guesses depths",
    CONTOURS: "they need a camera that stands still",
}
"""What a kind of evidence takes, for a take that lacks it."""


def evidence_of(take: Take) -> tuple[str, ...]:
    """The kinds of evidence that a take has."""
    hints = any(np.isfinite(frame.hint_m).any() for people in take.keypoints for frame in people.frames)
    has = {
        MARKERS: bool(take.markers),
        KEYPOINTS: bool(take.keypoints),
        DEPTH_HINTS: hints,
        CONTOURS: take.contours and not take.camera.is_moving,
    }
    return tuple(kind for kind in EVIDENCE if has[kind])


def with_evidence(take: Take, kinds: tuple[str, ...]) -> Take:
    """The take with only these kinds of evidence; hints of depth come with keypoints alone."""
    keypoints = take.keypoints if KEYPOINTS in kinds else ()
    if DEPTH_HINTS not in kinds:
        keypoints = tuple(people.without_hints() for people in keypoints)
    return replace(
        take,
        markers=take.markers if MARKERS in kinds else (),
        keypoints=keypoints,
        contours=take.contours and CONTOURS in kinds,
    )


def check_evidence(take: Take, kinds: tuple[str, ...] | None, source: str) -> None:
    """Check that a take has the evidence that is asked for, and any at all.

    Raises:
        InputError: It lacks one of them, or has nothing that could be followed.
    """
    has = evidence_of(take)
    lacking = [] if kinds is None else [kind for kind in kinds if kind not in has]
    if lacking:
        raise InputError(
            f"{source}: evidence names {lacking[0]}, which this take has not got ({REMEDIES[lacking[0]]}); "
            f"it has {listed(has) or 'nothing to follow'}"
        )
    if not has:
        raise InputError(
            f"{take.file}: has nothing to follow, neither markers nor keypoints, and contours need a camera "
            "that stands still; it must have one of them"
        )
