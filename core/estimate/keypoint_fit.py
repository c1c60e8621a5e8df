"""How an estimate agrees with the keypoints: for those who look at a result."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ..arrays import Array, BoolArray
from ..body.body_volume import TRUNK
from ..body.posture import Posture
from ..footage.keypoints.keypoints import Keypoints
from ..observation.keypoints import USUAL_PLACES
from .keypoint_evidence import KeypointEvidence
from .terms.keypoints import KeypointTerm, ObservedKeypoints

THROWN_OUT = 0.25
"""Weight below which a keypoint counts as thrown out: it is off by more than three standard deviations."""


@dataclass(frozen=True, eq=False)
class KeypointFit:
    """N keypoints in F frames beside what the estimate predicts of them."""

    keypoints: Keypoints
    """As they were compared: left and right exchanged back where they were swapped."""
    predicted_px: Array
    """(F, N, 2) where the estimate has them [px]."""
    residual_px: Array
    """(F, N) distance between the two [px]; NaN where not seen."""
    std_px: Array
    """(F, N) expected error along each axis [px]; infinite for points that are left out."""
    weight: Array
    """(F, N) share of the usual weight that each had, 0 to 1; 0 where not seen or left out."""
    thrown_out: BoolArray
    """(F, N) those seen that had next to no weight: jumps to another thing, person or side."""
    swapped: BoolArray
    """(F, N) those that the source had on the other side of the body."""
    trust: Array
    """(N,) share of the usual trust in each point, 0 for one that is left out all along."""
    source_trust: Mapping[str, float]
    """By source: mean trust in its points, 0 for one that is left out."""
    lag: Mapping[str, int]
    """By source that is left out for it: frames by which it is late, or early where negative."""


def keypoint_fit(
    evidence: KeypointEvidence,
    keypoints: Keypoints,
    points: ObservedKeypoints,
    swapped: BoolArray,
    posture: Posture,
) -> KeypointFit:
    """Compare keypoints with an estimate.

    Args:
        evidence: What the keyframes say of them.
        keypoints: As they are compared.
        points: The same, with their confidence.
        swapped: (F, N) those exchanged with their mirror image.
        posture: The F postures.
    """
    model, frame = evidence.model, np.arange(posture.batch[0])
    pose = model.body.pose(posture)
    term = KeypointTerm(model, points, evidence.error_m, np.zeros((max(len(frame) - 1, 0), 1)))
    _, std_px, _ = term.errors(pose, frame)
    predicted = model.pixels(pose, frame)
    residual = np.linalg.norm(predicted - points.pixel, axis=-1)
    weight = term.weigh(pose, frame).level
    trust = {
        source: float(
            np.mean([t for t, own in zip(evidence.trust, evidence.sources, strict=True) if own == source])
        )
        for source in dict.fromkeys(evidence.sources)
    }
    doubted = points.seen & (keypoints.score == 0.0)
    return KeypointFit(
        keypoints,
        predicted,
        residual,
        std_px,
        weight,
        points.seen & (weight < THROWN_OUT) | doubted,
        swapped,
        evidence.trust,
        MappingProxyType(trust),
        MappingProxyType(dict(evidence.lag)),
    )


def observed_joints(fit: KeypointFit) -> tuple[tuple[str, ...], BoolArray]:
    """The joint whose place each of N keypoints shows, and where (F, N) it does.

    A shoulder or a hip shows where the trunk is, and nothing of the limb.
    """
    names = fit.keypoints.names
    joints = tuple(
        TRUNK if name.startswith(("shoulder", "hip")) else USUAL_PLACES[name].joint for name in names
    )
    return joints, (fit.weight > 0.0) & ~fit.thrown_out
