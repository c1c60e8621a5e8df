"""Found keyframes made up from a motion, as finding gives them."""

from collections.abc import Mapping

import bpy
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.posing.candidates import Candidate, MatchedFrame
from keymark.core.prior.library import Library, LibraryPosture
from keymark.core.take.motion import Motion
from keymark.operators.bridge.actor_lengths import read_body
from keymark.operators.bridge.pose import read_posture


def wave_library(motion: Motion, identifier: str = "waves") -> Library:
    """A library of three postures of a motion."""
    postures = tuple(LibraryPosture(f"Wave {i}", motion.posture[i]) for i in (0, 6, 12))
    return Library(identifier, identifier.title(), 1, "Somebody", "CC0-1.0", motion.body.actor, postures)


def made_up_frames(motion: Motion, confidences: Mapping[int, float]) -> tuple[MatchedFrame, ...]:
    """Frames with the motion's postures, of a confidence each, and another posture that each may show."""
    return tuple(
        MatchedFrame(
            index,
            (
                Candidate(motion.posture[index], f"Wave {index}", False, confidence),
                Candidate(motion.posture[12 - index], "Back", True, 0.25),
            ),
        )
        for index, confidence in confidences.items()
    )


def shown(take: bpy.types.PropertyGroup, frame: int) -> Posture:
    """The posture that the actor shows at a frame."""
    bpy.context.scene.frame_set(frame)
    return read_posture(take.armature, read_body(take.armature, HUMAN)).posture
