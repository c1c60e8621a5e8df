"""Pose and reconstruct: keyframes, posed, of a reference motion or found, and the motion between them."""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ..body.fingers import SURE, Hands
from ..estimate.notes import of_true_causes
from ..estimate.reconstruct import Reconstruction, reconstruct
from ..estimate.reference_evidence import (
    ReferenceEvidence,
    reference_evidence,
    with_reference,
)
from ..feet.palms import seen_hands
from ..poses.clip import pose_clip
from ..poses.found_poses import referred_poses, with_found
from ..prior.library import library_digest
from ..progress import Job
from ..take.take import Take
from .session import Inputs, Placed, Posed, Session, Stage, placed_take


def pose(session: Session) -> Job[Posed]:
    """Find keyframes where that is wanted; what a person has posed stays.

    Raises:
        InputError: There is no library with a posture.
    """
    inputs, seen, floor_m = session.inputs, placed_take(session), session.inputs.floor_m
    said = reference_evidence(seen) if seen.take.reference is not None and inputs.method == "map" else None
    if said is not None and seen.take.reference is not None:
        said = replace(said, notes=(*seen.take.reference.notes, *said.notes))
    if inputs.libraries is None:
        return Posed(seen, floor_m, None, said)
    if isinstance(said, ReferenceEvidence) and said.is_sure:
        take = with_reference(seen.take, said)
        found = referred_poses(take, said)
    else:
        found = yield from pose_clip(
            seen,
            inputs.libraries,
            None if inputs.floor_open else floor_m,
            inputs.keyframe_count,
            frames=inputs.frames,
            floor_open=inputs.floor_open,
        )
        take = with_found(seen.take, found)
    if inputs.floor_open:
        by_m = found.floor_m - (floor_m or 0.0)
        take, found = lowered(take, by_m), found.lowered(by_m)
    return Posed(replace(seen, take=take), found.floor_m, found, said)


def lowered(take: Take, by_m: float) -> Take:
    """The take with its camera and its keyframes so much lower."""
    matrix_world = take.camera.matrix_world.copy()
    matrix_world[..., 2, 3] -= by_m
    keyframes = tuple(replace(each, posture=each.posture.lowered(by_m)) for each in take.keyframes)
    return replace(take, camera=replace(take.camera, matrix_world=matrix_world), keyframes=keyframes)


_library_digest = lru_cache(maxsize=64)(library_digest)


def _uses(inputs: Inputs) -> tuple[object, ...]:
    libraries = None if inputs.libraries is None else tuple(map(_library_digest, inputs.libraries))
    take, asked = inputs.take, (inputs.frames, inputs.keyframe_count, inputs.floor_m, inputs.floor_open)
    return libraries, asked, take.keyframes, take.reference, inputs.method == "map"


POSE = Stage("pose", pose, _uses, lambda inputs: 0.0 if inputs.libraries is None else 2.2)


def make_motion(session: Session) -> Job[Reconstruction]:
    """Reconstruct the motion from all that is seen and posed."""
    inputs, posed = session.inputs, session[Posed]
    # A camera that was found stands where it has the performer: that place is no other's.
    placed = session[Placed].camera is None
    made = yield from reconstruct(posed.seen, inputs.method, posed.referred, posed.floor_m, placed)
    if not inputs.hands:
        return made
    motion, take = made.motion, posed.seen.take
    own = [key.index for key in take.keyframes if key.is_posed]
    posture, hands = seen_hands(motion.body, motion.posture, motion.time_s, made.keypoints, take.camera, own)
    notes = made.notes if hands is None else of_true_causes((*made.notes, hands_in_words(hands)))
    return replace(made, motion=replace(motion, posture=posture, hands=hands), notes=notes)


def hands_in_words(hands: Hands) -> str:
    """In how many frames hands are surely seen."""
    left, right = np.round(100.0 * (hands.sure > SURE).mean(axis=0))
    return f"The left hand is surely seen in {left:.0f} % of the frames, the right in {right:.0f} %"


RECONSTRUCT = Stage(
    "reconstruct", make_motion, lambda inputs: (inputs.method, inputs.hands), lambda _inputs: 1.8
)
