"""How an estimate agrees with the keypoints: for those who look at a result."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ..arrays import Array, BoolArray
from ..body.human import HUMAN
from ..body.posture import Posture
from ..detect.keypoints import Keypoints
from ..errors import pluralize
from ..files.fields import listed
from ..numerics.robust import DEGREES, student_weight
from ..terms.keypoints import USUAL_PLACES, KeypointTerm, ObservedKeypoints
from .keypoint_evidence import KeypointEvidence


@dataclass(frozen=True, eq=False)
class KeypointFit:
    """N keypoints in F frames beside what the estimate predicts of them."""

    keypoints: Keypoints  # as they were compared: left and right exchanged back where they were swapped
    predicted_px: Array  # (F, N, 2) where the estimate has them [px]
    residual_px: Array  # (F, N) distance between the two [px]; NaN where not seen
    std_px: Array  # (F, N) expected error along each axis [px]; infinite for points that are left out
    weight: Array  # (F, N) share of the usual weight that each had, 0 to 1; 0 where not seen or left out
    thrown_out: BoolArray  # (F, N) seen, with next to no weight: jumps to another thing, person or side
    swapped: BoolArray  # (F, N) those that the source had on the other side of the body
    trust: Array  # (N,) share of the usual trust in each point, 0 for one that is left out all along
    source_trust: Mapping[str, float]  # by source: mean trust in its points, 0 for one that is left out
    lag: Mapping[str, int]  # by source left out for it: frames late, or early where negative


def keypoint_fit(
    evidence: KeypointEvidence,
    keypoints: Keypoints,
    points: ObservedKeypoints,
    swapped: BoolArray,
    posture: Posture,
) -> KeypointFit:
    """Compare keypoints with an estimate."""
    model, frame = evidence.model, np.arange(posture.batch[0])
    pose = model.body.pose(posture)
    error, std_px, used = KeypointTerm(model, points, evidence.error_m, None).errors(pose, frame)
    predicted = model.pixels(pose, frame)
    residual = np.linalg.norm(predicted - points.pixel, axis=-1)
    squared = np.where(used[..., None], error, 0.0) ** 2
    weight = np.where(used, student_weight(squared.sum(-1), DEGREES, 2), 0.0)
    sources = np.array(evidence.sources)
    trust = {
        source: float(evidence.trust[sources == source].mean()) for source in dict.fromkeys(evidence.sources)
    }
    doubted = points.seen & (keypoints.score == 0.0)
    return KeypointFit(
        keypoints,
        predicted,
        residual,
        std_px,
        weight,
        points.seen & (weight < 0.25) | doubted,  # by more than three standard deviations
        swapped,
        evidence.trust,
        MappingProxyType(trust),
        MappingProxyType(dict(evidence.lag)),
    )


def observed_joints(fit: KeypointFit) -> tuple[tuple[str, ...], BoolArray]:
    """The joint that carries each of N keypoints, and where (F, N) it is seen.

    A joint itself is carried by the one above it: a hip shows where the trunk is, and nothing of the limb.
    """
    joints = []
    for place in (USUAL_PLACES[name] for name in fit.keypoints.names):
        joint = HUMAN.joint_index(place.joint)
        carrier = joint if place.placement else max(HUMAN.joints[joint].parent, 0)
        joints.append(HUMAN.joints[carrier].name)
    return tuple(joints), (fit.weight > 0.0) & ~fit.thrown_out


def keypoint_notes(fit: KeypointFit) -> tuple[str, ...]:
    """Notes on each source of keypoints that was not taken as it stands."""
    notes: list[str] = []
    for source, trust in fit.source_trust.items():
        own = np.array([name == source for name in fit.keypoints.sources])
        if trust == 0.0:
            notes.append(_left_out(source, fit.lag.get(source, 0)))
            continue
        notes += _exchanged(source, fit.swapped[:, own])
        doubted = np.flatnonzero(own & (fit.trust == 0.0))
        if len(doubted):
            named = listed([fit.keypoints.names[i] for i in doubted], 4)
            notes.append(
                f"keypoints of {source} that lie elsewhere than in the keyframes are left out: {named}"
            )
        seen = fit.keypoints.seen & own & (fit.trust > 0.0)
        share = fit.thrown_out[seen].mean() if seen.any() else 0.0
        if share > 0.2:
            notes.append(
                f"{share:.0%} of the keypoints of {source} lie far from where everything else has "
                "the performer and are thrown out; check whom and what they follow"
            )
    return tuple(notes)


def _left_out(source: str, lag: int) -> str:
    if lag:
        when = f"about {pluralize(abs(lag), 'frame')} {'late' if lag > 0 else 'early'} by the keyframes"
        return (
            f"the keypoints of {source} are {when} and are left out; check that they were made from "
            "this clip, at its frame rate and from its first frame"
        )
    return (
        f"the keypoints of {source} are not where the keyframes have the performer and are left out; "
        "check that they are of this clip and this person"
    )


def _exchanged(source: str, swapped: BoolArray) -> list[str]:
    frames = int(swapped.any(axis=1).sum())
    if not frames:
        return []
    if frames > 0.5 * len(swapped):
        return [f"{source} takes left for right throughout; the estimate exchanged its keypoints back"]
    seen = pluralize(frames, "frame")
    return [f"{source} takes left for right in {seen}; the estimate exchanged them back"]
