"""Kinds of evidence that the estimate of a take is held against, beside its keyframes."""

from dataclasses import replace

from .take import Take

MARKERS, KEYPOINTS, DEPTH_HINTS, CONTOURS = "markers", "keypoints", "depth_hints", "contours"
EVIDENCE = (MARKERS, KEYPOINTS, DEPTH_HINTS, CONTOURS)
"""All kinds; a take's `evidence` names those that are used, by default whatever it has."""


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
