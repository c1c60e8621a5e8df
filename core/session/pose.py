"""Pose: the keyframes that a motion is made from: posed ones, those of a reference motion, and found ones."""

from dataclasses import replace
from functools import lru_cache

from ..estimate.reference_evidence import (
    ReferenceEvidence,
    reference_evidence,
    with_reference,
)
from ..poses.clip import pose_clip
from ..poses.found_poses import referred_poses, with_found
from ..prior.library import library_digest
from ..progress import Job
from ..take.take import Take
from .made import Posed, placed_take
from .session import Inputs, Session, Stage


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
    if isinstance(said, ReferenceEvidence) and not said.left_out.any():
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


STAGE = Stage("pose", pose, _uses, lambda inputs: 0.0 if inputs.libraries is None else 2.3)
