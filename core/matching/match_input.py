"""What of a take is compared with postures: evidence, the frames asked for, and what is posed."""

from dataclasses import dataclass

from ..arrays import IndexArray
from ..body.kinematics import Body
from ..errors import InputError
from ..footage.camera import Camera
from ..footage.reading import Reading
from ..prior.evidence_speed import evidence_speed
from ..prior.keyframe_proposals import propose_keyframes
from ..progress import run
from ..take.performer_keypoints import performer_keypoints
from ..take.take import Take
from .match_evidence import MatchEvidence
from .posed_constraints import PosedConstraints


@dataclass(frozen=True, eq=False)
class MatchInput:
    """Everything of a take that is needed to find its postures."""

    body: Body
    camera: Camera
    evidence: MatchEvidence
    keyframes: IndexArray
    """(K,) frames whose posture is asked for."""
    constraints: PosedConstraints
    """Of the posed keyframes."""


def match_input(take: Take, reading: Reading, keyframe_count: int | None = None) -> MatchInput:
    """Gather what a take has to find its postures by; pictures are not asked.

    Args:
        take: The take; posed keyframes constrain, those found earlier are not used.
        reading: The clip as `read_footage` has read it.
        keyframe_count: Number of frames to ask for; 10 per 100 frames where None.

    Raises:
        InputError: Neither a marker nor a keypoint is seen.
    """
    check_followed(take)
    keypoints = performer_keypoints(take, None, reading.tracks)
    if not (reading.tracks.visible.any() or keypoints.seen.any()):
        given = (("marker", take.markers), ("keypoint", take.keypoints))
        missing = " and ".join(name for name, has in given if has)
        raise InputError(f"{take.clip}: no {missing} is seen in the footage, so no posture can be found")
    speed = run(evidence_speed(reading.tracks, take.marker_segments, keypoints))
    keyframes = propose_keyframes(speed.values, keyframe_count)
    constraints = PosedConstraints.from_keyframes(take.body, take.keyframes)
    evidence = MatchEvidence.of(reading.tracks, take.marker_segments, keypoints)
    return MatchInput(take.body, take.camera, evidence, keyframes, constraints)


def check_followed(take: Take) -> None:
    """Refuse a take that has nothing to find postures by.

    Raises:
        InputError: It has neither markers nor keypoints.
    """
    if not (take.markers or take.keypoints):
        raise InputError(
            f"{take.file}: the take has neither markers nor keypoints, without which no posture can be "
            "found; give it one of them, or pose its keyframes"
        )
